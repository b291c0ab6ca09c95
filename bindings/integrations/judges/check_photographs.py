"""`tem00 stats` beside NumPy and SciPy, on photographs of speckle that others took.

The photographs are not part of this project. The check runs where the environment variable
TEM00_PHOTOGRAPHS names a folder that holds them, made from these files:

- `ground_glass_hene.png`: HeNe light through ground glass.
  https://github.com/bu-cisl/Deep-Speckle-Correlation, commit bd2f915f, `test_data/number_8.npy`,
  frame 0 times 65535, 256 × 256 pixels of 16 bits (BSD-3-Clause; Li, Xue, Tian, Optica 5, 1181,
  2018).
- `rat_cortex.png`: a rat's cortex, blurred by the flow of blood.
  https://github.com/pkeilbach/pylsci, commit d0b021ff, `binder/img/spatial.tif`, the 300 × 300
  pixels of 8 bits from (200, 200) on (MIT).

Both are compared as they are and divided by the mean over 41 × 41 pixels: contrast, grain size, and
the Kolmogorov-Smirnov distance of independent pixels to the exponential law. Nothing of it is
fitted: the definitions agree, and what is left is the single precision of the program, a few 1e-7.
"""

import json
import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage, optimize, signal, special, stats

from judge import Verdict, run

Floats = NDArray[np.float64]

NAMES = ["ground_glass_hene.png", "rat_cortex.png"]
WINDOW = 41
ROUNDING = 1e-6


def airy(lag: float) -> float:
    """The autocovariance of speckle behind a circular pupil, over the lag in grain sizes."""
    x = math.pi * lag
    return float((2 * special.j1(x) / x) ** 2) if x > 0 else 1.0


def airy_lag(value: float) -> float:
    """The lag at which it has this value, before its first zero."""
    return float(optimize.brentq(lambda lag: airy(lag) - value, 0.0, 1.219669))


def grain_sizes(image: Floats) -> tuple[float, float]:
    """The sizes along x and y.

    Each is the lag of one half, interpolated on the Airy curve, by that of a grain of one pixel.
    """
    around = image - image.mean()
    counts = signal.fftconvolve(np.ones_like(image), np.ones_like(image))
    covariance = signal.fftconvolve(around, around[::-1, ::-1]) / counts
    height, width = image.shape

    def size(line: Floats) -> float:
        line = line / line[0]
        outer = int(np.argmax(line <= 0.5))
        near, half, far = (airy_lag(value) for value in (line[outer - 1], 0.5, line[outer]))
        return (outer - 1 + (half - near) / (far - near)) / half

    return size(covariance[height - 1, width - 1 :]), size(covariance[height - 1 :, width - 1])


def kolmogorov_smirnov(image: Floats, size: float) -> float:
    """The distance to the exponential law, of pixels apart by the first zero of the Airy curve."""
    stride = math.ceil(1.219669 * size)
    height, width = (side // stride * stride for side in image.shape)
    samples = image[:height:stride, :width:stride].ravel() / image.mean()
    return float(stats.kstest(samples, "expon").statistic)


def measured(photograph: Path, *options: str) -> dict[str, float]:
    """The numbers of `tem00 stats`."""
    found = json.loads(run("tem00", "stats", str(photograph), "--json", *options))
    return {row["quantity"]: row["measured"] for row in found["rows"]}


def compare(
    state: str, found: dict[str, float], numbers: dict[str, float], verdict: Verdict
) -> None:
    """Sets the numbers of the program beside these."""
    for quantity, number in numbers.items():
        verdict.within(f"{state}: {quantity} {number:.4f}", found[quantity] / number - 1, ROUNDING)


def check(photograph: Path, verdict: Verdict) -> None:
    image = np.asarray(Image.open(photograph), float)
    x, y = grain_sizes(image)
    numbers = {"contrast": float(image.std(ddof=1) / image.mean())}
    numbers |= {"speckle size x (pixels)": x, "speckle size y (pixels)": y}
    compare(photograph.stem, measured(photograph), numbers, verdict)

    # The mean over those pixels of a window that exist. It takes a fraction of the variance, which
    # the program puts back.
    part = ndimage.uniform_filter(np.ones_like(image), WINDOW, mode="constant")
    flat = image * part / ndimage.uniform_filter(image, WINDOW, mode="constant")
    x, y = grain_sizes(flat)
    contrast = float(flat.std(ddof=1) / flat.mean())
    coherence_area = float(4 / math.pi * np.mean(1 / (part * WINDOW**2)))
    numbers = {
        "contrast": contrast * (1 + 0.5 * (1 + contrast**2) * coherence_area * x * y),
        "speckle size x (pixels)": x * (1 + 0.675 * coherence_area * x**2),
        "speckle size y (pixels)": y * (1 + 0.675 * coherence_area * y**2),
        "KS distance to exponential": kolmogorov_smirnov(flat, max(x, y)),
    }
    found = measured(photograph, f"--flatten={WINDOW}")
    compare(f"{photograph.stem}, flat", found, numbers, verdict)


def main() -> None:
    folder = os.environ.get("TEM00_PHOTOGRAPHS")
    if folder is None:
        print("skipped: TEM00_PHOTOGRAPHS names no folder of photographs")
        return
    verdict = Verdict()
    for name in NAMES:
        check(Path(folder) / name, verdict)
    verdict.end()


if __name__ == "__main__":
    main()
