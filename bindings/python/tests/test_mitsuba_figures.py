"""The paper's figures by Mitsuba against `tem00 render`: the same scene, pixel by pixel.

Needs the program. By default cargo builds and runs it; the environment variable TEM00_PROGRAM names
one that is there already. The parts of the pictures that are compared by default have 64 samples
per pixel; TEM00_FIGURE_SAMPLES=256 compares whole pictures with 256.
"""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import mitsuba as mi
import numpy as np
import pytest
from exr_layers import read_layers
from scipy import stats

mi.set_variant("llvm_ad_rgb")

import tem00.mitsuba  # noqa: E402

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

tem00.mitsuba.register()

ROOT = Path(__file__).resolve().parents[3]
SAMPLES = int(os.environ.get("TEM00_FIGURE_SAMPLES", "64"))
WHOLE = SAMPLES >= 256
# Pictures by Mitsuba whose spread tells their variance.
ROUNDS = 16
SEED = 11


@dataclass(frozen=True)
class Figure:
    """A figure: our scene, and the part that is compared by default (x, y, width, height).

    Mitsuba takes `more` times our samples: where few of its paths find light, the spread of few
    says nothing.
    """

    number: int
    ours: str
    window: tuple[int, int, int, int]
    speckle: bool
    more: int = 1

    @property
    def theirs(self) -> Path:
        return ROOT / "examples" / "scenes" / "mitsuba" / f"figure_{self.number}.xml"


FIGURES = [
    Figure(9, "line_on_metal", (160, 30, 160, 140), False, more=16),
    Figure(10, "grazing_waist", (200, 50, 240, 60), False),
    Figure(11, "spot", (90, 60, 140, 120), True),
    Figure(12, "line_with_speckle", (100, 45, 200, 30), True),
]


@dataclass(frozen=True)
class Pair:
    """A picture by both programs, and the variance of its difference."""

    ours: Array
    theirs: Array
    variance: Array

    @property
    def difference(self) -> Array:
        return self.theirs - self.ours


def program() -> list[str]:
    """Return the command line of `tem00`."""
    given = os.environ.get("TEM00_PROGRAM")
    return [given] if given else ["cargo", "run", "-q", "--release", "-p", "tem00-cli", "--"]


def our_layers(figure: Figure, folder: Path, *settings: str) -> dict[str, NDArray[np.float32]]:
    """Render a figure by `tem00`, with other settings of the scene, and return its layers."""
    command = [*program(), "render", f"examples/scenes/{figure.ours}.toml"]
    command += ["--spp", str(SAMPLES), "--seed", str(SEED), "-o", str(folder)]
    for setting in settings:
        command += ["--set", setting]
    if not figure.speckle:
        command.append("--no-speckle")
    if not WHOLE:
        command += ["--crop", ",".join(str(side) for side in figure.window)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    assert json.loads((folder / f"{figure.ours}.json").read_text())["seed"] == SEED
    return read_layers(folder / f"{figure.ours}.exr")


def their_pictures(figure: Figure, scene: mi.Scene) -> Array:
    """Render a figure by Mitsuba, several times, and return the red channel of each picture."""
    samples = figure.more * SAMPLES // ROUNDS
    pictures = [mi.render(scene, spp=samples, seed=seed) for seed in range(ROUNDS)]
    red = np.array([np.array(picture)[..., 0] for picture in pictures], dtype=np.float64)
    if WHOLE:
        return red
    x, y, width, height = figure.window
    return red[:, y : y + height, x : x + width]


def pair(layers: dict[str, NDArray[np.float32]], theirs: Array) -> Pair:
    """Return both pictures of a figure, from our layers and from Mitsuba's pictures."""
    ours = layers["laser_0.radiance"]
    # The variance that `tem00 render` writes is that of independent samples: an upper bound, as its
    # own are spread more evenly.
    variance = layers["laser_0.variance"] + theirs.var(axis=0, ddof=1) / ROUNDS
    return Pair(ours.astype(np.float64), theirs.mean(axis=0), variance.astype(np.float64))


def blocks(image: Array, side: int = 8) -> Array:
    """Return the sums over blocks of pixels, without the rest at the lower and right edges."""
    rows, columns = (length // side for length in image.shape)
    cut = image[: rows * side, : columns * side]
    sums: Array = cut.reshape(rows, side, columns, side).sum(axis=(1, 3))
    return sums


def assert_within_noise(both: Pair, side: int) -> None:
    """Chi-squared test of the differences of blocks, at a level of 1e-3.

    Its variances are upper bounds, and the true ones about half of them: a systematic difference of
    0.7 standard errors of a block is found.
    """
    difference, variance = blocks(both.difference, side), blocks(both.variance, side)
    # Where next to nothing arrives, few samples do not make a normal distribution.
    light = blocks(both.ours, side)
    lit = light > 0.01 * light.max()
    chi_squared = np.sum(difference[lit] ** 2 / variance[lit])
    assert chi_squared < stats.chi2.isf(1e-3, lit.sum())


def assert_same_light(both: Pair) -> None:
    """The means of the pictures differ by less than 3 standard errors."""
    error = np.sqrt(both.variance.sum())
    assert abs(both.difference.sum()) < 3.0 * error
    # And that is a small part of the light; the most in figure 9, where few paths find the lobes.
    # There the facets of Mitsuba are masked and shadowed independently, ours by one height: 1e-3.
    assert error < 1e-2 * both.ours.sum()


@pytest.mark.parametrize("figure", FIGURES, ids=lambda figure: f"figure_{figure.number}")
def test_mitsuba_and_tem00_render_the_same_figure(figure: Figure, tmp_path: Path) -> None:
    scene = mi.load_file(str(figure.theirs), seed=SEED)
    both = pair(our_layers(figure, tmp_path), their_pictures(figure, scene))
    assert_same_light(both)
    assert_within_noise(both, side=1)
    assert_within_noise(both, side=8)


@pytest.mark.parametrize("figure", FIGURES[2:], ids=lambda figure: f"figure_{figure.number}")
def test_another_seed_gives_another_pattern(figure: Figure, tmp_path: Path) -> None:
    layers = our_layers(figure, tmp_path)
    before = np.maximum(layers["laser_0.single"], 1e-6)
    ours = layers["laser_0.radiance"] / before
    scene = {seed: mi.load_file(str(figure.theirs), seed=seed) for seed in (SEED, SEED + 1)}
    smooth = np.array(mi.render(mi.load_file(str(figure.theirs), speckle=False), spp=64))[..., 0]
    x, y, width, height = (0, 0, *smooth.shape[::-1]) if WHOLE else figure.window
    window = (slice(y, y + height), slice(x, x + width))
    lit = smooth[window] > 0.1 * smooth.max()
    correlation = {}
    for seed, one in scene.items():
        ratio = np.array(mi.render(one, spp=64, seed=0))[..., 0] / (smooth + 1e-6)
        correlation[seed] = np.corrcoef(ours[lit], ratio[window][lit])[0, 1]
    # What noise is left in a ratio of 64 samples; 1/sqrt(number of speckles) times 4 for others.
    assert correlation[SEED] > 0.98
    assert abs(correlation[SEED + 1]) < 0.3
