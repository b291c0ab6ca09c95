"""GTC, the GUM Tree Calculator, judges the law of propagation of uncertainty.

`examples/guide_to_uncertainty` writes the results of two examples of the Guide: the gauge block of
H.1 and the circuit of H.2, whose inputs are correlated. `tem00-inspect budget` writes those of a
set-up whose geometry is uncertain, which is stated here a second time. GTC differentiates by
automatic differentiation.
"""

import csv
import json
from math import atan2, cos, inf, sin

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
    volt, ampere = (
        GTC.ureal(4.999, 0.0032, independent=False),
        GTC.ureal(19.661e-3, 0.0095e-3, independent=False),
    )
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


def check_set_up(verdict: Verdict) -> None:
    """Compares the law of propagation of a budget with that of the line of sight."""
    folder = FRAMES / "certified"
    run(
        "tem00-inspect", "budget", "examples/setups/certified.toml",
        "--trials", "0", "--output", str(folder),
    )
    ours = json.loads((folder / "budget.json").read_text())["measurement"]
    known = {}
    for row in ours["inputs"]:
        freedom = row["degrees_of_freedom"]
        estimate, uncertainty = row["estimate"], row["uncertainty"]
        known[row["input"]] = GTC.ureal(
            estimate, uncertainty, freedom or inf, independent=bool(freedom)
        )
    for row in ours["correlations"]:
        first, second = row["between"]
        GTC.set_correlation(row["coefficient"], known[first], known[second])
    height = height_of(known, ours["height"])
    first_order = ours["answers"][0]
    verdict.within("set-up: height (relative)", height.x / first_order["estimate"] - 1, TOLERANCE)
    verdict.within(
        "set-up: combined (relative)", height.u / first_order["uncertainty"] - 1, TOLERANCE
    )
    deviation = height.df / ours["degrees_of_freedom"] - 1
    verdict.within("set-up: degrees of freedom (relative)", deviation, TOLERANCE)
    for row in ours["inputs"]:
        theirs = abs(GTC.component(height, known[row["input"]]))
        deviation = (row["contribution"] - theirs) / height.u
        verdict.within(f"set-up: {row['input']} (in parts of u)", deviation, TOLERANCE)


def height_of(known: dict[str, GTC.lib.UncertainReal], at: float) -> GTC.lib.UncertainReal:
    """Returns the height at which the line of sight meets an upright laser plane, in metres.

    The row is that at which the set-up as described sees the height `at`.
    """
    names = ["distance", "angle", "focal_length", "pixel_pitch", "principal_row"]
    distance, angle, focal, pitch, principal = (known[f"camera.{name}"] for name in names)
    # Base and mount are of aluminium.
    expansion = 23.6e-6 * known["environment.temperature_change"]
    image = focal * distance / (distance - focal) * (1 + expansion)
    phi = atan2(at * sin(angle.x), distance.x - at * cos(angle.x))
    row = principal.x - image.x * sin(phi) / cos(phi) / pitch.x
    errors = [x for name, x in known.items() if "." not in name and name != "calibration"]
    sight = angle + GTC.atan((principal - row - sum(errors)) * pitch / image)
    to_plane = (
        known["laser.offset"] + distance * GTC.sin(angle) * (1 + expansion)
    ) / GTC.sin(sight)
    return distance * GTC.cos(angle) - to_plane * GTC.cos(sight)


def main() -> None:
    """Has the example and the program write their results, and compares."""
    verdict = Verdict()
    check_set_up(verdict)
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
            verdict.within(
                f"{row['example']}: {row['quantity'].replace('_', ' ')} (relative)",
                deviation,
                TOLERANCE,
            )
    if any(expected.values()):
        raise SystemExit(f"not written: {expected}")
    verdict.end()


if __name__ == "__main__":
    main()
