"""The plugins in C++ against those in Python, and on the figures of Bergmann et al. 2016."""

from pathlib import Path

import mitsuba as mi
import numpy as np
import numpy.typing as npt
import pytest
from scipy.stats import binom

import tem00.mitsuba

FIGURES = Path(__file__).parents[3] / "scenes" / "mitsuba"
REPEATS = 5
BLOCK = 4
"""Side of a block in pixels: about one speckle, so that blocks show the pattern."""

Images = npt.NDArray[np.float64]


def pictures(variant: str, figure: str, samples: int) -> Images:
    """Return the mean of each block in independent pictures, [picture, row, column]."""
    mi.set_variant(variant)
    tem00.mitsuba.register()
    scene = mi.load_file(str(FIGURES / f"{figure}.xml"), spp=samples)
    drawn = []
    for seed in range(REPEATS):
        picture: Images = np.array(mi.render(scene, seed=mi.UInt32(seed)))
        grey = picture[:, :, 0].astype(float)
        rows, columns = (side // BLOCK for side in grey.shape)
        grey = grey[: rows * BLOCK, : columns * BLOCK]
        drawn.append(grey.reshape(rows, BLOCK, columns, BLOCK).mean(axis=(1, 3)))
    return np.array(drawn)


@pytest.mark.parametrize("figure", ["figure_9", "figure_10", "figure_11", "figure_12"])
def test_a_figure_is_the_same_in_scalar_and_vectorised_variants(figure: str) -> None:
    scalar = pictures("scalar_rgb", figure, samples=2)
    vector = pictures("llvm_ad_rgb", figure, samples=8)

    def student(first: Images, second: Images) -> Images:
        variance = (first.var(axis=0, ddof=1) + second.var(axis=0, ddof=1)) / REPEATS
        t: Images = (first.mean(axis=0) - second.mean(axis=0)) / np.sqrt(variance)
        return t

    # Student's t has at least 4 degrees of freedom. Of the whole picture: beyond 8.6 by 1e-3.
    assert abs(student(scalar.mean(axis=(1, 2)), vector.mean(axis=(1, 2)))) < 8.6
    # Of each lit block: beyond 4.60 in one of a hundred. With another pattern most would be.
    lit = vector.mean(axis=0) > 0.05 * vector.mean(axis=0).max()
    t = student(scalar[:, lit], vector[:, lit])
    assert t.size > 100
    assert np.count_nonzero(np.abs(t) > 4.60) <= binom.ppf(0.999, t.size, 0.01)
