"""Beams, ray matrices and cross-sections against NumPy and SciPy."""

import numpy as np
import pytest
from scipy import integrate, special
from tem00 import beam

WAVELENGTH = 650e-9
# Some ten roundings of double precision.
ROUNDING = 4e-15


def round_beam(m_squared: float = 1.3) -> beam.GaussianBeam:
    return beam.GaussianBeam.from_waist(WAVELENGTH, 80e-6).with_m_squared(m_squared)


def test_radius_and_curvature_follow_from_the_complex_parameter() -> None:
    laser = round_beam()
    z_r = np.pi * 80e-6**2 / (1.3 * WAVELENGTH)
    z = np.linspace(-0.4, 0.4, 41)
    inverse = 1 / (z + 1j * z_r)
    radius = np.sqrt(1.3 * WAVELENGTH / (-np.pi * inverse.imag))
    np.testing.assert_allclose(laser.radius_at(z), radius, rtol=ROUNDING)
    np.testing.assert_allclose(laser.curvature_at(z), inverse.real, rtol=ROUNDING, atol=1e-15)
    phase = np.angle(1j * inverse)
    np.testing.assert_allclose(laser.gouy_phase_at(z), phase, rtol=ROUNDING, atol=1e-15)
    q = beam.LocatedBeam(laser, 0.1).complex_parameter
    assert q == pytest.approx(complex(-0.1, z_r), rel=ROUNDING)
    again = beam.LocatedBeam.from_complex_parameter(q, WAVELENGTH, 1.3)
    assert again.radius_at(0.0) == pytest.approx(laser.radius_at(0.1), rel=1e-13)
    assert laser.encircled_power(laser.radius_at(0.2), 0.2) == pytest.approx(
        1 - np.exp(-2), rel=1e-14
    )


def test_constants_of_a_beam_are_those_of_its_waist() -> None:
    laser = round_beam()
    z_r = np.pi * 80e-6**2 / (1.3 * WAVELENGTH)
    expected = {
        "rayleigh_range": z_r,
        "divergence": 80e-6 / z_r,
        "confocal_parameter": 2 * z_r,
        "beam_parameter_product": 1.3 * WAVELENGTH / np.pi,
    }
    for name, value in expected.items():
        assert getattr(laser, name) == pytest.approx(value, rel=ROUNDING), name
    growth = np.array([1.05, np.sqrt(2), 3])
    depth = 2 * z_r * np.sqrt(growth**2 - 1)
    np.testing.assert_allclose(laser.depth_of_focus(growth), depth, rtol=1e-14)
    assert laser.fwhm_at(0.0) == pytest.approx(np.sqrt(2 * np.log(2)) * 80e-6, rel=ROUNDING)
    assert laser.d4_sigma_at(0.0) == pytest.approx(160e-6, rel=ROUNDING)
    narrow = beam.GaussianBeam.from_divergence(WAVELENGTH, 1e-3)
    assert narrow.waist_radius == pytest.approx(WAVELENGTH / (np.pi * 1e-3), rel=ROUNDING)


def test_apertures_pass_what_error_functions_say() -> None:
    spot = beam.CrossSection((1e-3, 2e-3))
    x = np.linspace(-2e-3, 2e-3, 17)
    root = np.sqrt(2)
    np.testing.assert_allclose(
        spot.power_past_knife_edge(x), special.erfc(root * x / 1e-3) / 2, rtol=1e-11
    )
    slit = (special.erf(root * (x + 5e-4) / 1e-3) - special.erf(root * (x - 5e-4) / 1e-3)) / 2
    np.testing.assert_allclose(spot.power_in_slit(x, 1e-3), slit, rtol=1e-10, atol=1e-12)
    square = special.erf(1e-3 / root / 1e-3) * special.erf(1e-3 / root / 2e-3)
    assert spot.power_in_rectangle((0, 0), (1e-3, 1e-3)) == pytest.approx(square, rel=1e-11)
    assert spot.effective_area == pytest.approx(np.pi * 2e-6, rel=ROUNDING)
    np.testing.assert_allclose(spot.knife_edge_width, special.ndtri(0.9) * spot.radii, rtol=1e-14)


def test_a_circle_passes_the_integral_over_it() -> None:
    spot = beam.CrossSection((1e-3, 2e-3))

    def chord(x: float) -> float:
        half = np.sqrt(max(1.2e-3**2 - x**2, 0))
        profile = np.sqrt(2 / np.pi) / 1e-3 * np.exp(-2 * x**2 / 1e-6)
        return float(profile * special.erf(np.sqrt(2) * half / 2e-3))

    expected, _ = integrate.quad(chord, -1.2e-3, 1.2e-3, epsabs=1e-12)
    # The square-root ends of the chord cost the quadrature 1e-9.
    assert spot.power_in_circle(1.2e-3) == pytest.approx(expected, abs=1e-9)
    fraction = np.array([0.1, 0.5, 0.99])
    radius = spot.circle_radius(fraction)
    np.testing.assert_allclose(spot.power_in_circle(radius), fraction, atol=1e-11)


def matrix(system: beam.AbcdMatrix) -> np.ndarray:
    return np.array([[system.a, system.b], [system.c, system.d]])


def test_systems_multiply_as_matrices_do() -> None:
    lens = beam.AbcdMatrix.thick_lens(1.5, 20.0, -10.0, 5e-3)
    surfaces = [
        np.array([[1, 0], [-(1.5 - 1) / 1.5 * 20, 1 / 1.5]]),
        np.array([[1, 5e-3], [0, 1]]),
        np.array([[1, 0], [-(1 - 1.5) / 1 * -10, 1.5]]),
    ]
    np.testing.assert_allclose(matrix(lens), surfaces[2] @ surfaces[1] @ surfaces[0], rtol=1e-14)
    space = beam.AbcdMatrix.free_space(0.3)
    both = space.then(lens)
    np.testing.assert_allclose(matrix(both), matrix(lens) @ matrix(space), rtol=1e-14)
    rays = np.random.default_rng(2).normal(size=(4, 5, 2))
    np.testing.assert_allclose(
        both.transform_ray(rays), rays @ matrix(both).T, rtol=1e-13, atol=1e-15
    )
    grin = matrix(beam.AbcdMatrix.grin(300.0, 4e-3))
    sin, cos = np.sin(1.2), np.cos(1.2)
    np.testing.assert_allclose(grin, [[cos, sin / 300], [-300 * sin, cos]], rtol=1e-14)


def test_a_beam_passes_a_system_by_the_law_of_its_complex_parameter() -> None:
    system = beam.AbcdMatrix.free_space(0.3).then(beam.AbcdMatrix.thin_lens(0.12))
    before = beam.LocatedBeam(round_beam(), 0.05)
    q = before.complex_parameter
    expected = (system.a * q + system.b) / (system.c * q + system.d)
    after = system.transform(before)
    assert after.complex_parameter == pytest.approx(expected, rel=1e-13)
    parameter = system.transform_parameter(before.complex_parameter)
    assert parameter == pytest.approx(expected, rel=1e-13)
    assert after.beam.m_squared == 1.3
    lens = before.through_lens(0.12)
    assert lens.complex_parameter == pytest.approx(1 / (1 / q - 1 / 0.12), rel=1e-13)


def test_the_eigenmode_of_a_resonator_is_the_fixed_point_of_its_round_trip() -> None:
    arm = beam.AbcdMatrix.free_space(0.3)
    trip = arm.then(beam.AbcdMatrix.curved_mirror(1.0)).then(arm)
    assert trip.is_stable
    assert trip.half_trace == pytest.approx(2 * (1 - 0.3) - 1, rel=1e-14)
    q = trip.eigenmode()
    assert (trip.a * q + trip.b) / (trip.c * q + trip.d) == pytest.approx(q, rel=1e-13)


def test_an_elliptic_beam_is_the_product_of_two() -> None:
    x, y = (beam.LocatedBeam(round_beam(m), d) for m, d in ((1.0, 0.1), (1.6, 0.14)))
    laser = beam.AstigmaticBeam(x, y).with_rotation(0.4)
    wx, wy = x.radius_at(0.2), y.radius_at(0.2)
    p, q = 3e-4, -2e-4
    u, v = p * np.cos(0.4) + q * np.sin(0.4), q * np.cos(0.4) - p * np.sin(0.4)
    expected = 2 / (np.pi * wx * wy) * np.exp(-2 * (u / wx) ** 2 - 2 * (v / wy) ** 2)
    assert laser.irradiance_per_watt(p, q, 0.2) == pytest.approx(expected, rel=1e-13)
    assert laser.ellipticity_at(0.2) == pytest.approx(min(wx, wy) / max(wx, wy), rel=ROUNDING)
    for plane in laser.circular_planes:
        if plane is not None:
            assert laser.ellipticity_at(plane) == pytest.approx(1, abs=1e-12)
    assert laser.circular_planes[0] is not None
