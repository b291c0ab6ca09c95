"""The integrator ``speckle`` in the light of lasers that have a linewidth."""

from __future__ import annotations

from typing import Any

import mitsuba as mi
import numpy as np
import pytest
from test_mitsuba_speckle import (
    DIRECT,
    LASER,
    PLATE,
    SPECKLE_SIZE,
    Array,
    Node,
    camera,
    picture,
    plain,
    scene,
    settings,
    text_of,
)

from tem00 import ParameterError
from tem00.coherence import ResolutionCell, Spectrum
from tem00.mitsuba.linewidth import LineLight, find_lights
from tem00.mitsuba.look_up import pupil_at
from tem00.mitsuba.patterns import Pattern, generate
from tem00.mitsuba.surfaces import Surface

IMAGE = (900, 900)


def light_of(laser: Node, relief: tuple[float, float] = (0.0, 0.0)) -> LineLight:
    """Return the light that the integrator finds on the plate."""
    loaded = scene(DIRECT, plate=PLATE, laser={**LASER, **laser}, camera=camera(320, 320))
    surfaces = [Surface("", (1.0,), 0, relief)]
    ((light,),) = find_lights(loaded, loaded.sensors()[0], loaded.emitters(), surfaces)
    assert light is not None
    return light


def pattern_of(light: LineLight | None, **properties: Any) -> Pattern:
    """Return the pattern of a light on all shapes."""
    surfaces = [Surface("", (1.0,), 0)]
    ((pattern,),) = generate(settings(**properties), [SPECKLE_SIZE], IMAGE, surfaces, [[light]])
    return pattern


def factors(pattern: Pattern, pupil: float = 0.0) -> Array:
    """Return the factors at the pixels' centres."""
    pattern.move_to(pupil, (0.0, 0.0))
    x, y = np.meshgrid(np.arange(IMAGE[0]) + 0.5, np.arange(IMAGE[1]) + 0.5)
    values = np.array(pattern.factor(mi.Point2f(x.ravel(), y.ravel())), dtype=np.float64)
    return values.reshape(IMAGE[::-1])


def covariance(a: Array, b: Array) -> float:
    return float(np.mean(a * b) / (a.mean() * b.mean()) - 1.0)


def test_the_cell_is_that_of_the_scene() -> None:
    found = light_of({"linewidth": 5e-9})
    expected = ResolutionCell(
        [0.5, 0.0, np.sqrt(0.75)], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 1e-3 / 0.3, 650e-9
    )
    assert found.line == Spectrum(650e-9, 5e-9)
    # The points of the plate lie up to 6 mm from the middle.
    assert found.cell.tilt_wave_number == pytest.approx(expected.tilt_wave_number, rel=0.01)
    assert np.abs(found.axis) == pytest.approx([1.0, 0.0], abs=0.01)


@pytest.mark.parametrize(
    ("laser", "relief"),
    [
        ({"linewidth": 5e-9}, (0.0, 0.0)),
        ({"linewidth": 10e-9, "spectrum": "rectangular"}, (2e-6, 0.0)),
        ({"linewidth": 2e-9, "spectrum": "lorentzian"}, (4e-6, 0.0)),
        ({"linewidth": 8e-9, "spectrum": "comb", "lines": 5}, (4e-6, 60e-6)),
        ({"linewidth": 30e-9}, (20e-6, 0.0)),
        ({"source_half_angle": 0.3}, (0.0, 0.0)),
        ({"linewidth": 5e-9, "source_half_angle": 0.1}, (2e-6, 0.0)),
    ],
)
def test_contrasts_are_those_of_the_law(laser: Node, relief: tuple[float, float]) -> None:
    light = light_of(laser, relief)
    law = light.cell.contrast(light.line)
    values = factors(pattern_of(light))
    assert values.mean() == pytest.approx(1.0, abs=0.02)
    # 40 000 speckles: 0.8 % of 1, and less of sums; 1 % by the rule of heights.
    assert np.sqrt(covariance(values, values)) == pytest.approx(law, rel=0.03)


def test_grains_are_longer_along_the_tilt() -> None:
    light = light_of({"linewidth": 20e-9})
    values = factors(pattern_of(light))
    lag = 4
    along = covariance(values[:, lag:], values[:, :-lag])
    across = covariance(values[lag:], values[:-lag])
    speckles = lag / SPECKLE_SIZE
    lags = (speckles, 0.0), (0.0, speckles)
    expected = [light.cell.autocovariance(light.line, each) for each in lags]
    assert expected[0] > 1.8 * expected[1]
    assert [along, across] == pytest.approx(expected, abs=0.015)


def test_frames_of_a_motion_along_and_across_the_tilt_are_those_of_the_law() -> None:
    flat = {"path": "straight", "half_period": 32, "length": 2}
    light = light_of({"linewidth": 5e-9})
    across = light._replace(axis=(0.0, 1.0))
    for turned, displacement in ((light, (0.25, 0.0)), (across, (0.0, 0.25))):
        pattern = pattern_of(turned, **flat)
        here, there = factors(pattern), factors(pattern, 0.25)
        expected = light.cell.covariance(light.line, displacement)
        assert covariance(here, there) == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize(
    ("path", "u"),
    [
        ({}, 0.0),
        ({"path": "straight", "half_period": 8, "length": 2}, 3.0),
        ({"path": "circle", "half_period": 8}, -5.0),
    ],
)
def test_a_line_without_a_width_has_the_pattern_of_one_wavelength(path: Node, u: float) -> None:
    narrow = light_of({"linewidth": 5e-9})._replace(line=Spectrum(650e-9, 1e-16))
    # Four samples to a speckle: with fewer, the splines of the stack miss them.
    (part,) = pattern_of(narrow, pattern_size=512, pattern_diameter=128, **path).parts
    columns, rows = part.stack.size
    x, y = np.meshgrid(np.arange(columns, dtype=float), np.arange(rows, dtype=float))
    one = np.asarray(part.stack.intensity_at(x, y, u))
    other = narrow.pattern(part.fields, pupil_at(part.stack, u))
    # A pupil that is not displaced by whole samples has some phasors on its edge more, or less.
    assert np.corrcoef(one.ravel(), other.ravel())[0, 1] > 0.9995


def test_the_pupil_moves_along_the_path_of_the_stack() -> None:
    pattern = pattern_of(None, path="straight", half_period=8, length=2)
    places = np.array([pupil_at(pattern.stack, u) for u in (0.0, 1.0, 1.5, 15.0, 15.5)])
    steps = np.hypot(*np.diff(places, axis=0).T) * 8.0
    assert steps == pytest.approx([1.0, 0.5, 13.5, 0.5])


def test_pictures_have_the_light_and_the_contrast_of_the_law() -> None:
    sensor = camera(160, 160)
    laser = {**LASER, "linewidth": 20e-9}
    parts: Node = {"plate": PLATE, "laser": laser, "camera": sensor}
    smooth, speckled = (picture(node, 64, **parts) for node in (plain(), DIRECT))
    ratio = speckled / smooth
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)
    light = light_of({"linewidth": 20e-9})
    # A pixel of a 4.5th of a speckle takes 2 % of the contrast, 1200 speckles leave 3 %.
    expected = light.cell.contrast(light.line)
    assert ratio.std() == pytest.approx(expected, rel=0.1)
    single = picture(DIRECT, 16, **{**parts, "laser": LASER})
    none = picture(DIRECT, 16, **{**parts, "laser": {**LASER, "linewidth": 0.0}})
    assert np.array_equal(single, none)


def test_a_shape_has_a_relief_of_its_own() -> None:
    parts: Node = {"plate": PLATE, "laser": {**LASER, "linewidth": 2e-9}, "camera": camera(96, 96)}
    flat, rough, own = (
        picture({**DIRECT, **relief}, 16, **parts)
        for relief in ({}, {"rms_height": 100e-6}, {"plate:rms_height": 100e-6})
    )
    assert rough.std() < 0.7 * flat.std()
    assert np.array_equal(rough, own)


@pytest.mark.parametrize(
    ("name", "laser", "integrator"),
    [
        ("linewidth", {"linewidth": -1e-9}, {}),
        ("linewidth", {"linewidth": 1e-7}, {}),
        ("linewidth", {"linewidth": float("nan")}, {}),
        ("source_half_angle", {"source_half_angle": -1.0}, {}),
        ("source_half_angle", {"source_half_angle": 20.0}, {}),
        ("spectrum", {"linewidth": 1e-9, "spectrum": "gausian"}, {}),
        ("lines", {"linewidth": 1e-9, "lines": 3}, {}),
        ("lines", {"linewidth": 1e-9, "spectrum": "comb", "lines": 2.5}, {}),
        ("lines", {"linewidth": 1e-9, "spectrum": "comb"}, {}),
        ("table", {"linewidth": 5e-9}, {"table": "amplitude"}),
        ("rms_height", {"linewidth": 5e-9}, {"rms_height": -1e-6}),
        ("plate:correlation_length", {"linewidth": 5e-9}, {"plate:correlation_length": -1.0}),
    ],
)
def test_what_cannot_be_is_refused_by_its_name(name: str, laser: Node, integrator: Node) -> None:
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture({**DIRECT, **integrator}, 1, plate=PLATE, laser={**LASER, **laser})
    assert name in text_of(caught.value)


def test_a_linewidth_needs_a_lens() -> None:
    sensor = {**camera(), "type": "perspective"}
    del sensor["aperture_radius"], sensor["focus_distance"]
    parts: Node = {"plate": PLATE, "laser": {**LASER, "linewidth": 5e-9}, "camera": sensor}
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture(DIRECT, 1, **parts)
    assert "thinlens" in text_of(caught.value)
