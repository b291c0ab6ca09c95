"""Placed lights: irradiance, next events and rays against NumPy and SciPy."""

import numpy as np
import pytest
from scipy import stats
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
    "table": beam.LineProfile.tabulated(
        beam.AngularProfile([-0.2, -0.1, 0.05, 0.2], [0.5, 1, 0.8, 0])
    ),
}


def spot() -> beam.SpotLight:
    laser = beam.GaussianBeam.from_waist(650e-9, 60e-6).with_m_squared(1.2)
    return beam.SpotLight.place(laser, 0.15, PLACEMENT, POWER)


def elliptic() -> beam.SpotLight:
    laser = beam.AstigmaticBeam.from_divergences(650e-9, (2e-3, 4e-3))
    laser = laser.with_waist_distances((0.1, 0.2)).with_rotation(0.5)
    return beam.SpotLight.place_astigmatic(laser, PLACEMENT, POWER)


def laser_line(profile: str) -> beam.LaserLine:
    fan = beam.FanGeometry(fan_angle=0.4, apex_offset=2e-3, focus_distance=0.2)
    return beam.LaserLine(beam.GaussianBeam.from_waist(650e-9, 60e-6), fan, PROFILES[profile])


def line(profile: str) -> beam.Emitter:
    placed = beam.TabulatedLineLight if profile == "table" else beam.LineLight
    return placed.place(laser_line(profile), PLACEMENT, POWER)


LIGHTS: dict[str, beam.Emitter] = {
    "spot": spot(),
    "elliptic": elliptic(),
    **{profile: line(profile) for profile in PROFILES},
}
lights = pytest.mark.parametrize("name", LIGHTS)


def world(light: beam.Emitter, local: FloatArray) -> FloatArray:
    """Return points of the frame of the light, shape (..., 3), in the world."""
    axes = np.array([light.ex, light.ey, light.ez])
    return np.asarray(light.origin + local @ axes)


def components(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    return points[..., 0], points[..., 1], points[..., 2]


def lit_points(light: beam.Emitter, count: int) -> FloatArray:
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
        assert (light.power, light.cutoff) == (POWER, 4)
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
def test_next_events_carry_the_power_to_a_tilted_plane(name: str) -> None:
    light = LIGHTS[name]
    tilt = np.deg2rad(50)
    has_ends = name.startswith("uniform") or name == "table"
    length = 0.12 if has_ends else 0.35 if name in PROFILES else 4e-3
    a, step_a = np.linspace(-length, length, 1601 if name in PROFILES else 401, retstep=True)
    b, step_b = np.linspace(-4e-3, 4e-3, 201, retstep=True)
    p, q = np.meshgrid(a, b)
    local = np.stack([p, q * np.cos(tilt), 0.25 + q * np.sin(tilt)], axis=-1)
    event = light.next_event(*components(world(light, local)))
    normal = world(light, np.array([0, np.sin(tilt), -np.cos(tilt)])) - light.origin
    irradiance = event.e_perp * np.maximum(event.wi @ normal, 0)
    power = irradiance.sum() * step_a * step_b
    # The sum over a bell is exact. Two abrupt ends fall anywhere within half a step, 1.5e-4 m, of a
    # line of 0.1 m.
    assert power == pytest.approx(POWER, rel=1.6e-3 if has_ends else 1e-5)


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
def test_sampled_rays_fall_where_the_irradiance_says(name: str) -> None:
    light = LIGHTS[name]
    count = 40_000
    rays = light.sample_ray(np.random.default_rng(5).random((count, 4)))
    np.testing.assert_array_equal(rays.flux, POWER)
    hits = rays.origin + rays.direction * (0.25 / np.asarray(rays.cos))[:, None]
    local = (hits - light.origin) @ np.array([light.ex, light.ey, light.ez]).T
    np.testing.assert_allclose(local[:, 2], 0.25, atol=1e-14)
    edges = [np.quantile(local[:, k], np.linspace(0.02, 0.98, 9)) for k in (0, 1)]
    counts, _, _ = np.histogram2d(local[:, 0], local[:, 1], bins=edges)
    fine = 60
    middles = [
        (e[:-1, None] + np.diff(e)[:, None] * (np.arange(fine) + 0.5) / fine).ravel() for e in edges
    ]
    x, y = np.meshgrid(*middles, indexing="ij")
    plane = world(light, np.stack([x, y, np.full_like(x, 0.25)], axis=-1))
    bins = light.irradiance(*components(plane)).reshape(8, fine, 8, fine).mean(axis=(1, 3))
    share = bins * np.outer(*map(np.diff, edges)) / POWER
    expected = count * share
    inside, outside = counts.sum(), count - counts.sum()
    observed = np.append(counts.ravel(), outside)
    predicted = np.append(expected.ravel(), count - expected.sum())
    assert inside > 0.8 * count
    # Edges that are quantiles of the sample itself only lower the sum; 64 degrees of freedom.
    chi2 = ((observed - predicted) ** 2 / predicted).sum()
    assert chi2 < stats.chi2.ppf(1 - 1e-3, 64)


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
def test_sampled_events_have_the_mean_of_the_next_event(name: str) -> None:
    light = LIGHTS[name]
    x, y, z = (float(c) for c in lit_points(light, 1)[0])
    u = np.random.default_rng(7).random((20_000, 2))
    drawn = light.next_event_sampled(x, y, z, u)
    event = light.next_event(x, y, z)
    assert drawn is not None and event is not None
    np.testing.assert_allclose(light.next_event_pdf(x, y, z, drawn.wi), drawn.pdf, rtol=1e-7)
    radiance = light.radiance(x, y, z, -drawn.wi)
    np.testing.assert_allclose(np.asarray(drawn.value) * drawn.pdf, radiance, rtol=1e-7)
    vector = np.asarray(drawn.value)[:, None] * drawn.wi
    mean, error = vector.mean(axis=0), vector.std(axis=0) / np.sqrt(len(u))
    # Each of three components is within 4 standard errors with a probability of 0.9999.
    assert np.all(np.abs(mean - event.e_perp * event.wi) <= 4 * error + 1e-12 * event.e_perp)


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


def test_rows_are_the_fields_in_the_order_of_memory() -> None:
    light = elliptic()
    rows = light.to_rows()
    expected = [[*light.origin, POWER], [*light.ex, 4], [*light.ey, light.wavelength], [*light.ez, 0]]
    expected += [[a.w0_sq, a.theta_sq, a.z0, 0] for a in (light.x, light.y)]
    np.testing.assert_array_equal(rows, expected)
    np.testing.assert_array_equal(light.to_rows("float32"), rows.astype(np.float32))
    fan = line("powell")
    assert isinstance(fan, beam.LineLight)
    profile = [fan.flat, fan.sigma, fan.variable, fan.mass]
    np.testing.assert_array_equal(fan.to_rows()[5], profile)
    np.testing.assert_array_equal(
        fan.to_rows()[6], [fan.half_slope, fan.focus_on_plane, fan.wavelength, 0]
    )
    assert fan.to_rows(np.float32).dtype == np.float32
    table = line("table")
    assert table.to_rows("float32").shape == (7, 4)


@pytest.mark.parametrize("name", [name for name in LIGHTS if name != "table"])
def test_rows_make_the_light_again(name: str) -> None:
    light = LIGHTS[name]
    assert isinstance(light, (beam.SpotLight, beam.LineLight))
    rows = light.to_rows()
    assert type(light).from_rows(rows) == light
    rows[1, 3] = 2
    assert type(light).from_rows(rows).cutoff == 2


def test_a_laser_line_spreads_its_power_as_its_density_says() -> None:
    theta = np.linspace(-0.5, 0.5, 20_001)
    for name in PROFILES:
        laser = laser_line(name)
        density = laser.power_per_angle(theta)
        whole = np.trapezoid(density, theta)
        tails = 1 - laser.power_between_angles(-0.5, 0.5)
        # The trapezoid errs by half a step of the density where it jumps: 2.5e-5 · 2.5 twice.
        assert whole + tails == pytest.approx(1, abs=2e-4), name
        half = np.trapezoid(density[theta <= 0.1], theta[theta <= 0.1])
        assert laser.power_between_angles(-0.5, 0.1) == pytest.approx(half, abs=2e-4), name
        z = 0.3
        edges = (z + 2e-3) * np.tan([-0.1, 0.1])
        share = laser.power_on_length(edges[0], edges[1], z)
        assert share == pytest.approx(laser.power_between_angles(-0.1, 0.1), abs=1e-12), name


def test_the_waist_of_a_line_lies_on_its_focus_curve() -> None:
    focus = beam.GaussianBeam.from_waist(650e-9, 60e-6)
    fans = (beam.FanGeometry(0.4, 2e-3, 0.2), beam.FanGeometry(0.4, 2e-3, 0.2, "equal_plane"))
    for fan, length in zip(fans, (0.202, 0.202 * np.hypot(1, 0.2)), strict=True):
        laser = beam.LaserLine(focus, fan, beam.LineProfile.gaussian_sin())
        assert laser.waist_slant_distance_at(0.2) == pytest.approx(length, rel=1e-15)
        z = length / np.hypot(1, 0.2) - 2e-3
        assert laser.half_thickness_at_angle(z, np.arctan(0.2)) == pytest.approx(60e-6, rel=1e-12)
