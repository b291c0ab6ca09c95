"""Shapes of several patterns by Mitsuba against `tem00 render`: the same scene, pixel by pixel.

Figure 11 whose plate has patterns and a polarisation of its own. Needs the program, as
test_mitsuba_figures.py does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mitsuba as mi
import numpy as np
import pytest
from test_mitsuba_figures import (
    FIGURES,
    SEED,
    assert_same_light,
    assert_within_noise,
    our_layers,
    pair,
    their_pictures,
)

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from test_mitsuba_figures import Array

SPOT = FIGURES[2]
PLATE = '<shape type="rectangle">'
INTEGRATOR = '<integrator type="speckle">'


def mixed(patterns: int, polarisation: float, table: str) -> mi.Scene:
    """Return figure 11 with these properties of its plate alone."""
    text = SPOT.theirs.read_text()
    assert text.count(PLATE) == text.count(INTEGRATOR) == 1
    properties = (
        f'<integer name="plate:patterns" value="{patterns}"/>'
        f'<float name="plate:polarisation" value="{polarisation}"/>'
        f'<string name="table" value="{table}"/>'
    )
    text = text.replace(PLATE, '<shape type="rectangle" id="plate">')
    return mi.load_string(text.replace(INTEGRATOR, INTEGRATOR + properties), seed=SEED)


def contrast(picture: Array, smooth: NDArray[np.float32]) -> float:
    """Return the contrast where the light is bright."""
    lit = smooth > 0.3 * smooth.max()
    ratio = picture[lit] / smooth[lit]
    return float(ratio.std() / ratio.mean())


@pytest.mark.parametrize(
    ("patterns", "polarisation", "table"),
    [(3, 1.0, "amplitude"), (4, 0.5, "intensity"), (20, 0.0, "intensity")],
)
def test_a_plate_of_several_patterns_is_that_of_tem00(
    patterns: int, polarisation: float, table: str, tmp_path: Path
) -> None:
    speckle = "surface[0].speckle"
    settings = (f"{speckle}.patterns={patterns}", f"{speckle}.polarisation={polarisation}")
    layers = our_layers(SPOT, tmp_path, *settings)
    both = pair(layers, their_pictures(SPOT, mixed(patterns, polarisation, table)))
    assert_same_light(both)
    assert_within_noise(both, side=1)
    assert_within_noise(both, side=8)

    # It is a mixture that both show: some 300 speckles are bright, averaged over their pixels.
    law = np.sqrt(0.5 * (1.0 + polarisation**2) / patterns)
    assert contrast(both.theirs, layers["laser_0.single"]) == pytest.approx(law, rel=0.25)
