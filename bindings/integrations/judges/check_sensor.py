"""A photon transfer series, evaluated by the package emva1288, returns the sensor that took it.

With N = 256² pixels a temporal variance from a pair of frames has the relative standard error
√(2/N) = 0.55 %, a spatial one from a stack the same. The gain is a line through two dozen
variances, 0.2 %; with it the quantum efficiency, 0.2 %; dark noise, DSNU and PRNU are roots of
variances, 0.3 %. The tolerance of 2 % is six of these standard errors or more.

The saturation is the exposure with the largest temporal variance: the last one of which no well is
full. It follows from the distribution of the electrons, cut off at the full well, and lies 1.5 %
below it.
"""

import json
import logging

import numpy as np
from numpy.typing import NDArray
from scipy import constants, stats

from judge import FRAMES, Verdict, run

# The package was written for NumPy 1, which had this function.
if not hasattr(np, "asfarray"):
    setattr(np, "asfarray", lambda values: np.asarray(values, dtype=float))

from emva1288.process import Data1288, LoadImageData, ParseEmvaDescriptorFile, Results1288

Floats = NDArray[np.float64]

TOLERANCE = 0.02


def clipped_variance(mean: float, sensor: dict[str, float]) -> float:
    """The temporal variance, in electrons, of counts that end at the full well, over all pixels."""
    responses = 1 + sensor["prnu"] * np.linspace(-4, 4, 41)
    weights = stats.norm.pdf(np.linspace(-4, 4, 41))
    variances = []
    for pixel in mean * responses:
        reach = int(8 * np.sqrt(pixel))
        counts = np.arange(max(0, int(pixel) - reach), int(pixel) + reach)
        chances = stats.poisson.pmf(counts, pixel)
        clipped = np.minimum(counts, sensor["full_well"])
        centre = np.sum(chances * clipped)
        variances.append(np.sum(chances * (clipped - centre) ** 2))
    return float(np.average(variances, weights=weights))


def check_photons(
    verdict: Verdict, sensor: dict[str, float], times: Floats, photons: Floats
) -> None:
    """Compares the photons in the list of frames with E A t λ / (h c)."""
    power = sensor["irradiance"] * sensor["pixel_pitch"] ** 2
    expected = power * times * sensor["wavelength"] / (constants.h * constants.c)
    # The list gives exposure times to 1 ps, of 0.3 ms at least.
    deviation = float(np.max(np.abs(photons / expected - 1)))
    verdict.within("photons per pixel (CODATA)", deviation, 2e-9)


def main() -> None:
    folder = FRAMES / "photon_transfer"
    run("examples/photon_transfer", str(folder))
    sensor: dict[str, float] = json.loads((folder / "sensor.json").read_text())
    quiet = {"loglevel": logging.ERROR}
    series = ParseEmvaDescriptorFile(str(folder / "emva1288.txt"), **quiet)
    data = Data1288(LoadImageData(series.images, **quiet).data)
    results = Results1288(data.data, **quiet)

    verdict = Verdict()
    times, photons = (np.asarray(results.temporal[key], float) for key in ("texp", "u_p"))
    check_photons(verdict, sensor, times * 1e-9, photons)
    rows = {
        "quantum_efficiency": results.QE / 100,
        "gain": results.K,
        "dark_noise": results.sigma_d,
        "dark_current": results.u_I_mean,
        "dsnu": results.DSNU1288,
        "prnu": results.PRNU1288 / 100,
        "full_well": results.u_e_sat,
    }
    for name, measured in rows.items():
        what = f"{name}: {measured:.5g}, put in {sensor[name]:.5g}"
        verdict.within(what, measured / sensor[name] - 1, TOLERANCE)

    electrons = sensor["quantum_efficiency"] * photons + sensor["dark_current"] * times * 1e-9
    variances = [clipped_variance(mean, sensor) for mean in electrons]
    largest = int(np.argmax(variances))
    what = f"exposure of the largest variance: {results.index_u_ysat}, by theory {largest}"
    verdict.within(what, results.index_u_ysat - largest, 0)
    verdict.end()


if __name__ == "__main__":
    main()
