"""The integrator `speckle` against Mitsuba's own and against the library's look-up."""

from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np
import pytest
import scenes
from scenes import HEIGHT, WIDTH, Image, Scene

from tem00 import speckle as patterns

DIRECT = 2
"""The `max_depth` of direct light."""
SEED_STEP = 0x9E3779B97F4A7C15


def speckle(**properties: Any) -> Scene:
    """Return an integrator for direct light with speckle of four pixels."""
    return {"type": "speckle", "max_depth": DIRECT, "speckle_size": 4.0} | properties


def factor(**parts: Any) -> Image:
    """Return the picture with speckle divided by the same one without, one sample per pixel."""
    integrator = parts.pop("integrator", speckle())
    plain = scenes.render(integrator | {"speckle": False}, **parts)
    assert np.all(plain > 0), "the laser must light the whole picture"
    return scenes.render(integrator, **parts) / plain


def film_positions(**parts: Any) -> tuple[Image, Image]:
    """Return x and y, in pixels of the film, of the only sample of each pixel.

    They are where the sample meets the plate, seen from the lens. The samples are those of every
    integrator with the same seed, as the place on the film takes the first random numbers.
    """
    integrator = {"type": "aov", "aovs": "point:position"}
    point = np.asarray(mi.render(scenes.scene(integrator, **parts), seed=0), dtype=float)
    per_metre = WIDTH / 2 / (scenes.DISTANCE * np.tan(np.radians(scenes.FOV / 2)))
    return WIDTH / 2 + per_metre * point[:, :, 0], HEIGHT / 2 - per_metre * point[:, :, 1]


def stack(seed: int, speckle_size: float = 4.0) -> patterns.SpeckleStack:
    """Return the pattern that the library plans for the picture."""
    size = (float(WIDTH), float(HEIGHT))
    needs = patterns.StackNeeds(
        image=size, region=size, speckle_size=speckle_size, motion=None, frames=1,
        memory_limit=1 << 30,
    )
    return patterns.StackPlan.new(needs).stack(seed, patterns.StackOptions())


def test_without_speckle_it_is_mitsubas_path_tracer() -> None:
    # The same random numbers in the same order: only roundings differ, some 100 of 6e-8 along a path.
    parts: Scene = {
        "mirror": {"type": "sphere", "center": [0.005, 0, 0.004], "radius": 0.004,
                   "bsdf": {"type": "conductor"}},
        "ball": {"type": "sphere", "center": [-0.006, 0, 0.004], "radius": 0.004,
                 "bsdf": {"type": "roughplastic"}},
        "lamp": {"type": "rectangle", "emitter": {"type": "area", "radiance": 20.0},
                 "to_world": scenes.looking([0.02, 0.05, 0.1], [0, 0, 0], [0, 0, 1])
                 @ mi.ScalarTransform4f().scale(0.01)},
        "sky": {"type": "constant", "radiance": 3.0},
        "sensor": scenes.camera(samples=16, film={"rfilter": {"type": "gaussian"}}),
    }
    depth = {"max_depth": 6, "rr_depth": 3}
    ours = scenes.render(speckle(speckle=False) | depth, **parts)
    theirs = scenes.render({"type": "path"} | depth, **parts)
    np.testing.assert_allclose(ours, theirs, rtol=1e-5)


def test_every_sample_has_the_factor_of_its_place_on_the_film() -> None:
    pattern = stack((7 + SEED_STEP) % 2**64)
    x, y = film_positions()
    scale = pattern.speckle_size / 4.0
    expected = pattern.intensity_at(scale * x, -scale * y, 0.0)
    # Positions are known to 1e-5 pixels, in which the intensity changes by 2 π / 4 · 1e-5 · I_max.
    np.testing.assert_allclose(factor(integrator=speckle(seed=7)), expected, atol=3e-4)
