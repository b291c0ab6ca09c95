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
    point: Image = np.array(mi.render(scenes.scene(integrator, **parts))).astype(float)
    per_metre = WIDTH / 2 / (scenes.DISTANCE * np.tan(np.radians(scenes.FOV / 2)))
    return WIDTH / 2 + per_metre * point[:, :, 0], HEIGHT / 2 - per_metre * point[:, :, 1]


def stack(seed: int, speckle_size: float = 4.0) -> patterns.SpeckleStack:
    """Return the pattern that the library plans for the picture."""
    size = (float(WIDTH), float(HEIGHT))
    needs = patterns.StackNeeds(
        image=size, region=size, speckle_size=speckle_size, motion=None, frames=1,
        memory_limit=1 << 30,
    )
    return patterns.StackPlan(needs).stack(seed, patterns.StackOptions())


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


def look_up(pattern: patterns.SpeckleStack, u: float = 0.0, shift: tuple[float, float] = (0, 0),
            **parts: Any) -> Image:
    """Return the factors that the samples of a picture must have."""
    x, y = film_positions(**parts)
    scale = pattern.speckle_size / 4.0
    return pattern.intensity_at(scale * (x - shift[0]), -scale * (y - shift[1]), u)


# Film positions are known to 1e-5 pixels, in which the intensity, at most 12, changes by
# 2π / 4 · 1e-5 · 12 = 2e-4; the quotient of two pictures adds 12 · 2e-7.
TOLERANCE = 3e-4


def test_a_cropped_picture_shows_its_part_of_the_pattern() -> None:
    crop = {"crop_offset_x": 9, "crop_offset_y": 5, "crop_width": 20, "crop_height": 12}
    sensor = scenes.camera(film=crop)
    expected = look_up(stack(SEED_STEP), sensor=sensor)
    np.testing.assert_allclose(factor(sensor=sensor), expected, atol=TOLERANCE)


def test_the_pattern_moves_right_and_down_by_the_shift() -> None:
    integrator = speckle(shift_x=3.25, shift_y=-1.5)
    expected = look_up(stack(SEED_STEP), shift=(3.25, -1.5))
    np.testing.assert_allclose(factor(integrator=integrator), expected, atol=TOLERANCE)


def test_the_pattern_can_be_moved_after_the_scene_was_loaded() -> None:
    moved = scenes.scene(speckle(path="circle", half_period=4))
    parameters = mi.traverse(moved.integrator())
    parameters["u"], parameters["shift_x"] = 1.375, 3.25
    parameters.update()
    integrator = speckle(path="circle", half_period=4, u=1.375, shift_x=3.25)
    loaded = scenes.scene(integrator)
    np.testing.assert_array_equal(np.array(mi.render(moved)), np.array(mi.render(loaded)))
    parameters["shift_y"] = float("nan")
    with pytest.raises(RuntimeError, match="speckle: shift_y: "):
        parameters.update()


@pytest.mark.parametrize(
    ("path", "words"),
    [
        (patterns.SlicePath.circle(half_period=4), {"path": "circle", "half_period": 4}),
        (
            patterns.SlicePath.straight(half_period=6, length=3),
            {"path": "straight", "half_period": 6, "length": 3},
        ),
    ],
)
def test_between_two_slices_the_pattern_is_that_of_the_stack(
    path: patterns.SlicePath, words: Scene
) -> None:
    pattern = patterns.SpeckleStack.generate(stack(SEED_STEP).field, path)
    expected = look_up(pattern, u=1.375)
    np.testing.assert_allclose(factor(integrator=speckle(u=1.375, **words)), expected,
                               atol=TOLERANCE)


@pytest.mark.parametrize(
    ("words", "sizes"),
    [
        ({"pattern_size": 128, "pattern_diameter": 24}, (128, 24)),
        ({"pattern_size": 96}, (96, 48)),
        ({"pattern_diameter": 20}, (40, 20)),
        # 50 / (50 / 22) is less than 22 in floating point, and the rim holds lattice points.
        ({"pattern_size": 50, "pattern_diameter": 22}, (50, 22)),
    ],
)
def test_a_pattern_of_a_given_size_is_square(words: Scene, sizes: tuple[int, int]) -> None:
    field = patterns.PupilField(*sizes, seed=SEED_STEP)
    pattern = patterns.SpeckleStack.generate(field, patterns.SlicePath.still())
    expected = look_up(pattern)
    np.testing.assert_allclose(factor(integrator=speckle(**words)), expected, atol=TOLERANCE)


def test_a_stack_from_a_file_is_that_of_the_first_laser(tmp_path: Path) -> None:
    field = patterns.PupilField(96, 40, seed=11)
    pattern = patterns.SpeckleStack.generate(field, patterns.SlicePath.circle(half_period=3))
    file = tmp_path / "pattern.stack"
    pattern.write_to(file)
    expected = look_up(pattern, u=0.5)
    np.testing.assert_allclose(factor(integrator=speckle(file=str(file), u=0.5)), expected,
                               atol=TOLERANCE)


def test_each_laser_has_a_pattern_of_its_own() -> None:
    second = scenes.spot(to_world=scenes.looking([-0.1, 0, 0.1732], [0, 0, 0], [0, 1, 0]))
    ratio = factor(second=second)
    # A sample takes the light of one of the lasers, whichever it draws.
    errors = [np.abs(ratio - look_up(stack((k * SEED_STEP) % 2**64))) for k in (1, 2)]
    assert np.all(np.minimum(*errors) < TOLERANCE)
    # Both are drawn as often: six standard deviations of the binomial distribution.
    first = np.count_nonzero(errors[0] < TOLERANCE)
    assert abs(first - WIDTH * HEIGHT / 2) < 3 * np.sqrt(WIDTH * HEIGHT) + 5


def test_lasers_that_share_a_file_look_it_up_far_apart(tmp_path: Path) -> None:
    field = patterns.PupilField(96, 40, seed=11)
    pattern = patterns.SpeckleStack.generate(field, patterns.SlicePath.still())
    pattern.write_to(tmp_path / "pattern.stack")
    second = scenes.spot(to_world=scenes.looking([-0.1, 0, 0.1732], [0, 0, 0], [0, 1, 0]))
    ratio = factor(integrator=speckle(file=str(tmp_path / "pattern.stack")), second=second)
    x, y = film_positions()
    scale = pattern.speckle_size / 4.0
    plastic = 1.324717957244746
    origins = [(0.0, 0.0), (96 * (1 / plastic % 1), 96 * (1 / plastic**2 % 1))]
    errors = [
        np.abs(ratio - pattern.intensity_at(x0 + scale * x, y0 - scale * y, 0.0))
        for x0, y0 in origins
    ]
    assert np.all(np.minimum(*errors) < TOLERANCE)
    assert np.count_nonzero(errors[1] < TOLERANCE) > WIDTH * HEIGHT / 3


def test_the_pattern_is_seen_in_a_mirror() -> None:
    # The camera looks down on a mirror that turns its sight to a plate on the right.
    turned = mi.ScalarTransform4f().translate([0, 0, 0.1]).rotate([0, 1, 0], 45).scale(0.05)
    parts = {
        "mirror": {"type": "rectangle", "to_world": turned, "bsdf": {"type": "conductor"}},
        "plate": scenes.plate() | {
            "to_world": mi.ScalarTransform4f().translate([0.1, 0, 0.1]).rotate([0, 1, 0], -90)
            .scale(0.05)
        },
        "laser": scenes.spot(to_world=scenes.looking([0.02, 0.07, 0.16], [0.1, 0, 0.1], [0, 0, 1])),
    }
    integrator = speckle(max_depth=3)
    ratio = factor(integrator=integrator, **parts)
    np.testing.assert_allclose(ratio, look_up(stack(SEED_STEP)), atol=TOLERANCE)


def test_light_from_a_second_rough_surface_has_no_speckle() -> None:
    # The laser lights a wall beside the plate, which the camera does not see.
    parts: dict[str, Any] = {
        "laser": scenes.spot(
            to_world=scenes.looking([0, 0, 0.05], [0.08, 0, 0.05], [0, 1, 0])
        ),
        "wall": scenes.plate() | {
            "to_world": mi.ScalarTransform4f().translate([0.08, 0, 0.05]).rotate([0, 1, 0], -90)
            .scale(0.1)
        },
        "sensor": scenes.camera(samples=64),
    }
    with_it = scenes.render(speckle(max_depth=3), **parts)
    without = scenes.render(speckle(max_depth=3, speckle=False), **parts)
    assert np.count_nonzero(with_it) > 100
    np.testing.assert_array_equal(with_it, without)


def test_incoherent_light_has_no_speckle() -> None:
    lamp = {"type": "point", "position": [0, 0.05, 0.2], "intensity": 1.0}
    with_it = scenes.render(speckle(), laser=lamp)
    without = scenes.render({"type": "path", "max_depth": DIRECT}, laser=lamp)
    np.testing.assert_allclose(with_it, without, rtol=1e-6)


def test_the_size_of_the_speckle_is_that_of_the_lens() -> None:
    radius = 0.5e-3
    distance = WIDTH / 2 / np.tan(np.radians(scenes.FOV / 2))
    size = scenes.WAVELENGTH * distance / (2 * radius)
    sensor = scenes.camera("thinlens", aperture_radius=radius, focus_distance=scenes.DISTANCE)
    given = scenes.render(speckle(speckle_size=size), sensor=sensor)
    integrator = speckle()
    del integrator["speckle_size"]
    # The camera keeps its numbers in single precision: 1e-7 of 48 pixels are 5e-6, as above.
    np.testing.assert_allclose(scenes.render(integrator, sensor=sensor), given, rtol=0,
                               atol=TOLERANCE * given.max())


def test_the_same_seed_gives_the_same_picture() -> None:
    integrator = speckle(max_depth=5)
    first = scenes.render(integrator, seed=3, sensor=scenes.camera(samples=4))
    again = scenes.render(integrator, seed=3, sensor=scenes.camera(samples=4))
    np.testing.assert_array_equal(first, again)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("speckle_size", 0.0),
        ("speckle_size", float("nan")),
        ("seed", -1),
        ("pattern_size", 8),
        ("pattern_diameter", 7),
        ("path", "round"),
        ("half_period", 0),
        ("length", 1),
        ("u", float("inf")),
        ("shift_x", float("nan")),
        ("shift_y", 1e10),
        ("file", "no_such.stack"),
        ("max_depth", -2),
        ("rr_depth", 0),
        ("speckles", 1),
        ("speckle", "yes"),
    ],
)
def test_a_bad_property_is_refused_by_its_name(name: str, value: object) -> None:
    with pytest.raises(RuntimeError, match=rf"\b{name}\b"):
        mi.load_dict(speckle() | {name: value})


def test_a_pattern_finer_than_its_samples_is_refused() -> None:
    with pytest.raises(RuntimeError, match="pattern_diameter: must be at most half"):
        mi.load_dict(speckle(pattern_size=64, pattern_diameter=33))


def test_a_file_leaves_nothing_else_to_choose(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="seed: must not be given together with file"):
        mi.load_dict(speckle(file=str(tmp_path / "pattern.stack"), seed=1))


def test_a_file_that_holds_no_stack_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "pattern.stack"
    file.write_bytes(b"nothing of the kind")
    with pytest.raises(RuntimeError, match="speckle: file: "):
        scenes.render(speckle(file=str(file)))


def test_a_camera_without_a_lens_needs_the_speckle_size() -> None:
    integrator = speckle()
    del integrator["speckle_size"]
    with pytest.raises(RuntimeError, match="speckle_size: must be given"):
        scenes.render(integrator)


def test_speckle_finer_than_any_pattern_is_refused() -> None:
    with pytest.raises(RuntimeError, match="speckle: speckle_size: "):
        scenes.render(speckle(speckle_size=1e-6))


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("half_period", {"path": "circle", "half_period": 4096, "pattern_size": 1024}),
        ("pattern_size", {"pattern_size": 32768}),
    ],
)
def test_more_pattern_than_fits_the_memory_is_refused(name: str, given: dict[str, object]) -> None:
    with pytest.raises(RuntimeError, match=f"speckle: {name}: memory"):
        scenes.render(speckle() | given)


def test_inside_another_integrator_it_says_what_it_lacks() -> None:
    nested = {"type": "aov", "aovs": "z:depth", "image": speckle()}
    with pytest.raises(RuntimeError, match="must render the image itself"):
        scenes.render(nested)
