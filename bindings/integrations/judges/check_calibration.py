"""OpenCV judges the corners of rendered checkerboards and the camera that they give.

`examples/calibration_boards` writes the frames, the corners that the camera must see and those that
this project finds. OpenCV finds corners on the same frames and calibrates with its own; `tem00
calibrate` calibrates from the frames. OpenCV counts pixels from the centre of the first one.
"""

import csv
import json
import subprocess
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from judge import FRAMES, Verdict, run

Places = NDArray[np.float64]

CORNERS = (9, 6)
SQUARE = 8.4e-3
PITCH = 8e-6
# The scene of the example.
IMAGE_DISTANCE = 12e-3 * 0.25 / (0.25 - 12e-3)
K1 = -0.2


def read_corners(path: Path) -> dict[int, tuple[Places, Places]]:
    """Returns for each board the corners as projected and as found, in pixels of OpenCV."""
    boards: dict[int, list[list[float]]] = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            names = ["x_pixel", "y_pixel", "x_found_pixel", "y_found_pixel"]
            boards.setdefault(int(row["board"]), []).append([float(row[n]) - 0.5 for n in names])
    arrays = {number: np.array(rows) for number, rows in boards.items()}
    return {number: (rows[:, :2], rows[:, 2:]) for number, rows in arrays.items()}


def by_opencv(path: Path, expected: Places) -> Places:
    """Finds the corners of an image by OpenCV, in the order of the expected ones."""
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    good, corners = cv2.findChessboardCorners(image, CORNERS)
    if not good:
        raise SystemExit(f"OpenCV finds no board in {path}")
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 100, 1e-4)
    corners = cv2.cornerSubPix(image, corners, (7, 7), (-1, -1), stop).reshape(-1, 2)
    distances = np.linalg.norm(expected[:, None] - corners[None], axis=2)
    return np.asarray(corners[distances.argmin(axis=1)], dtype=np.float64)


def rms(differences: Places) -> float:
    """Returns the root mean square distance."""
    return float(np.sqrt((differences**2).sum(axis=1).mean()))


def calibrated_by_opencv(images: list[Places]) -> tuple[float, Places, float]:
    """Returns the image distance in metres, the principal point in our pixels, and k1."""
    columns, rows = CORNERS
    grid = [[i * SQUARE, -j * SQUARE, 0.0] for j in range(rows) for i in range(columns)]
    board = np.array(grid, dtype=np.float32)
    start = np.array([[1500.0, 0, 319.5], [0, 1500.0, 239.5], [0, 0, 1]])
    flags = (
        cv2.CALIB_USE_INTRINSIC_GUESS
        | cv2.CALIB_FIX_ASPECT_RATIO
        | cv2.CALIB_ZERO_TANGENT_DIST
        | cv2.CALIB_FIX_K2
        | cv2.CALIB_FIX_K3
    )
    points = [image.astype(np.float32) for image in images]
    _, matrix, distortion, _, _ = cv2.calibrateCamera(
        [board] * len(points), points, (640, 480), start, np.zeros(5), flags=flags
    )
    return float(matrix[0, 0]) * PITCH, matrix[:2, 2] + 0.5, float(np.ravel(distortion)[0])


def check_corners(verdict: Verdict, folder: Path) -> tuple[list[Places], list[Places]]:
    """Compares the corners, and returns those of OpenCV and the projected ones."""
    theirs, projected = [], []
    for number, (expected, ours) in read_corners(folder / "corners.csv").items():
        found = by_opencv(folder / f"board_{number:02}.png", expected)
        theirs.append(found)
        projected.append(expected)
        # 16 samples per pixel and 8 bits leave some hundredths; the gradients at which OpenCV looks
        # take their noise from the edges alone, and four times as much.
        verdict.within(f"board {number}: ours, projected / pixel", rms(ours - expected), 0.05)
        verdict.within(f"board {number}: OpenCV's, projected / pixel", rms(found - expected), 0.15)
        verdict.within(f"board {number}: ours, OpenCV's / pixel", rms(ours - found), 0.15)
    return theirs, projected


def check_conventions(verdict: Verdict, projected: list[Places]) -> None:
    """From the projected corners OpenCV must find the camera of the scene.

    It takes corners in single precision, 3e-5 pixel of 640.
    """
    distance, principal, k1 = calibrated_by_opencv(projected)
    verdict.within("OpenCV's image distance (relative)", distance / IMAGE_DISTANCE - 1, 1e-5)
    offset = rms((principal - [320, 240])[None])
    verdict.within("OpenCV's principal point / pixel", offset, 0.02)
    verdict.within("OpenCV's k1", k1 - K1, 1e-4)


def check_camera(verdict: Verdict, folder: Path, theirs: list[Places]) -> None:
    """Compares the camera of `tem00-inspect calibrate` with the scene and with that of OpenCV."""
    output = folder / "calibration.json"
    options = ["--corners", "9x6", "--square", "8.4 mm", "--pixel-pitch", "8 um", "--radial", "1"]
    run("tem00-inspect", "calibrate", str(folder), *options, "-o", str(output))
    record = json.loads(output.read_text())
    camera = record["camera"]
    variances = np.diag(np.array(record["covariance"]["rows"]))
    distance, principal, k1 = calibrated_by_opencv(theirs)
    ours = 1 / (1 / camera["focal_length"] - 1 / camera["focus_distance"])
    values = [
        (0, "image distance", ours, distance, IMAGE_DISTANCE),
        (1, "principal point x", camera["principal_point"][0], principal[0], 320.0),
        (2, "principal point y", camera["principal_point"][1], principal[1], 240.0),
        (5, "k1", camera["distortion"]["k1"], k1, K1),
    ]
    for place, name, value, other, true in values:
        sigma = float(np.sqrt(variances[place]))
        verdict.within(f"{name}: ours, scene (in our uncertainty)", (value - true) / sigma, 4)
        # The same frames but other corners: the error of OpenCV's counts, too.
        verdict.within(f"{name}: ours, OpenCV's (in our uncertainty)", (value - other) / sigma, 8)


def main() -> None:
    """Renders the boards, has both sides look at them, and compares."""
    verdict = Verdict()
    folder = FRAMES / "calibration"
    run("examples/calibration_boards", str(folder))
    theirs, projected = check_corners(verdict, folder)
    check_conventions(verdict, projected)
    check_camera(verdict, folder, theirs)
    verdict.end()


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:
        raise SystemExit(error.stderr) from error
