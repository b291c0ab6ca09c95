"""The Mitsuba emitter ``laser`` against the light types of ``tem00.beam``, point by point.

The library evaluates in double precision and in Rust; the emitter in single precision and in
kernels of Dr.Jit.
"""

from __future__ import annotations

import subprocess
import sys
from math import radians, tan
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import special, stats

import tem00
from tem00 import beam

mi.set_variant("llvm_ad_rgb")

import tem00.mitsuba  # noqa: E402
from tem00.mitsuba.normal import erfc, standard_normal  # noqa: E402

tem00.mitsuba.register()

Array = NDArray[np.float64]
Properties = dict[str, Any]

EPSILON = 2.0**-23
ORIGIN = np.array([0.05, -0.02, 0.3])
TARGET = np.array([-0.02, 0.03, 0.01])
UP = np.array([0.1, 1.0, 0.2])

SPOT: Properties = {"wavelength": 650e-9, "power": 5e-3, "waist_radius": 80e-6}
LINE: Properties = {
    "shape": "line",
    "wavelength": 650e-9,
    "power": 5e-3,
    "fan_angle": 30.0,
    "thickness": 0.2e-3,
    "focus_distance": 0.3,
}
LASERS: dict[str, Properties] = {
    "spot": SPOT,
    "focused spot": {**SPOT, "waist_distance": 0.3, "m_squared": 1.4},
    "elliptic spot": {
        **SPOT,
        "waist_distance": 0.1,
        "waist_radius_y": 0.3e-3,
        "waist_distance_y": -0.2,
        "m_squared_y": 2.0,
    },
    "gaussian": LINE,
    "gaussian on a plane": {**LINE, "focus_curve": "plane", "m_squared": 1.7},
    "gaussian_angle": {**LINE, "profile": "gaussian_angle", "apex_offset": 3e-3},
    "gaussian_sin": {**LINE, "profile": "gaussian_sin", "fan_angle": 100.0},
    "uniform": {**LINE, "profile": "uniform", "focus_distance": -0.1},
    "uniform_angle": {**LINE, "profile": "uniform_angle", "fan_angle": 60.0},
    "powell": {**LINE, "profile": "powell"},
    "powell, soft": {**LINE, "profile": "powell", "edge": 0.7},
}

PROFILES = {
    "gaussian": beam.LineProfile.gaussian_tan(),
    "gaussian_angle": beam.LineProfile.gaussian_angle(),
    "gaussian_sin": beam.LineProfile.gaussian_sin(),
    "uniform": beam.LineProfile.uniform_tan(),
    "uniform_angle": beam.LineProfile.uniform_angle(),
}

every_laser = pytest.mark.parametrize("name", LASERS)


def emitter(properties: Properties, **more: object) -> Any:
    to_world = mi.ScalarTransform4f().look_at(list(ORIGIN), list(TARGET), list(UP))
    return mi.load_dict({"type": "laser", "to_world": to_world, **properties, **more})


def library_light(properties: Properties) -> Any:
    direction = TARGET - ORIGIN
    placement = beam.Placement(
        origin=tuple(ORIGIN), direction=tuple(direction), fan_axis=tuple(np.cross(UP, direction))
    )
    if properties.get("shape") == "line":
        return beam.Light.line(library_line(properties), placement, properties["power"])
    axes = [located(properties, suffix) for suffix in ("", "_y")]
    return beam.Light.elliptic(
        beam.AstigmaticBeam(*axes), placement, properties["power"]
    )


def located(spot: Properties, suffix: str) -> Any:
    first = {"waist_distance": 0.0, "m_squared": 1.0, **spot}
    own = {name: first.get(name + suffix, value) for name, value in first.items()}
    focus = beam.GaussianBeam.from_waist(own["wavelength"], own["waist_radius"])
    return beam.LocatedBeam(focus.with_m_squared(own["m_squared"]), own["waist_distance"])


def library_line(line: Properties) -> Any:
    focus = beam.GaussianBeam.from_waist(line["wavelength"], line["thickness"] / 2.0)
    focus = focus.with_m_squared(line.get("m_squared", 1.0))
    angle, distance = radians(line["fan_angle"]), line["focus_distance"]
    on_plane = line.get("focus_curve") == "plane"
    fan = beam.FanGeometry(
        fan_angle=angle,
        apex_offset=line.get("apex_offset", focus.radius_at(distance) / tan(angle / 2.0)),
        focus_distance=distance,
        focus_curve="equal_plane" if on_plane else "equal_distance",
    )
    if line.get("profile") == "powell":
        profile = beam.LineProfile.powell(line.get("edge", 0.05))
    else:
        profile = PROFILES[line.get("profile", "gaussian")]
    return beam.LaserLine(focus, fan, profile)


def frame_of(light: Any) -> Array:
    return np.stack([light.ex, light.ey, light.ez])


def lit_points(light: Any, count: int = 20_000) -> Array:
    """Draw points on rays of the light, up to 0.5 m away: where there is light."""
    rng = np.random.default_rng(1)
    rays = light.sample_ray(rng.random((count, 4)))
    depth = rng.uniform(0.01, 0.5, count) / rays.cos
    points: Array = rays.origin + depth[:, np.newaxis] * rays.direction
    # Steep rays of wide fans leave the scene.
    near: Array = points[np.linalg.norm(points, axis=1) < 1.0]
    return near


def interaction(points: Array) -> Any:
    it = dr.zeros(mi.SurfaceInteraction3f, len(points))
    it.p = mi.Point3f(points.T.astype(np.float32))
    return it


def sampled_direction(laser: Any, points: Array) -> tuple[Any, Array]:
    ds, weight = laser.sample_direction(interaction(points), mi.Point2f(0.5), True)
    return ds, np.array(weight)


def box_around(light: Any, points: Array) -> Array:
    """Return 27 points around each, as far as single precision may move it: shape (27, n, 3).

    Coordinates are rounded twice and rotated in three terms: 4 epsilon of the larger distance.
    """
    size = np.maximum(np.linalg.norm(points, axis=1), np.linalg.norm(light.origin))
    corners = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 3), axis=-1).reshape(27, 1, 3)
    moved: Array = points + corners @ frame_of(light) * (4.0 * EPSILON * size[:, np.newaxis])
    return moved


def test_the_error_function_keeps_its_digits_in_the_tail() -> None:
    x = np.linspace(-9.0, 9.0, 100_001).astype(np.float32)
    single: Any = mi.Float(x)
    ratio = np.array(erfc(single)) / special.erfc(x.astype(np.float64))
    # As its documentation states, down to 1e-36.
    assert (np.abs(ratio - 1.0) < 4e-7 * (1.0 + x.astype(np.float64) ** 2)).all()


def test_normal_variates_are_quantiles() -> None:
    u = np.concatenate([np.linspace(0.0, 1.0, 10_001)[:-1], 2.0 ** np.arange(-24.0, 0.0)])
    single: Any = mi.Float(u.astype(np.float32))
    variates = np.array(standard_normal(single))
    expected = special.ndtri(np.maximum(u.astype(np.float32), 2.0**-25).astype(np.float64))
    # 1e-6 of the inverse error function; 2 u - 1 is rounded to 2**-25 and the density divides it.
    density = stats.norm.pdf(expected)
    assert (np.abs(variates - expected) < 2e-6 + 2.0**-25 / density * (u > 2.0**-20)).all()


@every_laser
def test_light_at_points_is_that_of_the_library(name: str) -> None:
    light, laser = library_light(LASERS[name]), emitter(LASERS[name])
    points = lit_points(light).astype(np.float32).astype(np.float64)
    ds, weight = sampled_direction(laser, points)

    around = light.next_event(*np.moveaxis(box_around(light, points), -1, 0))

    # 4 epsilon of the exponent, which is at most 32, and 4e-7 (1 + 32) of the roll-off.
    slack = 3e-5
    for channel in weight:
        assert (channel >= (1.0 - slack) * around.e_perp.min(axis=0)).all()
        assert (channel <= (1.0 + slack) * around.e_perp.max(axis=0)).all()
    lit = around.e_perp.min(axis=0) > 0.0
    assert lit.mean() > 0.9
    assert np.array_equal(np.array(ds.pdf)[lit], np.ones(lit.sum()))
    # The rotations of the direction and of the point on the aperture.
    for single, double, size in (
        (np.array(ds.d).T, around.wi, 1.0),
        (np.array(ds.p).T, around.point, 0.5),
        (np.array(ds.dist), around.distance, 1.0),
    ):
        assert (single >= double.min(axis=0) - 8.0 * EPSILON * size)[lit].all()
        assert (single <= double.max(axis=0) + 8.0 * EPSILON * size)[lit].all()


@every_laser
def test_dark_points_need_no_shadow_ray(name: str) -> None:
    light, laser = library_light(LASERS[name]), emitter(LASERS[name])
    rng = np.random.default_rng(2)
    local = rng.normal(0.0, 1.0, (1000, 3)) * rng.choice([1e-6, 1e-3, 1.0, 1e6], (1000, 1))
    points = light.origin + local @ frame_of(light)
    ds, weight = sampled_direction(laser, points)

    around = light.next_event(*np.moveaxis(box_around(light, points), -1, 0))
    sure = (around.e_perp == 0.0).all(axis=0)
    assert sure.sum() > 300
    assert not np.array(ds.pdf)[sure].any()
    assert not weight[:, sure].any()
    assert np.isfinite(np.array(ds.d)).all()
    assert np.isfinite(weight).all()


@every_laser
def test_rays_are_those_of_the_library(name: str) -> None:
    light, laser = library_light(LASERS[name]), emitter(LASERS[name])
    u = np.random.default_rng(3).random((20_000, 4), dtype=np.float32)
    ray, weight = laser.sample_ray(0.0, 0.5, mi.Point2f(u.T[2:]), mi.Point2f(u.T[:2]))
    rays = light.sample_ray(u.astype(np.float64))

    # The inverse error function of Dr.Jit is off by 1e-6; angles next to 90 degrees magnify it.
    plain = rays.cos > 0.2
    assert plain.mean() > 0.95
    tilt = np.abs(np.array(ray.d).T - rays.direction).max(axis=1)
    assert (tilt * rays.cos < 2e-6)[plain].all()
    size = np.linalg.norm(rays.origin - light.origin, axis=1) / rays.cos**2
    shift = np.abs(np.array(ray.o).T - rays.origin).max(axis=1)
    assert (shift < 4e-6 * (size + 1e-4) + 2.0 * EPSILON)[plain].all()
    assert np.allclose(np.array(weight), LASERS[name]["power"], rtol=EPSILON)


@every_laser
def test_rays_land_where_the_light_is(name: str) -> None:
    """Pearson's chi-squared on a plane square to the axis, with the library's irradiance."""
    light, laser = library_light(LASERS[name]), emitter(LASERS[name])
    depth, count = 0.2, 200_000
    u = np.random.default_rng(4).random((4, count), dtype=np.float32)
    ray, _ = laser.sample_ray(0.0, 0.5, mi.Point2f(u[2:]), mi.Point2f(u[:2]))
    origins, directions = (
        (np.array(v).T - offset) @ frame_of(light).T
        for v, offset in ((ray.o, light.origin), (ray.d, 0.0))
    )
    hits = origins + directions * ((depth - origins[:, 2:]) / directions[:, 2:])

    edges = cell_edges(LASERS[name], depth)
    observed, _, _ = np.histogram2d(hits[:, 0], hits[:, 1], bins=edges)
    expected = count * power_in_cells(light, depth, edges) / light.power
    observed = np.append(observed, count - observed.sum())
    expected = np.append(expected, count - expected.sum())
    likely = expected >= 10.0
    observed = np.append(observed[likely], observed[~likely].sum())
    expected = np.append(expected[likely], expected[~likely].sum() + 1e-9)
    statistic = ((observed - expected) ** 2 / np.maximum(expected, 1.0)).sum()
    # Significance 1e-3.
    assert statistic < stats.chi2.isf(1e-3, len(expected) - 1)


def cell_edges(properties: Properties, depth: float) -> list[Array]:
    """Return edges of cells that hold nearly all light; those of a fan lie on edges of cells."""
    if properties.get("shape") == "line":
        line = library_line(properties)
        half_length = line.half_length_at(depth)
        theta = radians(properties["fan_angle"]) / 2.0
        half_width = max(line.half_thickness_at_angle(depth, t) for t in (0.0, theta))
    else:
        axes = [located(properties, suffix) for suffix in ("", "_y")]
        half_length, half_width = (axis.radius_at(depth) for axis in axes)
    return [np.linspace(-1.5, 1.5, 25) * half_length, np.linspace(-1.5, 1.5, 13) * half_width]


def power_in_cells(light: Any, depth: float, edges: list[Array]) -> Array:
    """Integrate the irradiance over cells by 8 x 8 Gaussian nodes."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    x, y = (
        (e[:-1, np.newaxis] + e[1:, np.newaxis] + np.diff(e)[:, np.newaxis] * nodes) / 2.0
        for e in edges
    )
    local = np.stack(np.broadcast_arrays(x[:, :, None, None], y, depth), axis=-1)
    points = np.moveaxis(light.origin + local @ frame_of(light), -1, 0)
    cell_areas = np.outer(*(np.diff(e) for e in edges)) / 4.0
    irradiance: Array = np.einsum("iajb,a,b->ij", light.irradiance(*points), weights, weights)
    return irradiance * cell_areas


def test_the_light_follows_its_power_by_differentiation() -> None:
    laser = emitter(SPOT)
    parameters = mi.traverse(laser)
    dr.enable_grad(parameters["power"])
    parameters.update()
    points = ORIGIN + np.linspace(0.1, 0.5, 5)[:, np.newaxis] * (TARGET - ORIGIN)
    _, weight = laser.sample_direction(interaction(points), mi.Point2f(0.5), True)

    dr.backward(dr.sum(weight[0]))

    # The light is linear in its power.
    expected = dr.sum(weight[0])[0] / SPOT["power"]
    assert dr.grad(parameters["power"])[0] == pytest.approx(expected, rel=8.0 * EPSILON)


@pytest.mark.parametrize("name", ["focused spot", "gaussian", "powell"])
def test_the_light_follows_its_place_by_differentiation(name: str) -> None:
    light, laser = library_light(LASERS[name]), emitter(LASERS[name])
    shift = mi.Float(0.0)
    dr.enable_grad(shift)
    parameters = mi.traverse(laser)
    along_x = mi.Vector3f(*(shift * float(component) for component in light.ex))
    parameters["to_world"] = (
        mi.AffineTransform4f().translate(along_x) @ parameters["to_world"]
    )
    parameters.update()
    points = lit_points(light, 1000)
    _, weight = laser.sample_direction(interaction(points), mi.Point2f(0.5), True)

    dr.forward(shift)

    # Moving the light by +x is moving all points by -x.
    step = 1e-8
    after, before = (
        light.next_event(*(points + sign * step * light.ex).T).e_perp for sign in (-1.0, 1.0)
    )
    expected = (after - before) / (2.0 * step)
    # Single precision has 4 epsilon |p| / w of the argument of the exponential at w = 0.1 mm.
    error = np.abs(dr.grad(weight[0]).numpy() - expected).max()
    assert error < 0.02 * np.abs(expected).max()


@pytest.mark.parametrize("name", ["elliptic spot", "powell"])
def test_changed_parameters_give_the_light_of_a_fresh_emitter(name: str) -> None:
    changed = dict(LASERS[name], power=1e-3, wavelength=532e-9, m_squared=1.5)
    laser, fresh = emitter(LASERS[name]), emitter(changed, color={"type": "rgb", "value": 0.5})
    move = mi.ScalarTransform4f().translate([0.01, 0.02, 0.03])
    fresh_parameters = mi.traverse(fresh)
    fresh_parameters["to_world"] = mi.AffineTransform4f(move.matrix) @ mi.AffineTransform4f(
        fresh_parameters["to_world"]
    )
    fresh_parameters.update()
    parameters = mi.traverse(laser)
    for key in ("power", "wavelength", "m_squared"):
        parameters[key] = changed[key]
    parameters["color"] = mi.Color3f(0.5)
    parameters["to_world"] = fresh_parameters["to_world"]
    parameters.update()

    points = lit_points(library_light(LASERS[name])) + [0.01, 0.02, 0.03]
    _, weight = sampled_direction(laser, points)
    _, expected = sampled_direction(fresh, points)
    assert laser.wavelength == pytest.approx(532e-9, rel=EPSILON)
    # The parameters are rounded to single precision; w follows the wavelength.
    assert np.allclose(weight, expected, rtol=1e-4, atol=1e-6 * expected.max())


def test_no_ray_of_a_material_hits_the_laser() -> None:
    laser = emitter(SPOT)
    it, ds = interaction(ORIGIN[np.newaxis]), dr.zeros(mi.DirectionSample3f)
    assert laser.pdf_direction(it, ds, True)[0] == 0.0
    assert np.array(laser.eval(it, True)).max() == 0.0
    assert laser.flags() & int(mi.EmitterFlags.DeltaPosition)
    assert laser.flags() & 0x1000
    assert np.allclose(np.array(laser.bbox().min), ORIGIN, atol=EPSILON)


def test_the_light_can_be_asked_for_again_in_a_direction() -> None:
    light, laser = library_light(LINE), emitter(LINE)
    points = lit_points(light, 100)
    ds, weight = sampled_direction(laser, points)
    again = np.array(laser.eval_direction(interaction(points), ds, True))
    assert np.array_equal(again, weight)


@pytest.mark.parametrize(
    ("properties", "culprit"),
    [
        ({**SPOT, "waist_raduis": 1e-3}, "waist_raduis"),
        ({**SPOT, "fan_angle": 30.0}, "fan_angle"),
        ({**SPOT, "waist_radius": 1e-9}, "waist_radius"),
        ({**SPOT, "waist_radius_y": -1.0}, "waist_radius_y"),
        ({**SPOT, "waist_radius": "wide"}, "waist_radius"),
        ({**SPOT, "m_squared": 0.5}, "m_squared"),
        ({**SPOT, "m_squared_y": 0.5}, "m_squared_y"),
        ({**SPOT, "waist_distance_y": float("nan")}, "waist_distance_y"),
        ({**SPOT, "wavelength": 0.0}, "wavelength"),
        ({**SPOT, "power": -1.0}, "power"),
        ({**SPOT, "power": True}, "power"),
        ({**SPOT, "shape": "disc"}, "shape"),
        ({**SPOT, "color": {"type": "spectrum", "value": 1.0}}, "color"),
        ({**SPOT, "color": {"type": "rgb", "value": [1.0, -1.0, 1.0]}}, "color"),
        ({**SPOT, "to_world": mi.ScalarTransform4f().scale(2.0)}, "to_world"),
        ({key: SPOT[key] for key in ("power", "waist_radius")}, "wavelength"),
        ({**LINE, "thickness": 1e-9}, "thickness"),
        ({**LINE, "fan_angle": 180.0}, "fan_angle"),
        ({**LINE, "focus_distance": float("inf")}, "focus_distance"),
        ({**LINE, "apex_offset": 0.0}, "apex_offset"),
        ({**LINE, "profile": "flat"}, "profile"),
        ({**LINE, "focus_curve": "sphere"}, "focus_curve"),
        ({**LINE, "edge": 0.1}, "edge"),
        ({**LINE, "profile": "powell", "edge": 0.0}, "edge"),
        ({**LINE, "waist_radius": 1e-3}, "waist_radius"),
    ],
)
def test_a_bad_property_is_named(properties: Properties, culprit: str) -> None:
    with pytest.raises(RuntimeError, match=f"ParameterError: laser: {culprit}: "):
        mi.load_dict({"type": "laser", **properties})


def test_a_bad_change_of_a_parameter_is_named() -> None:
    parameters = mi.traverse(emitter(SPOT))
    parameters["m_squared"] = 0.5
    with pytest.raises(tem00.ParameterError, match="laser: m_squared: ") as refusal:
        parameters.update()
    assert refusal.value.parameter == "m_squared"


def test_a_scene_file_may_hold_a_laser() -> None:
    laser: Any = mi.load_string(
        """<emitter version="3.0.0" type="laser">
            <string name="shape" value="line"/>
            <float name="wavelength" value="650e-9"/>
            <float name="power" value="0.005"/>
            <float name="fan_angle" value="30"/>
            <float name="thickness" value="0.2e-3"/>
            <float name="focus_distance" value="0.3"/>
            <rgb name="color" value="1, 0, 0"/>
            <transform name="to_world">
                <lookat origin="0, 0, 0.3" target="0, 0, 0" up="0, 1, 0"/>
            </transform>
        </emitter>"""
    )
    _, weight = sampled_direction(laser, np.array([[0.05, 0.0, 0.0], [0.0, 0.05, 0.0]]))
    # The fan opens along x = up x direction.
    assert weight[0, 0] > 0.0
    assert not weight[1:].any()
    assert not weight[:, 1].any()


def test_the_other_variants_hold_a_laser_or_say_why_not() -> None:
    tem00.mitsuba.register()
    points = lit_points(library_light(SPOT), 100)
    green = {"type": "rgb", "value": [0.0, 1.0, 0.0]}
    _, coloured = sampled_direction(emitter(SPOT, color=green), points)
    try:
        mi.set_variant("llvm_ad_mono")
        _, grey = sampled_direction(emitter(SPOT, color=green), points)
        # The luminance of the green of sRGB (ITU-R BT.709).
        assert np.allclose(grey[0], 0.7152 * coloured[1], rtol=1e-4)
        assert grey.any()
        mi.set_variant("llvm_ad_mono_polarized")
        _, stokes = sampled_direction(emitter(SPOT, color=green), points)
        # Light leaves unpolarised: a depolariser holds the radiance alone.
        assert np.array_equal(stokes[0, 0], grey)
        assert np.count_nonzero(stokes) == np.count_nonzero(grey)
        mi.set_variant("llvm_ad_spectral")
        with pytest.raises(RuntimeError, match="use an rgb or mono variant"):
            tem00.mitsuba.register()
        mi.set_variant("scalar_rgb")
        with pytest.raises(RuntimeError, match="kernels, which scalar_rgb has not: use an LLVM"):
            tem00.mitsuba.register()
    finally:
        mi.set_variant("llvm_ad_rgb")


def test_the_package_itself_needs_no_mitsuba() -> None:
    program = "import sys, tem00; sys.exit('mitsuba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
