"""GTC, the GUM Tree Calculator, judges the law of propagation of uncertainty.

`examples/guide_to_uncertainty` writes the results of two examples of the Guide: the gauge block of H.1 and the
circuit of H.2, whose inputs are correlated. GTC differentiates by automatic differentiation.
"""

import csv
from math import inf

import GTC
from judge import FRAMES, Verdict, run

TOLERANCE = 1e-6


def by_gauge_block() -> dict[str, float]:
    """Returns the length of the gauge block and its uncertainties, in nm."""
    inputs = [
        GTC.ureal(50_000_623, 25, 18),
        GTC.ureal(215, 5.8, 24),
        GTC.ureal(0, 3.9, 5),
        GTC.ureal(0, 6.7, 8),
        GTC.ureal(11.5e-6, 1.2e-6),
        GTC.ureal(-0.1, 0.2),
        GTC.ureal(0, 0.35),
        GTC.ureal(0, 0.58e-6, 50),
        GTC.ureal(0, 0.029, 2),
    ]
    standard, comparator, random, systematic, alpha, mean, cycle, d_alpha, d_theta = inputs
    thermal = standard * (d_alpha * (mean + cycle) + alpha * d_theta)
    length = standard + comparator + random + systematic - thermal - 50_000_000
    return summary(length, inputs)


def by_circuit() -> dict[str, float]:
    """Returns the resistance of the circuit and its uncertainties, in ohm."""
    volt, ampere = GTC.ureal(4.999, 0.0032, independent=False), GTC.ureal(19.661e-3, 0.0095e-3, independent=False)
    phase = GTC.ureal(1.04446, 0.00075, independent=False)
    GTC.set_correlation(-0.36, volt, ampere)
    GTC.set_correlation(0.86, volt, phase)
    GTC.set_correlation(-0.65, ampere, phase)
    return summary(volt / ampere * GTC.cos(phase), [volt, ampere, phase])


def summary(result: GTC.lib.UncertainReal, inputs: list[GTC.lib.UncertainReal]) -> dict[str, float]:
    """Returns what the example writes."""
    k = GTC.reporting.k_factor(result.df, 99)
    numbers = {
        "estimate": result.x,
        "combined": result.u,
        "degrees_of_freedom": result.df,
        "coverage_factor": k,
        "expanded": k * result.u,
    }
    for index, x in enumerate(inputs):
        numbers[f"contribution_{index}"] = abs(GTC.component(result, x))
    return numbers


def main() -> None:
    """Has the example write its results, and compares."""
    verdict = Verdict()
    file = FRAMES / "guide_to_uncertainty.csv"
    run("examples/guide_to_uncertainty", str(file))
    expected = {"gauge": by_gauge_block(), "circuit": by_circuit()}
    with file.open() as rows:
        for row in csv.DictReader(rows):
            ours, theirs = float(row["value"]), expected[row["example"]].pop(row["quantity"])
            same = ours == theirs == inf
            # Contributions count in parts of the combined uncertainty.
            scale = max(abs(theirs), 1e-3) if "contribution" in row["quantity"] else abs(theirs)
            deviation = 0.0 if same else (ours - theirs) / scale
            verdict.within(f"{row['example']}: {row['quantity'].replace('_', ' ')} (relative)", deviation, TOLERANCE)
    if any(expected.values()):
        raise SystemExit(f"not written: {expected}")
    verdict.end()


if __name__ == "__main__":
    main()
