"""Pictures that Mitsuba renders by the light of the emitter ``laser``."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

mi.set_variant("llvm_ad_rgb")

import tem00.mitsuba  # noqa: E402

tem00.mitsuba.register()

Array = NDArray[np.float64]
Node = dict[str, Any]

POWER = 5e-3
DISTANCE = 0.2
SPOT: Node = {
    "type": "laser",
    "wavelength": 650e-9,
    "power": POWER,
    "waist_radius": 1.5e-3,
    "waist_radius_y": 2.5e-3,
}
LINE: Node = {
    "type": "laser",
    "shape": "line",
    "wavelength": 650e-9,
    "power": POWER,
    "fan_angle": 4.0,
    "thickness": 2e-3,
    "focus_distance": DISTANCE,
    "profile": "powell",
}
LASERS = {"spot": SPOT, "line": LINE}
# Half the side of the plane: 7 mm is the half-length of the line, 2.5 mm the radius of the spot.
HALF_SIDE = 12e-3

Transform = mi.ScalarTransform4f


def laser_at(laser: Node, tilt: float) -> Node:
    """Return the laser, shining on the origin at an angle to the normal z, tilted towards y."""
    angle = np.radians(tilt)
    origin = [0.0, DISTANCE * np.sin(angle), DISTANCE * np.cos(angle)]
    to_world = Transform().look_at(origin, [0.0, 0.0, 0.0], [0.0, np.cos(angle), -np.sin(angle)])
    return {**laser, "to_world": to_world}


def scene_of(integrator: Node, sensor: Node, reflectance: float, **lasers: Node) -> Any:
    """Return a white plane z = 0 that the sensor sees from above."""
    film = {
        "type": "hdrfilm",
        "width": 48,
        "height": 48,
        "pixel_format": "rgb",
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }
    side = 6.0 * HALF_SIDE
    plane = {
        "type": "rectangle",
        "to_world": Transform().scale(side),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": reflectance}},
    }
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": integrator,
            "sensor": {**sensor, "film": film},
            "plane": plane,
            **lasers,
        }
    )


def seen_from_above(stretch: float = 1.0) -> Node:
    """Return an orthographic sensor that sees HALF_SIDE to all sides, and more along y."""
    to_world = Transform().look_at([0, 0, 1], [0, 0, 0], [0, 1, 0])
    to_world = to_world @ Transform().scale([HALF_SIDE, stretch * HALF_SIDE, 1.0])
    return {"type": "orthographic", "to_world": to_world}


def perspective() -> Node:
    to_world = Transform().look_at([0.05, 0, 0.5], [0, 0, 0], [0, 1, 0])
    fov = float(2.0 * np.degrees(np.arctan(HALF_SIDE / 0.5)))
    return {"type": "perspective", "fov": fov, "to_world": to_world}


def pictures(scene: Any, count: int, spp: int) -> Array:
    """Render independent pictures, shape (count, rows, columns), of the first channel."""
    renders = [np.array(mi.render(scene, spp=spp, seed=mi.UInt32(seed))) for seed in range(count)]
    return np.stack(renders)[..., 0].astype(np.float64)


def t_value(differences: Array) -> Array:
    """Return Student's t of the mean along the first axis."""
    spread = differences.std(axis=0, ddof=1) / np.sqrt(len(differences))
    t: Array = differences.mean(axis=0) / spread
    return t


@pytest.mark.parametrize("tilt", [0.0, 30.0, 60.0, 75.0])
@pytest.mark.parametrize("name", LASERS)
def test_a_plane_receives_the_power_at_every_tilt(name: str, tilt: float) -> None:
    stretch = 1.0 / np.cos(np.radians(tilt))
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    scene = scene_of(integrator, seen_from_above(stretch), 1.0, laser=laser_at(LASERS[name], tilt))
    # A white Lambertian surface has the radiance irradiance / pi.
    area = stretch * (2.0 * HALF_SIDE) ** 2
    powers = np.pi * area * pictures(scene, count=8, spp=64).mean(axis=(1, 2))
    # Two-sided, significance 1e-3. The light does not depend on the seed, so neither does the bias.
    assert abs(t_value(powers - POWER)) < stats.t.isf(0.5e-3, 7)
    # The test must have the power to see an error of 2 %.
    assert powers.std(ddof=1) / np.sqrt(8) < 0.004 * POWER


@pytest.mark.parametrize("name", LASERS)
def test_the_particle_tracer_sees_what_the_path_tracer_sees(name: str) -> None:
    laser = laser_at(LASERS[name], 40.0)
    count = 16

    def blocks(kind: str, spp: int) -> Array:
        """Render pictures by an integrator and average 4 x 4 pixels."""
        integrator = {"type": kind, "max_depth": 2}
        scene = scene_of(integrator, perspective(), 0.7, laser=laser)
        many = pictures(scene, count, spp).reshape(count, 12, 4, 12, 4)
        averages: Array = many.mean(axis=(2, 4)).reshape(count, 144)
        return averages

    path, particles = blocks("path", 16), blocks("ptracer", 64)
    lit = path.mean(axis=0) > 0.01 * path.mean(axis=0).max()
    t = t_value((path - particles)[:, lit])
    # Significance 1e-3 for all blocks together (Bonferroni).
    assert lit.sum() > 8
    assert np.abs(t).max() < stats.t.isf(0.5e-3 / lit.sum(), count - 1)
    assert abs(t_value((path - particles).sum(axis=1))) < stats.t.isf(0.5e-3, count - 1)


def test_two_lasers_add_up() -> None:
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    lasers = {"first": laser_at(SPOT, 20.0), "second": laser_at({**LINE, "power": 1e-3}, 0.0)}
    scene = scene_of(integrator, seen_from_above(), 1.0, **lasers)
    area = (2.0 * HALF_SIDE) ** 2
    powers = np.pi * area * pictures(scene, count=8, spp=128).mean(axis=(1, 2))
    assert abs(t_value(powers - POWER - 1e-3)) < stats.t.isf(0.5e-3, 7)
    assert powers.std(ddof=1) / np.sqrt(8) < 0.005 * POWER


def test_light_that_surfaces_would_have_to_find_is_dark() -> None:
    integrator = {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1}
    scene = scene_of(integrator, seen_from_above(), 1.0, laser=laser_at(SPOT, 0.0))
    assert not pictures(scene, count=1, spp=4).any()


def test_an_obstacle_casts_a_shadow() -> None:
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    # It covers x > 0 half-way to the laser, which is farther away than the sensor sees.
    obstacle = {
        "type": "rectangle",
        "to_world": Transform().translate([0.05, 0.0, DISTANCE / 2]) @ Transform().scale(0.05),
    }
    laser = laser_at(SPOT, 0.0)
    sensor = {**seen_from_above()}
    sensor["to_world"] = Transform().translate([0, 0, DISTANCE / 4 - 1.0]) @ sensor["to_world"]
    scene = scene_of(integrator, sensor, 1.0, laser=laser, obstacle=obstacle)
    picture = pictures(scene, count=1, spp=16)[0]
    # The picture is upright: its columns follow x.
    dark, lit = sorted((picture[:, :23], picture[:, 25:]), key=lambda half: float(half.sum()))
    assert not dark.any()
    assert lit.max() > 0.0


def test_the_picture_follows_the_power_by_differentiation() -> None:
    scene = scene_of({"type": "prb", "max_depth": 2}, perspective(), 0.7, laser=laser_at(SPOT, 0.0))
    parameters = mi.traverse(scene)
    dr.enable_grad(parameters["laser.power"])
    parameters.update()
    picture = mi.render(scene, parameters, spp=8, seed=mi.UInt32(1), seed_grad=2)
    dr.backward(dr.sum(picture, axis=None))
    # Linear in the power, along the same paths; sums of 18,000 samples in single precision.
    total = np.array(mi.render(scene, spp=8, seed=mi.UInt32(2))).sum(dtype=np.float64)
    assert dr.grad(parameters["laser.power"])[0] == pytest.approx(total / POWER, rel=1e-4)


def test_moving_the_laser_compiles_nothing_anew() -> None:
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    scene = scene_of(integrator, seen_from_above(), 1.0, laser=laser_at(SPOT, 0.0))
    parameters = mi.traverse(scene)
    first = pictures(scene, count=1, spp=4)
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        dr.kernel_history_clear()
        move = mi.AffineTransform4f().translate([HALF_SIDE / 2, 0.0, 0.0])
        parameters["laser.to_world"] = move @ parameters["laser.to_world"]
        parameters["laser.waist_radius"] = 1.6e-3
        parameters.update()
        moved = pictures(scene, count=1, spp=4)
        kernels = dr.kernel_history([dr.KernelType.JIT])
    assert np.abs(first - moved).max() > 0.1 * first.max()
    biggest = max(kernels, key=lambda kernel: kernel["operation_count"])
    assert biggest["cache_hit"]


def shadow_of_a_blade(unit: str) -> float:
    """Return the length of the shadow of a blade of 0.5 mm in light at 45 degrees, in mm."""
    scale = {"mm": 1.0, "m": 1e-3}[unit]

    def lengths(*millimetres: float) -> list[float]:
        return [scale * length for length in millimetres]

    # Wide enough to be even over the 2 mm that the sensor sees.
    laser = {
        "type": "laser",
        "unit": unit,
        "wavelength": 650e-6 * scale,
        "power": POWER,
        "waist_radius": 60.0 * scale,
        "to_world": Transform().look_at(lengths(100, 0, 100), [0, 0, 0], [0, 1, 0]),
    }
    blade = {
        "type": "rectangle",
        "to_world": Transform().look_at(lengths(0, 0, 0.25), lengths(1, 0, 0.25), [0, 0, 1])
        @ Transform().scale([5.0 * scale, 0.25 * scale, 1.0]),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}},
    }
    above = Transform().look_at(lengths(0, 0, 20), [0, 0, 0], [0, 1, 0])
    sensor = {
        "type": "orthographic",
        "near_clip": scale,
        "to_world": above @ Transform().scale([scale, scale, 1.0]),
    }
    integrator = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
    plate = {
        "type": "rectangle",
        "to_world": Transform().scale(10.0 * scale),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.8}},
    }
    scene = scene_of(integrator, sensor, 0.8, plane=plate, laser=laser, blade=blade)
    picture = pictures(scene, count=1, spp=64)[0]
    lit = picture.max(axis=1, keepdims=True)
    return float((1.0 - picture / lit).mean()) * 2.0


def test_a_shadow_is_as_long_as_its_blade_is_high_in_millimetres() -> None:
    # Mitsuba leaves 8.9e-5 (1 + |p|) mm at the foot; edges of 1/24 mm in 64 samples per pixel, and
    # light that changes by 0.2 % over the picture, 0.004 mm.
    assert shadow_of_a_blade("mm") == pytest.approx(0.5, abs=0.01)
    # In metres it is 0.09 mm: should that end, the documentation may say so.
    assert shadow_of_a_blade("m") == pytest.approx(0.41, abs=0.02)


@pytest.mark.parametrize(("unit", "metres"), [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)])
def test_light_is_per_square_metre_in_every_unit(unit: str, metres: float) -> None:
    laser = mi.load_dict(
        {
            "type": "laser",
            "unit": unit,
            "wavelength": 650e-9 / metres,
            "power": POWER,
            "waist_radius": 2e-3 / metres,
        }
    )
    it = dr.zeros(mi.SurfaceInteraction3f)
    it.p = mi.Point3f(0.0, 0.0, 0.1 / metres)
    _, irradiance = laser.sample_direction(it, mi.Point2f(0.5), True)
    # On the axis it is 2 P / (pi w**2), with w 1.3e-5 wider than the waist; power is that of a ray.
    expected = 2.0 * POWER / (np.pi * 2e-3**2)
    assert irradiance[0][0] == pytest.approx(expected, rel=1e-4)
    assert f"unit = {unit}" in str(laser)


@pytest.mark.parametrize(
    ("unit", "wavelength", "culprit"),
    [("mm", 650e-9, "wavelength"), ("um", 650e-9, "wavelength"), ("inch", 650e-9, "unit")],
)
def test_a_wavelength_in_another_unit_is_refused(
    unit: str, wavelength: float, culprit: str
) -> None:
    laser = {**SPOT, "unit": unit, "wavelength": wavelength}
    with pytest.raises(RuntimeError, match=f"laser: {culprit}: "):
        mi.load_dict(laser)
