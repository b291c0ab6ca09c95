"""Places of a line by `tem00-inspect lines`, photutils and OpenPIV on the same frames.

The judges get what an estimate looks at: the window about the maximum of the column after a
triangular filter, less the background that `tem00-inspect lines` states. They return places in it.

- The centre of gravity of photutils is that of `centre_of_gravity`; over three pixels it is what
  OpenPIV calls centroid. Its parabola and the one through logarithms are `parabola` and
  `log_gaussian`. These agree to the rounding of the table, 5e-7 pixels.
- The Gaussian that photutils fits stands on no background and is sampled; that of `gaussian_fit`
  has one and is integrated. To first order the centre of a symmetric line feels neither. What is
  left is of second order in the noise, σ = (w/2)/√N = 3/√20000 = 0.02 pixels of a line without
  speckle, and must stay below a tenth of it in each column.
"""

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from openpiv.pyprocess import find_subpixel_peak_position
from photutils.centroids import centroid_1dg, centroid_com
from PIL import Image
from scipy.ndimage import uniform_filter1d

from judge import FRAMES, Verdict, run

Floats = NDArray[np.float64]

WINDOW = 31
ROUNDING = 1e-6


def found(frame: Path, detector: str, window: int) -> list[dict[str, str]]:
    """The valid points that `tem00-inspect lines` finds."""
    folder = frame.parent / f"{detector}_{window}"
    options = ["--detector", detector, "--window", str(window), "--min-peak", "5"]
    bits = ["--bits", "12"] if "12_bit" in frame.name else []
    run("tem00-inspect", "lines", str(frame), "-o", str(folder), *options, *bits)
    with (folder / f"{frame.stem}.csv").open(newline="") as table:
        return [row for row in csv.DictReader(table) if row["valid"] == "1"]


def window_of(column: Floats, pixels: int) -> slice:
    """The window about the maximum of the column after a triangular filter."""
    width = (pixels // 4) | 1
    smooth = uniform_filter1d(uniform_filter1d(column, width), width)
    middle = int(np.argmax(smooth))
    return slice(middle - pixels // 2, middle + pixels // 2 + 1)


def gravity(values: Floats) -> float:
    return float(centroid_com(values)[0])


def gaussian(values: Floats) -> float:
    # It fits the sums along both directions, and needs a peak in each.
    return float(centroid_1dg(np.outer(values, [0.2, 0.5, 1.0, 0.5, 0.2]))[1])


def open_piv(method: str, values: Floats) -> float:
    # The peak must have neighbours in both directions.
    image = np.column_stack([np.zeros_like(values), values, np.zeros_like(values)])
    return float(find_subpixel_peak_position(image, subpixel_method=method, backend="python")[0])


JUDGES = [
    ("centre_of_gravity", WINDOW, "photutils centroid_com", gravity),
    ("centre_of_gravity", 3, "OpenPIV centroid", lambda values: open_piv("centroid", values)),
    ("parabola", WINDOW, "OpenPIV parabolic", lambda values: open_piv("parabolic", values)),
    ("log_gaussian", WINDOW, "OpenPIV gaussian", lambda values: open_piv("gaussian", values)),
    ("gaussian_fit", WINDOW, "photutils centroid_1dg", gaussian),
]


def has_one_peak(values: Floats) -> bool:
    """Return whether one pixel is the greatest: of equal ones everybody may take another."""
    return int(np.sum(values == values.max())) == 1


def check(frame: Path, verdict: Verdict) -> None:
    image = np.asarray(Image.open(frame), float)
    smooth = frame.stem.startswith("smooth")
    for detector, pixels, judge, place in JUDGES:
        if detector == "gaussian_fit" and not smooth:
            # Under speckle the column is no Gaussian, and what fits best depends on the model.
            continue
        differences = []
        for point in found(frame, detector, pixels):
            column = image[:, int(point["column"])]
            window = window_of(column, pixels)
            values = column[window] - float(point["background_DN"])
            if has_one_peak(values):
                theirs = window.start + 0.5 + place(values)
                differences.append(abs(float(point["position_px"]) - theirs))
        what = f"{frame.stem}: {detector} {pixels}, {judge} ({len(differences)})"
        tolerance = 0.002 if detector == "gaussian_fit" else ROUNDING
        verdict.within(what, max(differences), tolerance)
        if len(differences) < image.shape[1] // 2:
            verdict.within(f"{what}: columns that were compared", len(differences), 0)


def main() -> None:
    folder = FRAMES / "line_frames"
    run("examples/line_frames", str(folder))
    verdict = Verdict()
    for frame in sorted(folder.glob("*.png")):
        check(frame, verdict)
    verdict.end()


if __name__ == "__main__":
    main()
