"""Placed lights: irradiance, next events and rays against NumPy and SciPy."""

import numpy as np
import pytest
from tem00 import beam

FloatArray = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

POWER = 5e-3
ORIGIN = np.array([0.1, -0.2, 0.3])
DIRECTION = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
PLACEMENT = beam.Placement(origin=ORIGIN, direction=DIRECTION, fan_axis=(1, 0.2, 0.1))
PROFILES = {
    "gaussian_tan": beam.LineProfile.gaussian_tan(),
    "gaussian_angle": beam.LineProfile.gaussian_angle(),
    "gaussian_sin": beam.LineProfile.gaussian_sin(),
    "uniform_tan": beam.LineProfile.uniform_tan(),
    "uniform_angle": beam.LineProfile.uniform_angle(),
    "powell": beam.LineProfile.powell(0.1),
    "table": beam.LineProfile.tabulated([-0.2, -0.1, 0.05, 0.2], [0.5, 1, 0.8, 0]),
}


def spot() -> beam.Light:
    laser = beam.GaussianBeam.from_waist(650e-9, 60e-6).with_m_squared(1.2)
    return beam.Light.spot(laser, 0.15, PLACEMENT, POWER)


def elliptic() -> beam.Light:
    laser = beam.AstigmaticBeam.from_divergences(650e-9, (2e-3, 4e-3))
    laser = laser.with_waist_distances((0.1, 0.2)).with_rotation(0.5)
    return beam.Light.elliptic(laser, PLACEMENT, POWER)


def laser_line(profile: str) -> beam.LaserLine:
    fan = beam.FanGeometry(fan_angle=0.4, apex_offset=2e-3, focus_distance=0.2)
    return beam.LaserLine(beam.GaussianBeam.from_waist(650e-9, 60e-6), fan, PROFILES[profile])


def line(profile: str) -> beam.Light:
    return beam.Light.line(laser_line(profile), PLACEMENT, POWER)


LIGHTS: dict[str, beam.Light] = {
    "spot": spot(),
    "elliptic": elliptic(),
    **{profile: line(profile) for profile in PROFILES},
}
lights = pytest.mark.parametrize("name", LIGHTS)


def world(light: beam.Light, local: FloatArray) -> FloatArray:
    """Return points of the frame of the light, shape (..., 3), in the world."""
    axes = np.array([light.ex, light.ey, light.ez])
    return np.asarray(light.origin + local @ axes)


def components(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    return points[..., 0], points[..., 1], points[..., 2]


def lit_points(light: beam.Light, count: int) -> FloatArray:
    """Return points on rays of the light, about 0.25 m away."""
    random = np.random.default_rng(3)
    rays = light.sample_ray(random.random((count, 4)))
    z = random.uniform(0.1, 0.4, (count, 1))
    return np.asarray(rays.origin + rays.direction * (z / np.asarray(rays.cos)[..., None]))


def test_the_frame_is_the_placement() -> None:
    for light in LIGHTS.values():
        axes = np.array([light.ex, light.ey, light.ez])
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
        np.testing.assert_allclose(light.ez, DIRECTION, atol=1e-15)
        np.testing.assert_array_equal(light.origin, ORIGIN)
        assert light.power == POWER
        rows = light.to_rows()
        assert rows.dtype == np.float32
        assert (rows.shape[1], rows[1, 3]) == (4, 4)
        np.testing.assert_allclose(
            rows[:4, :3], [light.origin, light.ex, light.ey, light.ez], rtol=1e-7
        )
    assert abs(np.cross(DIRECTION, (1, 0.2, 0.1)) @ line("table").ex) < 1e-15


def test_a_spot_has_the_irradiance_of_its_beam() -> None:
    light = spot()
    laser = beam.GaussianBeam.from_waist(650e-9, 60e-6).with_m_squared(1.2)
    local = np.random.default_rng(4).uniform((-4e-4, -4e-4, 0), (4e-4, 4e-4, 0.4), (1000, 3))
    r = np.hypot(local[:, 0], local[:, 1])
    expected = POWER * laser.irradiance_per_watt(r, local[:, 2] - 0.15)
    expected[r > 4 * laser.radius_at(local[:, 2] - 0.15)] = 0
    got = light.irradiance(*components(world(light, local)))
    # Rotation rounds positions by 2e-16; at four radii that changes ln E by 16 · 2e-16 / 60e-6.
    np.testing.assert_allclose(got, expected, rtol=1e-10, atol=1e-30)


@lights
def test_next_events_point_along_the_energy_flow(name: str) -> None:
    light = LIGHTS[name]
    points = lit_points(light, 500)
    event = light.next_event(*components(points))
    flux = light.flux(*components(points))
    lit = np.asarray(event.e_perp) > 0
    assert lit.mean() > 0.9
    np.testing.assert_allclose(event.e_perp, np.linalg.norm(flux, axis=-1), rtol=1e-12)
    unit = -flux[lit] / np.linalg.norm(flux[lit], axis=-1)[:, None]
    np.testing.assert_allclose(event.wi[lit], unit, atol=1e-12)
    on_plane = (event.point[lit] - light.origin) @ light.ez
    # Points half a metre away are rounded by 1e-16, times the few products of the frame.
    np.testing.assert_allclose(on_plane, 0, atol=1e-15)
    np.testing.assert_array_equal(event.wi[~lit], 0)
    np.testing.assert_array_equal(event.point[~lit], 0)


@lights
def test_densities_and_radiance_of_rays_agree(name: str) -> None:
    light = LIGHTS[name]
    rays = light.sample_ray(np.random.default_rng(6).random((300, 4)))
    further = components(rays.origin + 0.2 * rays.direction)
    pdf = light.ray_pdf(*further, rays.direction)
    # The source of a line is a micrometre wide: points at 0.5 m are rounded by 1e-16 of it, and a
    # density at five deviations changes by 5 · 1e-16 / 3e-7.
    for member in (
        "position",
        "direction_given_position",
        "direction",
        "position_given_direction",
    ):
        drawn = getattr(rays.pdf, member)
        np.testing.assert_allclose(getattr(pdf, member), drawn, rtol=1e-7, err_msg=member)
    joint = np.asarray(pdf.position) * np.asarray(pdf.direction_given_position)
    other = np.asarray(pdf.direction) * np.asarray(pdf.position_given_direction)
    np.testing.assert_allclose(joint, other, rtol=1e-11)
    radiance = light.radiance(*further, rays.direction)
    np.testing.assert_allclose(radiance, POWER * other / np.asarray(rays.cos), rtol=1e-12)
    x, y, z = further
    np.testing.assert_array_equal(light.radiance(x, y, z, -rays.direction), 0)


@lights
def test_bounds_hold_all_light(name: str) -> None:
    light = LIGHTS[name]
    bounds = light.bounds(0.4)
    points = lit_points(light, 2000)
    event = light.next_event(*components(points))
    lit = np.asarray(event.e_perp) > 0
    assert np.all((points[lit] >= bounds.min) & (points[lit] <= bounds.max))
    assert np.all(-event.wi[lit] @ bounds.axis >= np.cos(bounds.half_angle) - 1e-12)


@lights
def test_single_points_have_the_bits_of_arrays(name: str) -> None:
    light = LIGHTS[name]
    points = lit_points(light, 200)
    points[::7] += 1.0
    x, y, z = components(points)
    event = light.next_event(x, y, z)
    irradiance = light.irradiance(x, y, z)
    u = np.random.default_rng(8).random((200, 2))
    sampled = light.next_event_sampled(x, y, z, u)
    assert sampled is not None
    for i, point in enumerate(points):
        a, b, c = (float(coordinate) for coordinate in point)
        assert light.irradiance(a, b, c) == irradiance[i]
        single, drawn = light.next_event(a, b, c), light.next_event_sampled(a, b, c, u[i])
        if single is None or drawn is None:
            assert single is None and drawn is None
            assert np.asarray(event.e_perp)[i] == 0 == np.asarray(sampled.value)[i]
            continue
        for member in ("point", "distance", "wi", "e_perp"):
            assert np.array_equal(getattr(single, member), getattr(event, member)[i]), member
        for member in ("point", "distance", "wi", "value", "pdf"):
            assert np.array_equal(getattr(drawn, member), getattr(sampled, member)[i]), member


@lights
def test_rays_towards_the_light_hit_it(name: str) -> None:
    light = LIGHTS[name]
    x, y, z = (float(c) for c in lit_points(light, 1)[0])
    drawn = light.next_event_sampled(x, y, z, np.random.default_rng(9).random((100, 2)))
    assert drawn is not None
    hit = light.hit(x, y, z, drawn.wi)
    assert hit is not None
    np.testing.assert_allclose(hit.pdf, drawn.pdf, rtol=1e-7)
    np.testing.assert_allclose(hit.radiance, np.asarray(drawn.value) * drawn.pdf, rtol=1e-7)
    np.testing.assert_allclose(hit.point, drawn.point, rtol=0, atol=1e-15)
    assert light.hit(x, y, z, -drawn.wi[0]) is None
    away = light.hit(x, y, z, -drawn.wi)
    assert away is not None and not np.any(away.radiance)


@lights
def test_a_box_has_all_of_the_power_or_some_or_none(name: str) -> None:
    light = LIGHTS[name]
    point = np.array(lit_points(light, 1)[0])
    behind = light.origin - 0.1 * light.ez
    centres = np.array([point, point, behind])
    sides = np.array([[10.0], [1e-6], [1e-6]])
    whole, some, none = np.asarray(light.power_bound(centres - sides, centres + sides))
    assert none == 0 < some < whole <= POWER == light.power
    np.testing.assert_allclose(whole, POWER, rtol=1e-5)
