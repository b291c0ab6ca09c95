"""The formulas as printed, and the size of their errors."""

import numpy as np
import pytest
from scipy import special
from tem00 import beam
from tem00.beam import paper

LASER = beam.GaussianBeam.from_waist(650e-9, 50e-6)
PLACEMENT = beam.Placement((0, 0, 0), (0, 0, 1), (1, 0, 0))


def test_cones_leave_out_what_lies_beyond() -> None:
    fraction = np.array([0.5, np.exp(-2), 1e-4])
    angle = paper.modified_divergence(LASER, fraction)
    np.testing.assert_allclose(np.exp(-2 * (angle / LASER.divergence) ** 2), fraction, rtol=1e-13)
    np.testing.assert_array_equal(paper.lost_by_cone(fraction), fraction)
    wedge = special.erfc(np.sqrt(2) * angle / LASER.divergence)
    np.testing.assert_allclose(paper.lost_by_fan_cone(fraction), wedge, rtol=1e-12)


def test_the_printed_radiance_divides_by_the_cosine() -> None:
    assert paper.radiance(100.0, 0.5) == 200
    assert paper.radiance(100.0, -0.5) is None
    np.testing.assert_array_equal(paper.radiance(100.0, [0.5, 0, -1]), [200, 0, 0])
    light = beam.SpotLight.place(LASER, 0.1, PLACEMENT, 2e-3)
    n = np.array([0.6, 0, -0.8])
    printed = paper.spot_next_event(light, 1e-4, 2e-4, 0.15, n)
    assert printed is not None
    ratio = LASER.radius_at(-0.1) / LASER.radius_at(0.05)
    # The receiver's distances are rounded by 1e-17 m of 1e-4 m.
    np.testing.assert_allclose(printed.point, [1e-4 * ratio, 2e-4 * ratio, 0], rtol=1e-13)
    aperture = paper.streamline_point(LASER, 1e-4, 2e-4, 0.05, -0.1)
    np.testing.assert_allclose(aperture, [1e-4 * ratio, 2e-4 * ratio, -0.1], rtol=1e-13)
    cosine = printed.wi @ n
    assert printed.radiance * cosine == pytest.approx(light.irradiance(1e-4, 2e-4, 0.15), rel=1e-12)
    many = paper.spot_next_event(light, [1e-4, 1e-4], 2e-4, 0.15, np.stack([n, -n]))
    assert many is not None
    np.testing.assert_array_equal(many.radiance, [printed.radiance, 0])


def test_the_printed_fan_has_the_power_it_states() -> None:
    fan = paper.PrintedFan(LASER, 0.5, 0.2)
    x, step_x = np.linspace(-0.3, 0.3, 801, retstep=True)
    y, step_y = np.linspace(-5e-3, 5e-3, 801, retstep=True)
    plane = fan.irradiance_per_watt(x[:, None], y, 0.3)
    # The sum over a bell is exact to rounding.
    assert plane.sum() * step_x * step_y == pytest.approx(fan.power_per_watt(0.3), rel=1e-9)
    w = LASER.radius_at(0.1)
    assert fan.power_per_watt(0.3) == pytest.approx(np.tan(0.25) * 0.3 / w, rel=1e-14)
    line = beam.LaserLine(
        LASER, beam.FanGeometry(0.5, 2e-3, 0.2), beam.LineProfile.gaussian_tan()
    )
    light = beam.LineLight.place(line, PLACEMENT, 2e-3)
    printed = paper.line_next_event(light, 0.01, 1e-4, 0.3, [0, 0, -1])
    assert printed is not None
    expected = 2e-3 * fan.irradiance_per_watt(0.01, 1e-4, 0.3)
    assert -printed.radiance * printed.wi[2] == pytest.approx(expected, rel=1e-12)


def test_the_printed_sampler_fills_disc_and_cone() -> None:
    sampler = paper.DiscConeSampler(LASER, 0.1, 1e-2)
    rays = sampler.sample(np.random.default_rng(1).random((20_000, 4)))
    radius = np.hypot(rays.origin[:, 0], rays.origin[:, 1])
    assert sampler.aperture_radius == LASER.radius_at(0.1)
    area = np.pi * sampler.aperture_radius**2
    np.testing.assert_allclose(np.asarray(rays.pdf_position) * area, 1, rtol=1e-14)
    solid = 2 * np.pi * (1 - np.cos(sampler.half_angle))
    # 1 - cos of 8e-3 rad loses four digits in NumPy.
    np.testing.assert_allclose(np.asarray(rays.pdf_direction) * solid, 1, rtol=1e-10)
    drop = 1 - rays.direction[:, 2]
    for uniform in ((radius / sampler.aperture_radius) ** 2, drop * 2 * np.pi / solid):
        # The mean of 20 000 uniform variates is within 4 standard errors, at odds of 1 to 16 000.
        assert abs(uniform.mean() - 0.5) < 4 / np.sqrt(12 * 20_000)
