"""The integrator ``speckle``: its look-up, and which light it multiplies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

mi.set_variant("llvm_ad_rgb")

import tem00.mitsuba  # noqa: E402
from tem00 import ParameterError, speckle  # noqa: E402
from tem00.mitsuba.amplitudes import amplitude_bytes  # noqa: E402
from tem00.mitsuba.look_up import Part  # noqa: E402
from tem00.mitsuba.patterns import Pattern, generate  # noqa: E402
from tem00.mitsuba.speckle import lasers_of, speckle_size  # noqa: E402
from tem00.mitsuba.speckle_settings import PatternSettings  # noqa: E402
from tem00.mitsuba.surfaces import Surface  # noqa: E402

if TYPE_CHECKING:
    from pathlib import Path


tem00.mitsuba.register()

Array = NDArray[np.float64]
Node = dict[str, Any]
Transform = mi.ScalarTransform4f

SPECKLE_SIZE = 4.5
WIDTH, HEIGHT = 32, 24
# The lens is 0.3 m before the plate and sees 12 mm of it, which the laser lights evenly: over a
# pixel of 0.4 mm the light changes by 0.6 % at most.
LASER: Node = {
    "type": "laser",
    "wavelength": 650e-9,
    "power": 5e-3,
    "waist_radius": 40e-3,
    "to_world": Transform().look_at([0.1, 0.0, 0.1732], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
}
PLATE: Node = {
    "type": "rectangle",
    "to_world": Transform().scale([0.02, 0.02, 1.0]),
    "bsdf": {"type": "diffuse", "reflectance": 0.8},
}
# What is looked up where no shape has properties of its own.
ALIKE = [Surface("", (1.0,), 0)]
DIRECT: Node = {"type": "speckle", "max_depth": 2, "speckle_size": SPECKLE_SIZE}


def camera(width: int = WIDTH, height: int = HEIGHT, **film: Any) -> Node:
    """Return a thin lens above the plate."""
    return {
        "type": "thinlens",
        "fov": float(np.degrees(2.0 * np.arctan(6e-3 / 0.3))),
        "aperture_radius": 1e-3,
        "focus_distance": 0.3,
        "to_world": Transform().look_at([0.0, 0.0, 0.3], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "filter": {"type": "box"},
            **film,
        },
        "sampler": {"type": "independent"},
    }


def scene(integrator: Node, **parts: Node) -> Any:
    """Return a scene with the camera; by default a plate under a laser."""
    parts = parts or {"plate": PLATE, "laser": LASER}
    sensor = parts.pop("camera", camera())
    return mi.load_dict({"type": "scene", "integrator": integrator, "camera": sensor, **parts})


def picture(integrator: Node, spp: int = 16, seed: int = 0, **parts: Node) -> Array:
    """Return the red channel of a picture."""
    return render(scene(integrator, **parts), spp, seed)


def render(loaded: Any, spp: int = 16, seed: int = 0) -> Array:
    """Return the red channel of a loaded scene."""
    return np.array(mi.render(loaded, spp=spp, seed=seed), dtype=np.float64)[..., 0]


def plain(**changes: Any) -> Node:
    """Return the integrator of direct light, without speckle."""
    return {"type": "speckle", "max_depth": 2, "speckle": False, **changes}


def settings(**properties: Any) -> PatternSettings:
    """Return the settings that properties describe."""
    props = mi.Properties("speckle")
    for name, value in properties.items():
        props[name] = value
    return PatternSettings.read(props)


def stack_of(number: int = 0, seed: int = 0, image: tuple[int, int] = (WIDTH, HEIGHT)) -> Any:
    """Return the stack of a laser as the documentation describes it."""
    plan = speckle.StackPlan(
        image=image,
        region=image,
        speckle_size=SPECKLE_SIZE,
        motion=None,
        frames=1,
        memory_limit=1 << 30,
    )
    field = plan.field(speckle.derived_seed(seed, "laser", number))
    return speckle.SpeckleStack.generate(field, speckle.SlicePath.still())


def pixel_means(stack: Any, width: int = WIDTH, height: int = HEIGHT) -> Array:
    """Return the mean of the intensity over each pixel, by Gauss's rule of the library."""
    scale = stack.speckle_size / SPECKLE_SIZE
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    means: Array = stack.average_over(scale * x, -scale * y, (scale, scale), 0.0)
    return means


@pytest.mark.parametrize("table", ["intensity", "amplitude"])
@pytest.mark.parametrize(
    ("properties", "pupil"),
    [
        ({}, 0.0),
        ({"path": "straight"}, 0.05),
        ({"path": "straight", "half_period": 16, "length": 4}, -0.06),
        ({"path": "straight", "half_period": 16, "length": 4}, 0.9),
        ({"path": "circle", "half_period": 3}, 0.5),
        ({"pattern_size": 256, "pattern_diameter": 64}, 0.0),
        ({"pattern_diameter": 90, "seed": 7}, 0.0),
    ],
)
def test_the_look_up_is_that_of_the_stack(
    properties: dict[str, Any], pupil: float, table: str
) -> None:
    ((pattern,),) = generate(settings(**properties, table=table), [SPECKLE_SIZE], (320, 240), ALIKE)
    error, expected = errors_of(pattern, pupil)
    # The spline with 8 nodes per fringe: 1.2e-4 rms, 9e-4 at worst of so many points, by the same
    # comparison in NumPy alone. 16-bit coefficients: 1e-4. Coordinates in single precision: 4 *
    # 1200 / 2 * 2**-24 of a node and slopes of 2 pi / 8 of an intensity of 4 per node: 4e-4.
    rms, worst = (2e-4, 1.5e-3)
    if table == "amplitude":
        # Rounding to 1 / 32767 of 5, weighted: 3e-5, and 2 sqrt(12) * 4e-5 at worst; the
        # coordinates are finer by the nodes per sample.
        rms, worst = (6e-5, 6e-4)
    assert np.sqrt(np.mean(error**2)) < rms
    assert np.abs(error).max() < worst
    assert np.std(expected) > 0.8


def errors_of(pattern: Pattern, pupil: float) -> tuple[Array, Array]:
    """Return the errors of a look-up, and the intensities of the stack.

    Both are in the image and up to three periods beyond.
    """
    x, y = np.random.default_rng(1).uniform(-900.0, 1200.0, (2, 20_000)).astype(np.float32)
    shift = (0.3, -0.7)
    pattern.move_to(pupil, shift)
    scale = pattern.stack.speckle_size / SPECKLE_SIZE
    got = np.array(pattern.factor(mi.Point2f(x, y)), dtype=np.float64)
    at = scale * (x.astype(np.float64) - shift[0]), -scale * (y.astype(np.float64) - shift[1])
    expected = pattern.stack.intensity_at(*at, pattern.stack.coordinate_at(pupil))
    return got - expected, expected


def test_amplitudes_behind_an_asymmetric_pupil_have_its_law() -> None:
    ramp = np.linspace(0.0, 1.0, 32) ** 2
    pupil = speckle.Pupil.sampled(np.outer(ramp, ramp))
    field = speckle.PupilField(128, 64, 5).with_pupil(pupil)
    stack = speckle.SpeckleStack.generate(field, speckle.SlicePath.circle(half_period=3))
    error, _ = errors_of(Pattern([Part(1.0, stack, (0.0, 0.0))], SPECKLE_SIZE, "amplitude"), 0.2)
    assert np.sqrt(np.mean(error**2)) < 6e-5


def test_five_megapixels_fit_the_memory_as_amplitudes() -> None:
    ((pattern,),) = generate(settings(), [1.9], (2592, 1944), ALIKE)
    assert pattern.table == "amplitude"
    assert amplitude_bytes(pattern.stack) < 24 * 2**20
    pattern.move_to(0.0, (0.0, 0.0))
    x, y = np.random.default_rng(2).uniform(0.0, 1.0, (2, 20_000)).astype(np.float32)
    x, y = 2592 * x, 1944 * y
    scale = pattern.stack.speckle_size / 1.9
    expected = pattern.stack.intensity_at(scale * x.astype(float), -scale * y.astype(float), 0.0)
    error = np.array(pattern.factor(mi.Point2f(x, y)), dtype=np.float64) - expected
    # Samples up to 2880 have 1e-4 of one, and intensities of 4 rise by 2 pi / 2 of themselves per
    # sample.
    assert np.sqrt(np.mean(error**2)) < 2e-4
    assert np.abs(error).max() < 1.5e-3


@pytest.mark.parametrize(
    "motion", [{}, {"path": "straight", "half_period": 8, "pupil_shift": 0.16}]
)
def test_pictures_of_amplitudes_are_those_of_intensities(motion: dict[str, Any]) -> None:
    of_amplitudes, of_intensities = (
        picture({**DIRECT, **motion, "table": table}) for table in ("amplitude", "intensity")
    )
    # The same samples: the worst of both errors, beside a mean of 1.
    assert np.abs(of_amplitudes - of_intensities).max() < 2.1e-3 * of_intensities.mean()


@pytest.mark.parametrize("table", ["intensity", "amplitude"])
def test_motion_compiles_no_kernel_anew(table: str) -> None:
    loaded = scene({**DIRECT, "path": "straight", "half_period": 8, "table": table})
    parameters = mi.traverse(loaded)
    render(loaded)
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory):
        dr.kernel_history_clear()
        for step in (0.1, 0.3, -0.7):
            parameters["integrator.pupil_shift"] = mi.Float(step)
            parameters["integrator.shift_x"] = mi.Float(20.0 * step)
            parameters.update()
            render(loaded)
        kernels = dr.kernel_history([dr.KernelType.JIT])
    assert len(kernels) >= 3
    assert all(kernel["cache_hit"] for kernel in kernels)


def test_pixels_show_the_mean_of_the_pattern_over_their_areas() -> None:
    spp, rounds = 64, 8
    speckled, smooth = scene(DIRECT), scene(plain())
    # The same samples with and without speckle: only the factor is left of the noise.
    ratios = np.array([render(speckled, spp, s) / render(smooth, spp, s) for s in range(rounds)])
    means = pixel_means(stack_of())

    z = (ratios.mean(axis=0) - means) / (ratios.std(axis=0, ddof=1) / np.sqrt(rounds))

    # What the light changes over a pixel and the spline errs by is below the noise, 0.5 %.
    # Student's t with 7 degrees of freedom: z**2 has the mean 7/5 and the variance 2 * 49 * 6 /
    # (25 * 3).
    spread = np.sqrt(2.0 * 49.0 * 6.0 / (25.0 * 3.0) / z.size)
    assert np.mean(z**2) < 1.4 + stats.norm.isf(1e-3) * spread
    assert np.corrcoef(ratios.mean(axis=0).ravel(), means.ravel())[0, 1] > 0.999


def test_a_crop_shows_the_same_pattern_at_the_same_pixels() -> None:
    window = {"crop_offset_x": 7, "crop_offset_y": 5, "crop_width": 12, "crop_height": 9}
    parts: Node = {"plate": PLATE, "laser": LASER, "camera": camera(**window)}
    ratio = picture(DIRECT, 256, **parts) / picture(plain(), 256, **parts)
    expected = pixel_means(stack_of())[5:14, 7:19]
    # 256 samples of a factor that varies by at most its mean over a pixel of 1/4.5 speckle.
    assert np.abs(ratio - expected).max() < 5.0 * expected.max() * 0.3 / 16.0
    assert np.corrcoef(ratio.ravel(), expected.ravel())[0, 1] > 0.999


def test_a_shift_moves_the_pattern_right_and_down() -> None:
    loaded, smooth = scene(DIRECT), scene(plain())
    before = render(loaded, 256) / render(smooth, 256)
    parameters = mi.traverse(loaded)
    parameters["integrator.shift_x"] = mi.Float(3.0)
    parameters["integrator.shift_y"] = mi.Float(2.0)
    parameters.update()
    after = render(loaded, 256) / render(smooth, 256)
    # Other samples see the same speckle: the noise of 256 of them.
    assert np.corrcoef(after[2:, 3:].ravel(), before[:-2, :-3].ravel())[0, 1] > 0.999
    assert np.corrcoef(after.ravel(), before.ravel())[0, 1] < 0.9


def test_poses_move_and_change_the_pattern_by_the_law_of_motion() -> None:
    width, height, pixel = 128, 96, 12e-3 / 128
    # The same lens for both, whose speckle is 4.5 pixels wide.
    radius = 0.5 * 650e-9 * 0.3 / (SPECKLE_SIZE * pixel)
    lens = {**camera(width, height), "aperture_radius": radius}
    wide: Node = {"plate": PLATE, "laser": LASER, "camera": lens}
    thick = tem00.Camera(
        focal_length=25e-3,
        f_number=25e-3 / (2.0 * radius),
        pixel_pitch=pixel * 25e-3 / (0.3 - 25e-3),
        resolution=(width, height),
    )
    laser = tem00.Laser.spot(
        650e-9, 40e-3, origin=[0.1, 0.0, 0.1732], target=[0.0, 0.0, 0.0], focused_at=0.0
    )
    # By a pixel to the right, and to the left.
    there = tem00.Pose.along([pixel, 0.0, 0.0])
    poses = [there, there.inverse()]
    moving = tem00.Speckle(thick, laser, 1, poses=poses, memory=16 << 20)
    loaded = scene(
        {"type": "speckle", "max_depth": 2, "path": "straight", "half_period": 32}, **wide
    )
    smooth = picture(plain(), 64, **wide)
    still = render(loaded, 64) / smooth
    moved = []
    for pose in poses:
        loaded.integrator().move(moving.frame(pose), pose.point([0.0, 0.0, 0.0]), [0.0, 0.0, 1.0])
        moved.append(render(loaded, 64) / smooth)
    right, left = moved
    pupil = pixel / (2.0 * radius)
    for was, now, shift in (
        (still[:, :-1], right[:, 1:], pupil),
        (still[:, 1:], left[:, :-1], pupil),
        # To two sides of the reference.
        (right[:, 2:], left[:, :-2], 2.0 * pupil),
    ):
        measured = np.corrcoef(was.ravel(), now.ravel())[0, 1]
        law = tem00.decorrelation.pupil_overlap_correlation(shift)
        # Of 600 speckles the correlation coefficient has the standard error (1 - r) / sqrt(600)
        # times 1.5 for exponential intensities: 0.03 with r = 0.5.
        assert measured == pytest.approx(law, abs=3.3 * 0.03)


def corner(**lights: Node) -> Node:
    """Return a plate and a wall beside it that only light from the plate reaches."""
    wall = {
        "type": "rectangle",
        "to_world": Transform().look_at([-5e-3, 0.0, 0.0], [1.0, 0.0, 0.3], [0.0, 1.0, 0.0])
        @ Transform().scale([0.02, 0.004, 1.0]),
        "bsdf": {"type": "diffuse"},
    }
    return {"plate": PLATE, "wall": wall, **lights}


def test_light_that_met_two_rough_surfaces_has_the_speckle_of_the_last() -> None:
    # The camera sees by scattered light only: what the laser lights faces away.
    parts = hidden_plate()
    smooth = picture({**plain(), "max_depth": 3}, 8192, **parts)
    speckled = picture({**DIRECT, "max_depth": 3}, 8192, **parts)
    # The plate itself is seen from its dark side.
    lit = smooth > 0.0
    assert lit.mean() > 0.5
    ratio = speckled[lit] / smooth[lit]
    assert np.corrcoef(ratio, pixel_means(stack_of())[lit])[0, 1] > 0.99


def hidden_plate() -> Node:
    """Return a lit plate that faces away from the camera, and a wall that it lights."""
    above = Transform().translate([0.0, 0.0, 0.02])
    facing_away = above @ Transform().rotate([0.0, 1.0, 0.0], 180.0)
    plate = {
        "type": "rectangle",
        "to_world": facing_away @ Transform().scale([0.003, 0.003, 1.0]),
        "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse"}},
    }
    from_below = Transform().look_at([0.03, 0.0, 1e-3], [0.0, 0.0, 0.02], [0.0, 1.0, 0.0])
    laser = {**LASER, "waist_radius": 5e-4, "to_world": from_below}
    return {"plate": plate, "wall": PLATE, "laser": laser}


def test_a_mirror_on_the_way_leaves_the_speckle() -> None:
    # The camera looks at a mirror at 45 degrees, which shows the plate upright.
    sensor = camera()
    sensor["to_world"] = Transform().look_at([0.1, 0.0, 0.2], [0.0, 0.0, 0.2], [0.0, 1.0, 0.0])
    mirror = {
        "type": "rectangle",
        "to_world": Transform().look_at([0.0, 0.0, 0.2], [1.0, 0.0, -0.8], [0.0, 1.0, 0.0])
        @ Transform().scale(0.02),
        "bsdf": {"type": "conductor"},
    }
    parts: Node = {"plate": PLATE, "mirror": mirror, "laser": LASER, "camera": sensor}
    ratio = picture({**DIRECT, "max_depth": 3}, 256, **parts) / picture(
        plain(max_depth=3), 256, **parts
    )
    assert np.corrcoef(ratio.ravel(), pixel_means(stack_of()).ravel())[0, 1] > 0.999


def test_other_lights_have_no_speckle() -> None:
    lights: Node = {
        "point": {"type": "point", "position": [0.05, 0.0, 0.2]},
        "sky": {"type": "constant", "radiance": 0.2},
    }
    # A laser that shines away from everything makes patterns, too.
    away = Transform().look_at([0.0, 0.1, 0.5], [0.0, 0.1, 1.0], [0.0, 1.0, 0.0])
    parts = corner(laser={**LASER, "to_world": away}, **lights)
    for depth in (2, -1):
        smooth = picture({**plain(), "max_depth": depth}, **parts)
        assert smooth.min() > 0.0
        assert np.array_equal(smooth, picture({**DIRECT, "max_depth": depth}, **parts))


# Their names sort in another order.
NAMES = ("violet", "amber", "green")


@pytest.mark.parametrize("number", range(len(NAMES)))
def test_lasers_have_the_seeds_of_their_places_in_a_scene(number: int) -> None:
    # Nothing to see of the others but the choice between them.
    lasers: Node = {name: {**LASER, "power": 1e-12} for name in NAMES}
    lasers[NAMES[number]] = LASER
    speckled, smooth = (picture(node, 1024, plate=PLATE, **lasers) for node in (DIRECT, plain()))
    ratio = (speckled / smooth).ravel()
    correlations = [
        np.corrcoef(ratio, pixel_means(stack_of(other)).ravel())[0, 1]
        for other in range(len(NAMES))
    ]
    assert correlations.pop(number) > 0.999
    assert max(correlations) < 0.5


def test_the_lasers_of_an_xml_scene_stand_in_its_order() -> None:
    numbers = "".join(
        f'<float name="{name}" value="{LASER[name]}"/>'
        for name in ("wavelength", "power", "waist_radius")
    )
    lasers = [f'<emitter type="laser" id="{name}">{numbers}</emitter>' for name in NAMES]
    light = '<shape type="sphere"><emitter type="area"/></shape>'
    loaded = mi.load_string(f'<scene version="3.0.0">{light.join(lasers)}</scene>')
    assert tuple(laser.id() for laser in lasers_of(loaded)) == NAMES


def lit_box() -> Node:
    """Return rough, smooth and transparent things under lights of all kinds."""
    overhead = Transform().look_at([0.0, 0.1, 0.2], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    return corner(
        laser=LASER,
        cube={
            "type": "cube",
            "to_world": Transform().translate([3e-3, 0.0, 0.0]) @ Transform().scale(2e-3),
            "bsdf": {"type": "roughconductor", "alpha": 0.3},
        },
        glass={
            "type": "sphere",
            "radius": 2e-3,
            "center": [0.0, 1e-3, 6e-3],
            "bsdf": {"type": "dielectric"},
        },
        light={
            "type": "rectangle",
            "to_world": overhead @ Transform().scale(0.05),
            "emitter": {"type": "area", "radiance": 500.0},
        },
        bulb={
            "type": "sphere",
            "radius": 5e-4,
            "center": [-1e-3, -2e-3, 5e-3],
            "emitter": {"type": "area", "radiance": 100.0},
        },
        sky={"type": "constant", "radiance": 20.0},
    )


@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize("depth", [2, 3, -1])
def test_without_speckle_it_is_the_path_tracer_of_mitsuba(depth: int, hidden: bool) -> None:
    rounds, parts = 6, lit_box()
    rules = {"max_depth": depth, "rr_depth": 2, "hide_emitters": hidden}
    loaded = [
        scene({"type": kind, **rules, **extra}, **dict(parts))
        for kind, extra in (("speckle", {"speckle": False}), ("path", {}))
    ]
    ours, theirs = (
        np.array([render(one, 64, 100 * k + s).mean() for s in range(rounds)])
        for k, one in enumerate(loaded)
    )
    # Welch's test of two means.
    assert stats.ttest_ind(ours, theirs, equal_var=False).pvalue > 1e-3
    assert np.std(ours) / np.mean(ours) < 0.02


def test_direct_light_of_a_laser_is_that_of_the_direct_integrator() -> None:
    direct = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    # The same random numbers in the same order.
    assert np.array_equal(picture(plain()), picture(direct))


def test_gaussian_filters_and_several_passes_see_the_same_light() -> None:
    parts: Node = {"plate": PLATE, "laser": LASER, "camera": camera(filter={"type": "gaussian"})}
    smooth = picture(plain(), 64, **parts)
    theirs = picture({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}, 64, **parts)
    # Rounding of the places on the film.
    assert np.abs(smooth / theirs - 1.0).max() < 1e-4


def test_monochrome_pictures_are_the_red_channel() -> None:
    red = picture(DIRECT)
    try:
        mi.set_variant("llvm_ad_mono")
        grey = np.array(mi.render(scene_anew(), spp=16, seed=0), dtype=np.float64)[..., 0]
    finally:
        mi.set_variant("llvm_ad_rgb")
    # Products in another order.
    assert np.abs(grey / red - 1.0).max() < 1e-5


def scene_anew() -> Any:
    """Return the scene in the current variant, whose transforms are its own."""
    text = f"""<scene version="3.0.0">
      <integrator type="speckle"><integer name="max_depth" value="2"/>
        <float name="speckle_size" value="{SPECKLE_SIZE}"/></integrator>
      <sensor type="thinlens"><float name="fov" value="{camera()["fov"]}"/>
        <float name="aperture_radius" value="0.001"/><float name="focus_distance" value="0.3"/>
        <transform name="to_world"><lookat origin="0,0,0.3" target="0,0,0" up="0,1,0"/></transform>
        <film type="hdrfilm"><integer name="width" value="{WIDTH}"/>
          <integer name="height" value="{HEIGHT}"/><rfilter type="box"/></film></sensor>
      <emitter type="laser"><float name="wavelength" value="650e-9"/>
        <float name="power" value="5e-3"/><float name="waist_radius" value="40e-3"/>
        <transform name="to_world"><lookat origin="0.1,0,0.1732" target="0,0,0" up="0,1,0"/>
        </transform></emitter>
      <shape type="rectangle"><transform name="to_world"><scale x="0.02" y="0.02"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf></shape></scene>"""
    return mi.load_string(text)


def test_a_thin_lens_determines_the_speckle_size() -> None:
    f_number, focal_length, distance, pitch = 8.0, 25e-3, 0.3, 3.45e-6
    image_distance = focal_length * distance / (distance - focal_length)
    sensor = camera()
    sensor["fov"] = float(np.degrees(2.0 * np.arctan(0.5 * WIDTH * pitch / image_distance)))
    sensor["aperture_radius"] = 0.5 * focal_length / f_number
    loaded = scene(DIRECT, plate=PLATE, laser=LASER, camera=sensor)

    size = speckle_size(loaded.emitters()[0], loaded.sensors()[0])

    # The field of view is kept in single precision.
    expected = 650e-9 * image_distance / (focal_length / f_number) / pitch
    assert size == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("max_depth", -2),
        ("rr_depth", 0),
        ("speckle_size", 0.0),
        ("speckle_size", float("nan")),
        ("speckle_size", 1e-4),
        ("seed", -1),
        ("seed", 1.5),
        ("pattern_size", 7),
        ("pattern_diameter", 2**20),
        ("pattern_diameter", 2**14 + 1),
        ("path", "spiral"),
        ("half_period", 0),
        ("length", 0),
        ("pupil_shift", float("inf")),
        ("shift_x", float("nan")),
        ("shift_y", "far"),
        ("speckle", 1),
        ("hide_emitters", "no"),
        ("speckle_sise", 4.5),
        ("memory", 0),
        ("memory", 0.5),
        ("table", "amplitudes"),
        ("table", 3),
    ],
)
def test_a_refused_property_is_named(name: str, value: Any) -> None:
    with pytest.raises((RuntimeError, ParameterError)) as caught:
        picture({**DIRECT, name: value}, 1)
    assert name in text_of(caught.value)


def text_of(error: BaseException | None) -> str:
    """Return the messages of an exception and of those that caused it: Mitsuba wraps them."""
    return f"{error}\n{text_of(error.__cause__ or error.__context__)}" if error else ""


def test_a_pattern_too_small_for_its_pupil_is_refused() -> None:
    with pytest.raises(ParameterError) as caught:
        generate(settings(pattern_size=64, pattern_diameter=50), [SPECKLE_SIZE], (32, 24), ALIKE)
    assert caught.value.parameter == "pattern_diameter"


@pytest.mark.parametrize(
    ("name", "properties"),
    [
        ("half_period", {"path": "circle", "half_period": 4096, "pattern_size": 1024}),
        ("pattern_size", {"pattern_size": 32768}),
    ],
)
def test_what_takes_too_much_memory_is_named(name: str, properties: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match="bytes|GiB") as caught:
        generate(settings(**properties), [SPECKLE_SIZE], (32, 24), ALIKE)
    assert caught.value.parameter == name


def test_the_table_takes_no_more_than_it_may() -> None:
    # 128**2 speckles of 64 nodes with 28 bytes are 28 MiB, of 4 samples with 4 bytes 1/4 MiB.
    sizes = {"pattern_size": 256, "pattern_diameter": 128}
    for memory, table in ((29, "intensity"), (27, "amplitude")):
        ((pattern,),) = generate(settings(**sizes, memory=memory), [4.0], (256, 256), ALIKE)
        assert pattern.table == table
    asked = settings(**sizes, memory=27, table="intensity")
    with pytest.raises(ParameterError, match="28 MiB, and `memory` allows 27 MiB") as caught:
        generate(asked, [4.0], (256, 256), ALIKE)
    assert caught.value.parameter == "speckle_size"


@pytest.mark.parametrize("outer", ["aov", "moment"])
def test_it_is_refused_inside_another_integrator_by_name(outer: str) -> None:
    around: Node = {"type": outer, "inner": DIRECT}
    if outer == "aov":
        around["aovs"] = "dd.y:depth"
    with pytest.raises(RuntimeError) as caught:
        picture(around, 1)
    assert "speckle: cannot stand inside another integrator" in text_of(caught.value)


def test_a_pinhole_needs_the_speckle_size() -> None:
    sensor = {**camera(), "type": "perspective"}
    del sensor["aperture_radius"], sensor["focus_distance"]
    without = {"type": "speckle", "max_depth": 2}
    pinhole = scene(without, plate=PLATE, laser=LASER, camera=sensor)
    with pytest.raises(ParameterError, match="thinlens") as caught:
        pinhole.integrator().render(pinhole)
    assert caught.value.parameter == "speckle_size"
    with_it = picture(DIRECT, 1, plate=PLATE, laser=LASER, camera=sensor)
    assert with_it.mean() > 0.0


def test_a_parameter_that_is_no_number_is_refused() -> None:
    loaded = scene(DIRECT)
    parameters = mi.traverse(loaded)
    parameters["integrator.pupil_shift"] = mi.Float(float("nan"))
    with pytest.raises(Exception, match="pupil_shift: must be a finite number"):
        parameters.update()


def test_nothing_is_drawn_twice_in_several_passes() -> None:
    # The largest wavefront is lowered, so that the picture needs four passes.
    from tem00.mitsuba import film

    whole = picture(DIRECT, 64)
    limit = film._LARGEST_WAVEFRONT
    try:
        film._LARGEST_WAVEFRONT = 16 * WIDTH * HEIGHT
        in_parts = picture(DIRECT, 64, seed=1)
    finally:
        film._LARGEST_WAVEFRONT = limit
    again = picture(DIRECT, 64, seed=2)
    # As far apart as two pictures in one pass are: the ratio of two sums of squares of 768 pixels.
    ratio = np.sum((in_parts - whole) ** 2) / np.sum((again - whole) ** 2)
    assert 0.7 < ratio < 1.4
