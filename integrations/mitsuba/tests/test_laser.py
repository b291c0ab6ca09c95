"""The emitter `laser` against closed forms, the library and Mitsuba's own light transport."""

from typing import Any

import mitsuba as mi
import numpy as np
import numpy.typing as npt
import pytest
import scenes
from scenes import POWER, WAVELENGTH, Scene

from tem00 import beam

Array = npt.NDArray[np.float64]

ROUNDING = 2.0**-23
"""Relative error of a result that has been rounded to single precision, twice over."""


def line(**changes: Any) -> Scene:
    """Return a laser line along x, 0.2 m above the plate."""
    return {
        "type": "laser",
        "shape": "line",
        "wavelength": WAVELENGTH,
        "power": POWER,
        "fan_angle": 30.0,
        "thickness": 0.4e-3,
        "focus_distance": 0.2,
        "to_world": scenes.looking([0, 0.1, 0.1732], [0, 0, 0], [0, 0.866, -0.5]),
    } | changes


def frame(laser: Any) -> tuple[Array, Array]:
    """Return the origin of a laser, and its axes as the rows of a matrix."""
    matrix = np.array(mi.traverse(laser)["to_world"].matrix, dtype=float)
    return matrix[:3, 3], matrix[:3, :3].T


def events(laser: Any, points: Array) -> tuple[Array, Array, Array]:
    """Return the irradiance across the light, the direction to it and the distance at points."""
    interaction = mi.SurfaceInteraction3f()
    drawn = []
    for point in points:
        interaction.p = point
        drawn.append(laser.sample_direction(interaction, [0.5, 0.5]))
    e_perp = np.array([weight[0] if sample.pdf > 0 else 0.0 for sample, weight in drawn])
    direction = np.array([np.array(sample.d) for sample, _ in drawn], dtype=float)
    distance = np.array([sample.dist for sample, _ in drawn])
    return e_perp, direction, distance


def points_in(laser: Any, half_width: list[float], seed: int = 1) -> Array:
    """Return random points 0.05 to 0.35 m before the laser, exact in single precision."""
    rng = np.random.default_rng(seed)
    origin, axes = frame(laser)
    along = rng.uniform(0.05, 0.35, 300)
    across = rng.uniform(-1, 1, (300, 2)) * half_width
    local = np.column_stack([across, along])
    return (origin + local @ axes).astype(np.float32).astype(float)


@pytest.mark.parametrize(
    ("properties", "axes_of_beam"),
    [
        ({"waist_radius": 0.4e-3}, [(0.4e-3, 0.0, 1.0)] * 2),
        ({"waist_radius": 50e-6, "waist_distance": 0.2, "m_squared": 1.3},
         [(50e-6, 0.2, 1.3)] * 2),
        ({"waist_radius": 60e-6, "waist_distance": 0.15, "waist_radius_y": 0.3e-3,
          "waist_distance_y": 0.25, "m_squared_y": 2.0},
         [(60e-6, 0.15, 1.0), (0.3e-3, 0.25, 2.0)]),
    ],
)
def test_a_spot_is_a_gaussian_beam(
    properties: Scene, axes_of_beam: list[tuple[float, float, float]]
) -> None:
    laser = mi.load_dict(scenes.spot(**properties))
    points = points_in(laser, [1e-3, 1e-3])
    origin, axes = frame(laser)
    x, y, z = ((points - origin) @ axes.T).T

    # Siegman 1986, ch. 17: w² = w0² + θ² (z − z0)², and the flux follows the wavefront.
    peak, slopes = np.full_like(z, 2 * POWER / np.pi), []
    exponent = np.zeros_like(z)
    for across, (waist, z0, quality) in zip((x, y), axes_of_beam, strict=True):
        divergence = quality * WAVELENGTH / (np.pi * waist)
        squared = waist**2 + (divergence * (z - z0)) ** 2
        peak = peak / np.sqrt(squared)
        exponent -= 2 * across**2 / squared
        slopes.append(across * divergence**2 * (z - z0) / squared)
    secant = np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)
    flux = peak * np.exp(exponent) * secant
    toward = -np.column_stack([slopes[0], slopes[1], np.ones_like(z)]) / secant[:, None]

    e_perp, direction, distance = events(laser, points)
    lit = e_perp > 0
    # The cut-off lies at four radii, beyond which e⁻³² is left.
    assert np.all(flux[~lit] <= peak[~lit] * np.exp(-31.9))
    assert np.count_nonzero(lit) > 100
    # The axes of the frame are rounded to 6e-8, their error times the distance shifts the beam.
    np.testing.assert_allclose(e_perp[lit], flux[lit], rtol=1e-3)
    np.testing.assert_allclose(direction[lit], (toward @ axes)[lit], atol=4 * ROUNDING)
    np.testing.assert_allclose(distance[lit], (z * secant)[lit], rtol=4 * ROUNDING)


def placed_line(laser: Any, properties: Scene) -> beam.LineLight:
    """Return the library's light for a line, where Mitsuba has put it."""
    profiles = {
        "gaussian": beam.LineProfile.gaussian_tan(),
        "gaussian_angle": beam.LineProfile.gaussian_angle(),
        "gaussian_sin": beam.LineProfile.gaussian_sin(),
        "uniform": beam.LineProfile.uniform_tan(),
        "uniform_angle": beam.LineProfile.uniform_angle(),
        "powell": beam.LineProfile.powell(properties.get("edge", 0.05)),
    }
    on_plane = properties.get("focus_curve") == "plane"
    focus = beam.GaussianBeam.from_waist(WAVELENGTH, properties["thickness"] / 2)
    focus = focus.with_m_squared(properties.get("m_squared", 1.0))
    tangent = np.tan(np.radians(properties["fan_angle"] / 2))
    fan = beam.FanGeometry(
        fan_angle=np.radians(properties["fan_angle"]),
        apex_offset=properties.get("apex_offset",
                                   focus.radius_at(properties["focus_distance"]) / tangent),
        focus_distance=properties["focus_distance"],
        focus_curve="equal_plane" if on_plane else "equal_distance",
    )
    profile = profiles[properties.get("profile", "gaussian")]
    origin, axes = frame(laser)
    placement = beam.Placement(origin=origin, direction=axes[2], fan_axis=axes[0])
    return beam.LineLight.place(beam.LaserLine(focus, fan, profile), placement, POWER)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"profile": "gaussian_angle", "fan_angle": 80.0},
        {"profile": "gaussian_sin", "focus_curve": "plane"},
        {"profile": "uniform"},
        {"profile": "uniform_angle", "m_squared": 1.4},
        {"profile": "powell"},
        {"profile": "powell", "edge": 0.2, "apex_offset": 5e-3},
    ],
)
def test_a_line_is_that_of_the_library(changes: Scene) -> None:
    properties = line(**changes)
    laser = mi.load_dict(properties)
    light = placed_line(laser, properties)
    points = points_in(laser, [0.06, 0.3e-3])
    expected = light.next_event(*points.T)
    e_perp, direction, distance = events(laser, points)
    lit = e_perp > 0
    assert np.count_nonzero(lit) > 100
    np.testing.assert_array_equal(lit, expected.e_perp > 0)
    np.testing.assert_allclose(e_perp, expected.e_perp, rtol=ROUNDING)
    np.testing.assert_allclose(direction[lit], expected.wi[lit], atol=ROUNDING)
    np.testing.assert_allclose(distance[lit], expected.distance[lit], rtol=ROUNDING)


@pytest.mark.parametrize("changes", [{}, {"profile": "powell"}, {"profile": "gaussian_angle"}])
def test_rays_are_those_of_the_library(changes: Scene) -> None:
    properties = line(**changes)
    laser = mi.load_dict(properties)
    light = placed_line(laser, properties)
    u = np.random.default_rng(5).random((200, 4)).astype(np.float32)
    expected = light.sample_ray(u.astype(float))
    for numbers, origin, direction in zip(u, expected.origin, expected.direction, strict=True):
        ray, weight = laser.sample_ray(0.0, 0.5, numbers[2:], numbers[:2])
        np.testing.assert_allclose(np.array(ray.o), origin, rtol=0, atol=0.2 * ROUNDING)
        np.testing.assert_allclose(np.array(ray.d), direction, rtol=0, atol=ROUNDING)
        assert np.array(weight) == pytest.approx(POWER, rel=ROUNDING)


@pytest.mark.parametrize("tilt", [0.0, 40.0, 75.0])
@pytest.mark.parametrize("shape", ["spot", "line"])
def test_a_plane_receives_the_power_whatever_its_tilt(shape: str, tilt: float) -> None:
    upright = scenes.looking([0, 0, 0.2], [0, 0, 0], [0, 1, 0])
    described = {
        "spot": scenes.spot(to_world=upright, waist_radius=0.5e-3, waist_distance=0.1),
        "line": line(to_world=upright, thickness=1e-3),
    }[shape]
    laser = mi.load_dict(described)
    # The rule of rectangles is exact to exp(−π² w² / (2 h²)), and w / h is 5 and more. What is left
    # is the rounding of the points, 1e-5 of a radius at random, and of the irradiance, 6e-8.
    half_x, half_y, count_x, count_y = {"spot": (3e-3, 3e-3, 60, 60),
                                        "line": (0.16, 2.5e-3, 40, 60)}[shape]
    cos, sin = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    # The plane is turned about x, along the line: what falls on it is longer by 1 / cos across.
    u = (np.arange(count_x) + 0.5) / count_x * 2 * half_x - half_x
    v = ((np.arange(count_y) + 0.5) / count_y * 2 * half_y - half_y) / cos
    grid_u, grid_v = (values.ravel() for values in np.meshgrid(u, v))
    points = np.column_stack([grid_u, grid_v * cos, grid_v * sin])
    e_perp, direction, _ = events(laser, points)
    received = np.sum(e_perp * (direction @ [0, -sin, cos])) * (u[1] - u[0]) * (v[1] - v[0])
    assert received == pytest.approx(POWER, rel=1e-6)


@pytest.mark.parametrize("shape", ["spot", "line"])
def test_the_particle_tracer_makes_the_picture_of_the_path_tracer(shape: str) -> None:
    laser = {"spot": scenes.spot(waist_radius=6e-3, waist_radius_y=4e-3),
             "line": line(thickness=4e-3, profile="powell", edge=0.2)}[shape]
    pictures = {
        kind: np.array([
            blocks(scenes.render({"type": kind, "max_depth": 2}, seed=seed, laser=laser,
                                 sensor=scenes.camera(samples=samples)))
            for seed in range(12)
        ])
        for kind, samples in (("path", 16), ("ptracer", 64))
    }
    path, particles = pictures["path"], pictures["ptracer"]
    # Where little light falls, too few particles arrive for a normal distribution.
    lit = path.mean(axis=0) > 0.03 * path.mean(axis=0).max()
    assert np.count_nonzero(lit) >= 6
    variance = (path.var(axis=0, ddof=1) + particles.var(axis=0, ddof=1)) / 12
    z = (path.mean(axis=0) - particles.mean(axis=0))[lit] / np.sqrt(variance[lit])
    # Student's t with some 11 degrees of freedom: beyond 6.4 in one of 24 blocks by 1e-3 at most.
    assert np.all(np.abs(z) < 6.4), z
    total = path.sum(axis=(1, 2)), particles.sum(axis=(1, 2))
    error = np.sqrt((total[0].var(ddof=1) + total[1].var(ddof=1)) / 12)
    # The same of the whole picture: beyond 4.4 by 1e-3.
    assert abs(total[0].mean() - total[1].mean()) < 4.4 * error


def blocks(picture: scenes.Image) -> scenes.Image:
    """Return the mean of each block of eight by eight pixels."""
    rows, columns = picture.shape
    means: scenes.Image = picture.reshape(rows // 8, 8, columns // 8, 8).mean(axis=(1, 3))
    return means


def test_a_plate_reflects_the_power_of_the_laser() -> None:
    # All of a spot of 1 mm is in the picture, 26 mm wide: L = ρ E / π, so that ∫ L dA = ρ P / π.
    narrow = scenes.spot(waist_radius=1e-3)
    pictures = [
        scenes.render({"type": "path", "max_depth": 2}, seed=seed, laser=narrow,
                      sensor=scenes.camera(samples=32))
        for seed in range(8)
    ]
    pixel = 2 * scenes.DISTANCE * np.tan(np.radians(scenes.FOV / 2)) / scenes.WIDTH
    power = np.array([picture.sum() for picture in pictures]) * pixel**2
    power *= np.pi / scenes.REFLECTANCE
    error = power.std(ddof=1) / np.sqrt(8)
    # Student's t with seven degrees of freedom: beyond 5.41 by 1e-3.
    assert abs(power.mean() - POWER) < 5.41 * error


def test_a_shadow_ray_is_sent_to_where_light_comes_from() -> None:
    # A blind with a hole of 0.5 mm before the lens of a line: next events point there, not at the
    # middle of the fan's apex behind it.
    laser = mi.load_dict(line())
    interaction = mi.SurfaceInteraction3f()
    interaction.p = mi.Point3f(0.03, 0.0, 0.0)
    sample, weight = laser.sample_direction(interaction, [0.5, 0.5])
    origin, axes = frame(laser)
    assert abs((np.array(sample.p) - origin) @ axes[2]) < 1e-7
    seen = np.array(interaction.p) + sample.dist * np.array(sample.d)
    np.testing.assert_allclose(seen, np.array(sample.p), atol=1e-7)
    assert sample.delta
    assert laser.pdf_direction(interaction, sample) == 0
    assert np.all(np.array(laser.eval_direction(interaction, sample)) == np.array(weight))


def test_where_no_light_arrives_no_shadow_ray_is_needed() -> None:
    laser = mi.load_dict(scenes.spot(waist_radius=1e-3))
    interaction = mi.SurfaceInteraction3f()
    # Far beside the beam, and behind the laser.
    for point in ([0.05, 0.0, 0.0], [0.2, 0.0, 0.3464]):
        interaction.p = mi.Point3f(point)
        sample, weight = laser.sample_direction(interaction, [0.5, 0.5])
        assert sample.pdf == 0
        assert np.all(np.array(weight) == 0)


def test_colour_scales_the_channels() -> None:
    colour = {"type": "rgb", "value": [0.5, 2.0, 0.0]}
    interaction = mi.SurfaceInteraction3f()
    white, coloured = (
        np.array(mi.load_dict(laser).sample_direction(interaction, [0.5, 0.5])[1])
        for laser in (scenes.spot(), scenes.spot(color=colour))
    )
    np.testing.assert_array_equal(coloured, white * [0.5, 2.0, 0.0])


def test_a_laser_can_be_changed_after_it_was_loaded() -> None:
    changed = mi.load_dict(scenes.spot())
    parameters = mi.traverse(changed)
    target = scenes.looking([-0.05, 0.02, 0.2], [0, 0, 0], [0, 1, 0])
    parameters["power"] = 2 * POWER
    parameters["waist_radius"] = 5e-3
    parameters["to_world"] = target
    parameters.update()
    loaded = mi.load_dict(scenes.spot(power=2 * POWER, waist_radius=5e-3, to_world=target))
    points = points_in(loaded, [5e-3, 5e-3])
    for ours, theirs in zip(events(changed, points), events(loaded, points), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_a_change_to_what_cannot_be_is_refused() -> None:
    laser = mi.load_dict(scenes.spot())
    parameters = mi.traverse(laser)
    parameters["power"] = -1.0
    with pytest.raises(RuntimeError, match="laser: power: "):
        parameters.update()


def test_a_laser_is_flagged_as_a_coherent_point() -> None:
    laser = mi.load_dict(scenes.spot())
    assert laser.flags() == int(mi.EmitterFlags.DeltaPosition) | 0x1000
    assert np.array_equal(np.array(laser.bbox().min), np.array(laser.bbox().max))
    assert "shape = spot" in str(laser)


def test_a_laser_can_be_written_in_xml() -> None:
    text = """<emitter version="3.0.0" type="laser">
      <string name="shape" value="line"/>
      <float name="wavelength" value="650e-9"/> <float name="power" value="5e-3"/>
      <float name="fan_angle" value="30"/> <float name="thickness" value="0.4e-3"/>
      <float name="focus_distance" value="0.2"/>
      <transform name="to_world">
        <lookat origin="0, 0.1, 0.1732" target="0, 0, 0" up="0, 0.866, -0.5"/>
      </transform>
    </emitter>"""
    assert str(mi.load_string(text)) == str(mi.load_dict(line()))


SPOT_ERRORS = [
    ("wavelength", 0.0),
    ("wavelength", float("nan")),
    ("power", -1.0),
    ("power", 1e60),
    ("power", "much"),
    ("waist_radius", -1e-3),
    ("waist_radius", 1e-9),
    ("waist_distance", float("inf")),
    ("m_squared", 0.5),
    ("waist_radius_y", 0.0),
    ("waist_radius_y", 1e-9),
    ("waist_distance_y", float("nan")),
    ("m_squared_y", 0.0),
    ("shape", "ring"),
    ("waist", 1e-3),
    ("fan_angle", 30.0),
    ("edge", 0.1),
]
LINE_ERRORS = [
    ("thickness", 0.0),
    ("thickness", 1e-9),
    ("fan_angle", 180.0),
    ("fan_angle", -30.0),
    ("focus_distance", float("nan")),
    ("focus_curve", "circle"),
    ("profile", "flat"),
    ("apex_offset", -1.0),
    ("m_squared", float("nan")),
    ("edge", 0.1),
    ("waist_radius", 1e-3),
]


@pytest.mark.parametrize(("name", "value"), SPOT_ERRORS)
def test_a_bad_property_of_a_spot_is_refused_by_its_name(name: str, value: object) -> None:
    with pytest.raises(RuntimeError, match=rf'(laser: {name}: |"{name}")'):
        mi.load_dict(scenes.spot() | {name: value})


@pytest.mark.parametrize(("name", "value"), LINE_ERRORS)
def test_a_bad_property_of_a_line_is_refused_by_its_name(name: str, value: object) -> None:
    with pytest.raises(RuntimeError, match=rf'(laser: {name}: |"{name}")'):
        mi.load_dict(line() | {name: value})


def test_a_powell_line_has_an_edge() -> None:
    with pytest.raises(RuntimeError, match="laser: edge: "):
        mi.load_dict(line(profile="powell", edge=2.0))


@pytest.mark.parametrize("name", ["wavelength", "power", "waist_radius"])
def test_a_missing_property_is_named(name: str) -> None:
    described = scenes.spot()
    del described[name]
    with pytest.raises(RuntimeError, match=f'"{name}"'):
        mi.load_dict(described)


def test_a_frame_that_scales_is_refused() -> None:
    with pytest.raises(RuntimeError, match="laser: to_world: must be a rotation"):
        mi.load_dict(scenes.spot(to_world=mi.ScalarTransform4f().scale(2.0)))


def test_a_colour_that_is_no_light_is_refused() -> None:
    with pytest.raises(RuntimeError, match="laser: color: "):
        mi.load_dict(scenes.spot(color={"type": "rgb", "value": [1.0, -1.0, 0.0]}))
