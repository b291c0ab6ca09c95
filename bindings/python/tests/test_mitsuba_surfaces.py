"""The integrator ``speckle`` on surfaces of several patterns, and on shapes that move apart."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
from test_mitsuba_speckle import (
    DIRECT,
    HEIGHT,
    LASER,
    PLATE,
    SPECKLE_SIZE,
    WIDTH,
    Array,
    Node,
    Transform,
    camera,
    hidden_plate,
    picture,
    pixel_means,
    plain,
    render,
    scene,
    settings,
    stack_of,
    text_of,
)

from tem00 import ParameterError, speckle
from tem00.mitsuba.patterns import Pattern, generate
from tem00.mitsuba.surfaces import Surface, read_surfaces

MOVING = {**DIRECT, "path": "straight", "half_period": 32}
WIDE = (128, 96)


def half(side: float) -> Node:
    """Return the half of the plate to one side, -1 or 1."""
    place = Transform().translate([0.01 * side, 0.0, 0.0]) @ Transform().scale([0.01, 0.02, 1.0])
    return {**PLATE, "to_world": place}


def halves(size: tuple[int, int] = WIDE) -> Node:
    """Return a plate of two shapes, ``base`` and ``gear``, under a camera.

    They differ in their materials, as Mitsuba merges shapes that do not.
    """
    gear = {**half(1.0), "bsdf": {"type": "diffuse", "reflectance": 0.7}}
    return {"base": half(-1.0), "gear": gear, "laser": LASER, "camera": camera(*size)}


def mixture(patterns: int, polarisation: float) -> Surface:
    """Return all shapes with a mixture of patterns."""
    fractions = speckle.incoherent_fractions(patterns, polarisation, [1.0])
    return Surface("", tuple(fractions.tolist()), 0)


def factors(pattern: Pattern, image: tuple[int, int]) -> Array:
    """Return the factors at the pixels' centres."""
    pattern.move_to(0.0, (0.0, 0.0))
    x, y = np.meshgrid(np.arange(image[0]) + 0.5, np.arange(image[1]) + 0.5)
    return np.array(pattern.factor(mi.Point2f(x.ravel(), y.ravel())), dtype=np.float64)


@pytest.mark.parametrize(
    ("patterns", "polarisation", "table"),
    [
        (1, 0.0, "intensity"),
        (1, 0.6, "amplitude"),
        (4, 1.0, "intensity"),
        (3, 0.3, "amplitude"),
        (6, 0.0, "intensity"),
    ],
)
def test_mixtures_have_the_contrast_of_their_law(
    patterns: int, polarisation: float, table: str
) -> None:
    image = (1000, 750)
    surfaces = [mixture(patterns, polarisation)]
    ((pattern,),) = generate(settings(table=table), [SPECKLE_SIZE], image, surfaces)
    values = factors(pattern, image)

    expected = np.sqrt(0.5 * (1.0 + polarisation**2) / patterns)
    # The variance of n independent values with the kurtosis 3 + 6 C**2 of a gamma law; the
    # correlation area of the intensity behind a circular pupil is 4 / pi of the speckle size
    # squared.
    speckles = values.size / SPECKLE_SIZE**2 * np.pi / 4.0
    contrast = values.std() / values.mean()
    error = expected * np.sqrt((2.0 + 6.0 * expected**2) / (4.0 * speckles))
    assert contrast == pytest.approx(expected, abs=3.3 * error)
    assert values.mean() == pytest.approx(1.0, abs=3.3 * expected / np.sqrt(speckles))


@pytest.mark.parametrize("table", ["intensity", "amplitude"])
def test_a_mixture_is_the_sum_of_the_patterns_of_the_program(table: str) -> None:
    image = (WIDTH, HEIGHT)
    ((pattern,),) = generate(settings(table=table), [SPECKLE_SIZE], image, [mixture(2, 0.5)])
    fields = stack_of().field.independent(4)
    stacks = [speckle.SpeckleStack.generate(field, speckle.SlicePath.still()) for field in fields]
    scale = stacks[0].speckle_size / SPECKLE_SIZE
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    expected = sum(
        fraction * stack.intensity_at(scale * x, -scale * y, 0.0)
        for fraction, stack in zip((0.375, 0.125, 0.375, 0.125), stacks, strict=True)
    )
    assert np.abs(factors(pattern, image) - np.ravel(expected)).max() < 1.5e-3


def test_a_mixture_of_all_shapes_but_one() -> None:
    parts = halves()
    loaded = {"patterns": 4, "polarisation": 0.0, "gear:patterns": 1, "gear:polarisation": 1.0}
    ratio = picture({**DIRECT, **loaded}, 64, **parts) / picture(plain(), 64, **parts)
    alone = picture(DIRECT, 64, **parts) / picture(plain(), 64, **parts)
    left, right = np.split(ratio, 2, axis=1)
    # 300 speckles, whose patterns are those of pixels: a polarised one has 0.96 of its contrast.
    assert left.std() / left.mean() == pytest.approx(0.96 / np.sqrt(8.0), rel=0.25)
    # The gear has not moved, and shows the first of the four.
    assert np.array_equal(right, np.split(alone, 2, axis=1)[1])


def test_shapes_that_move_apart_change_by_their_own_correlation() -> None:
    parts = halves()
    loaded = scene({**MOVING, "gear:pupil_shift": 0.0}, **parts)
    smooth = picture(plain(), 64, **parts)
    before = np.split(render(loaded, 64) / smooth, 2, axis=1)
    parameters = mi.traverse(loaded)
    parameters["integrator.pupil_shift"] = mi.Float(0.25)
    parameters["integrator.gear:pupil_shift"] = mi.Float(3.0 / 32.0)
    parameters.update()
    after = np.split(render(loaded, 64) / smooth, 2, axis=1)

    path = speckle.SlicePath.straight(half_period=32, length=2)
    stack = speckle.SpeckleStack.generate(stack_of(image=WIDE).field, path)
    for was, now, u in zip(before, after, (8.0, 3.0), strict=True):
        measured = np.corrcoef(was.ravel(), now.ravel())[0, 1]
        # 300 speckles: (1 - r) / sqrt(300) times 1.5 for exponential intensities, with r = 0.5.
        assert measured == pytest.approx(stack.correlation_between(0.0, u), abs=3.3 * 0.043)


def test_a_shape_with_a_motion_has_a_pattern_of_its_own_and_the_others_keep_their_bits() -> None:
    parts = halves((WIDTH, HEIGHT))
    ratios = [
        picture({**DIRECT, **own}, 256, **parts) / picture(plain(), 256, **parts)
        for own in ({}, {"gear:shift_x": 0.0})
    ]
    (left, right), (left_beside, right_own) = (np.split(ratio, 2, axis=1) for ratio in ratios)
    assert np.array_equal(left, left_beside)
    assert abs(np.corrcoef(right.ravel(), right_own.ravel())[0, 1]) < 0.6
    # The seed of `tem00 render` for what moves apart.
    field = stack_of().field
    assert field.seed is not None
    own_field = field.with_seed(speckle.derived_seed(field.seed, "body", 1))
    means = pixel_means(speckle.SpeckleStack.generate(own_field, speckle.SlicePath.still()))
    assert np.corrcoef(right_own.ravel(), np.split(means, 2, axis=1)[1].ravel())[0, 1] > 0.999


def test_shapes_are_numbered_in_the_order_in_which_the_integrator_names_them() -> None:
    props = mi.Properties("speckle")
    # That which only has patterns moves with all others.
    for name in ("zinc:pupil_shift", "brass:patterns", "gear:shift_x", "gear:pupil_shift"):
        props[name] = 1
    surfaces, _ = read_surfaces(props)
    numbers = {surface.prefix: surface.motion for surface in surfaces}
    assert numbers == {"": 0, "zinc:": 1, "brass:": 0, "gear:": 2}


def test_a_shift_of_a_shape_moves_its_pattern_alone() -> None:
    parts = halves((WIDTH, HEIGHT))
    loaded = scene({**DIRECT, "gear:shift_y": 0.0}, **parts)
    smooth = picture(plain(), 256, **parts)
    before = np.split(render(loaded, 256) / smooth, 2, axis=1)
    parameters = mi.traverse(loaded)
    parameters["integrator.gear:shift_y"] = mi.Float(3.0)
    parameters.update()
    after = np.split(render(loaded, 256) / smooth, 2, axis=1)
    assert np.array_equal(before[0], after[0])
    assert np.corrcoef(after[1][3:].ravel(), before[1][:-3].ravel())[0, 1] > 0.999


def test_light_on_the_way_from_another_shape_has_the_pattern_of_the_one_that_is_seen() -> None:
    parts = hidden_plate()
    deep = {**DIRECT, "max_depth": 3}
    alike, hidden, seen = (
        picture({**deep, **own}, 1024, **parts)
        for own in ({}, {"plate:shift_x": 5.0}, {"wall:shift_x": 5.0})
    )
    assert np.array_equal(alike, hidden)
    assert not np.array_equal(alike, seen)


def test_a_mirror_shows_the_pattern_of_the_shape_in_it() -> None:
    sensor = camera()
    sensor["to_world"] = Transform().look_at([0.1, 0.0, 0.2], [0.0, 0.0, 0.2], [0.0, 1.0, 0.0])
    facing = Transform().look_at([0.0, 0.0, 0.2], [1.0, 0.0, -0.8], [0.0, 1.0, 0.0])
    mirror = {
        "type": "rectangle",
        "to_world": facing @ Transform().scale(0.02),
        "bsdf": {"type": "conductor"},
    }
    parts: Node = {"plate": PLATE, "mirror": mirror, "laser": LASER, "camera": sensor}
    deep = {**DIRECT, "max_depth": 3}
    alike, of_mirror, of_plate = (
        picture({**deep, **own}, 16, **parts)
        for own in ({}, {"mirror:shift_x": 5.0}, {"plate:shift_x": 5.0})
    )
    assert np.array_equal(alike, of_mirror)
    assert not np.array_equal(alike, of_plate)


@pytest.mark.parametrize("table", ["intensity", "amplitude"])
def test_the_motion_of_a_shape_compiles_no_kernel_anew(table: str) -> None:
    own = {"gear:pupil_shift": 0.0, "gear:shift_x": 0.0, "gear:polarisation": 0.0, "table": table}
    loaded = scene({**MOVING, **own}, **halves((WIDTH, HEIGHT)))
    parameters = mi.traverse(loaded)
    pictures = [render(loaded)]
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory):
        dr.kernel_history_clear()
        for step in (0.03, 0.1, -0.2):
            parameters["integrator.gear:pupil_shift"] = mi.Float(step)
            parameters["integrator.gear:shift_x"] = mi.Float(100.0 * step)
            parameters.update()
            pictures.append(render(loaded))
        kernels = dr.kernel_history([dr.KernelType.JIT])
    assert len(kernels) >= 3
    assert all(kernel["cache_hit"] for kernel in kernels)
    assert not np.array_equal(pictures[0], pictures[1])


def test_patterns_that_do_not_fit_the_memory_are_places_in_one() -> None:
    # Three stacks of half a MiB, and three tables of a quarter.
    sizes = {"pattern_size": 256, "pattern_diameter": 128, "memory": 1}
    ((pattern,),) = generate(settings(**sizes), [4.0], (256, 256), [mixture(3, 1.0)])
    assert len({id(part.stack) for part in pattern.parts}) == 1
    values = factors(pattern, (256, 256))
    # 3200 speckles: as in the test of contrasts.
    assert values.std() / values.mean() == pytest.approx(1.0 / np.sqrt(3.0), rel=3.3 * 0.018)


def test_too_many_look_ups_of_amplitudes_are_refused_with_the_memory_of_intensities() -> None:
    eight, nine = mixture(8, 0.0), replace(mixture(9, 0.0), prefix="gear:")

    def made(surfaces: list[Surface], **properties: Any) -> Any:
        return generate(settings(**properties), [SPECKLE_SIZE], (32, 24), surfaces)

    made([eight], table="amplitude")
    with pytest.raises(ParameterError) as caught:
        made([eight, nine], table="amplitude")
    assert caught.value.parameter == "gear:patterns"
    said = re.search(r"at most, got 18.*`memory` of (\d+)", str(caught.value))
    assert said
    memory = int(said[1])
    ((pattern, _),) = made([eight, nine], memory=memory)
    assert pattern.table == "intensity"
    with pytest.raises(ParameterError, match="gear:patterns"):
        made([eight, nine], memory=memory - 1)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("patterns", 0),
        ("patterns", 1025),
        ("patterns", 2.5),
        ("polarisation", 1.5),
        ("polarisation", float("nan")),
        ("gear:patterns", 0),
        ("gear:polarisation", -0.1),
        ("gear:pupil_shift", float("inf")),
        ("gear:shift_y", "far"),
        ("gear:sift_y", 1.0),
        ("gear:seed", 3),
    ],
)
def test_a_refused_property_of_a_shape_is_named(name: str, value: Any) -> None:
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture({**DIRECT, name: value}, 1, **halves())
    assert name in text_of(caught.value)


def test_shapes_that_were_merged_are_refused_with_the_way_out() -> None:
    twins = {**halves(), "gear": half(1.0)}
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture({**DIRECT, "gear:shift_x": 1.0}, 1, **twins)
    assert "optimize=False" in text_of(caught.value)
    nodes = {"type": "scene", "integrator": {**DIRECT, "gear:shift_x": 1.0}, **twins}
    assert render(mi.load_dict(nodes, optimize=False), 1).mean() > 0.0


def test_an_id_that_no_shape_has_is_refused_with_those_that_shapes_have() -> None:
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture({**DIRECT, "wheel:shift_x": 1.0}, 1, **halves())
    assert "wheel: no shape has this id; those that shapes have are base, gear" in text_of(
        caught.value
    )


def test_a_motion_of_a_shape_that_is_no_number_is_refused() -> None:
    loaded = scene({**DIRECT, "gear:pupil_shift": 0.0}, **halves())
    parameters = mi.traverse(loaded)
    parameters["integrator.gear:pupil_shift"] = mi.Float(float("nan"))
    with pytest.raises(Exception, match="gear:pupil_shift: must be a finite number"):
        parameters.update()
