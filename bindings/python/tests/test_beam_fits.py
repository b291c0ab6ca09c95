"""Fits of beams against scipy.optimize.curve_fit."""

import numpy as np
import pytest
from scipy import optimize, special
from tem00 import ParameterError, beam

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]

WAVELENGTH = 1064e-9
Z = np.linspace(-0.05, 0.12, 18)


def caustic(z: Array, waist: float, position: float, divergence: float) -> Array:
    radius: Array = np.hypot(waist, divergence * (z - position))
    return radius


def measured_radii() -> Array:
    noise = np.random.default_rng(1).normal(1, 0.01, Z.size)
    return caustic(Z, 80e-6, 0.03, 6e-3) * noise


def knife(x: Array, power: float, centre: float, radius: float, floor: float = 0) -> Array:
    passed: Array = power / 2 * special.erfc(np.sqrt(2) * (x - centre) / radius)
    return passed + floor


def test_relative_errors_fit_the_logarithm() -> None:
    radii = measured_radii()
    scale = np.array([1e-4, 1e-2, 1e-3])

    def model(z: Array, *p: float) -> Array:
        return np.log(caustic(z, *(np.array(p) * scale)))

    found, covariance = optimize.curve_fit(
        model, Z, np.log(radii), p0=[0.8, 3, 6], ftol=1e-15, xtol=1e-15
    )
    fit = beam.CausticFit(WAVELENGTH, Z, radii)
    estimates = (fit.waist_radius, fit.waist_position, fit.divergence)
    # Both stop where the sum of squares is flat to rounding, half the digits.
    np.testing.assert_allclose([e.value for e in estimates], found * scale, rtol=1e-6)
    errors = np.sqrt(np.diag(covariance)) * scale
    # curve_fit differentiates by differences of 1e-8.
    np.testing.assert_allclose([e.standard_error for e in estimates], errors, rtol=1e-5)
    m_squared = np.pi * found[0] * found[2] * scale[0] * scale[2] / WAVELENGTH
    assert fit.m_squared.value == pytest.approx(m_squared, rel=1e-6)
    assert fit.rayleigh_range.value == pytest.approx(
        fit.waist_radius.value / fit.divergence.value, rel=1e-12
    )
    np.testing.assert_allclose(fit.radius_at(Z), np.exp(model(Z, *found)), rtol=1e-6)
    located = fit.beam()
    assert located.radius_at(0.0) == pytest.approx(fit.radius_at(0.0), rel=1e-12)


@pytest.mark.parametrize("known", [False, True])
def test_absolute_errors_fit_the_radius(known: bool) -> None:
    radii = measured_radii()
    scale = np.array([1e-4, 1e-2, 1e-3])
    deviations = np.linspace(1e-6, 4e-6, Z.size)

    def model(z: Array, *p: float) -> Array:
        return caustic(z, *(np.array(p) * scale)) / 1e-6

    found, covariance = optimize.curve_fit(
        model, Z, radii / 1e-6, p0=[0.8, 3, 6], ftol=1e-15, xtol=1e-15,
        sigma=deviations / 1e-6 if known else None, absolute_sigma=known,
    )
    fit = beam.CausticFit(WAVELENGTH, Z, radii, deviations if known else "equal")
    estimates = (fit.waist_radius, fit.waist_position, fit.divergence)
    np.testing.assert_allclose([e.value for e in estimates], found * scale, rtol=1e-6)
    errors = np.sqrt(np.diag(covariance)) * scale
    # Of the logarithm of a radius or of the radius itself: equal to first order in the error.
    np.testing.assert_allclose([e.standard_error for e in estimates], errors, rtol=1e-5)


@pytest.mark.parametrize("floor", [0.0, 0.3])
@pytest.mark.parametrize("sign", [1, -1])
def test_knife_edges_fit_the_error_function(floor: float, sign: int) -> None:
    x = np.linspace(0, 1.2e-3, 25)
    noise = np.random.default_rng(2).normal(0, 0.01, x.size)
    powers = knife(sign * x, 2.0, sign * 6e-4, 4e-4, floor) + noise
    start = [2.0, sign * 6.0, 4.0] + ([floor] if floor else [])

    def model(x: Array, power: float, centre: float, radius: float, *rest: float) -> Array:
        return knife(sign * x, power, centre * 1e-4, radius * 1e-4, *rest)

    found, covariance = optimize.curve_fit(model, x, powers, p0=start, ftol=1e-15, xtol=1e-15)
    fit = beam.KnifeEdgeFit(x, powers, with_background=floor != 0)
    values = [fit.power.value, sign * fit.centre.value / 1e-4, fit.radius.value / 1e-4]
    errors = [e.standard_error for e in (fit.power, fit.centre, fit.radius)]
    np.testing.assert_allclose(values, found[:3], rtol=1e-6)
    expected = np.sqrt(np.diag(covariance))[:3] * [1, 1e-4, 1e-4]
    np.testing.assert_allclose(errors, expected, rtol=1e-5)
    np.testing.assert_allclose(fit.power_at(x), model(x, *found), atol=1e-6)
    assert (fit.background is None) == (floor == 0)
    if fit.background is not None:
        assert fit.background.value == pytest.approx(found[3], rel=1e-5)


def test_data_without_a_beam_are_a_fit_error() -> None:
    with pytest.raises(beam.FitError, match="determine|converge"):
        beam.CausticFit(WAVELENGTH, [0, 1, 2, 3], [1e-3] * 4)
    with pytest.raises(beam.FitError, match="change"):
        beam.KnifeEdgeFit([0, 1, 2, 3], [1, 1, 1, 1])
    assert issubclass(beam.FitError, RuntimeError)


@pytest.mark.parametrize(
    ("parameter", "change"),
    [
        ("wavelength", {"wavelength": 0.0}),
        ("positions", {"positions": [0, 1, 2, np.nan]}),
        ("positions", {"positions": [1, 1, 1, 1]}),
        ("positions", {"positions": [1], "radii": [1]}),
        ("positions", {"positions": np.zeros((2, 2))}),
        ("radii", {"radii": [1e-3] * 5}),
        ("radii", {"radii": [1e-3, 2e-3, 0, 1e-3]}),
        ("errors", {"errors": [1e-6] * 3}),
        ("errors", {"errors": [1e-6, 1e-6, 0, 1e-6]}),
        ("errors", {"errors": "absolute"}),
    ],
)
def test_bad_data_are_refused_by_name(parameter: str, change: dict[str, object]) -> None:
    good = {
        "wavelength": WAVELENGTH,
        "positions": [0.0, 0.1, 0.2, 0.3],
        "radii": [1e-4, 2e-4, 3e-4, 4e-4],
        "errors": "relative",
    }
    with pytest.raises(ParameterError) as refusal:
        beam.CausticFit(**(good | change))  # type: ignore[arg-type]
    assert refusal.value.parameter == parameter


def test_bad_traces_are_refused_by_name() -> None:
    with pytest.raises(ParameterError) as refusal:
        beam.KnifeEdgeFit([0, 1, 2, 3], [0, 1, np.inf, 1])
    assert refusal.value.parameter == "powers"
    with pytest.raises(ParameterError) as refusal:
        beam.KnifeEdgeFit([0, 1, 2, 3], [0, 1, 2, 3], with_background=True)
    assert refusal.value.parameter == "positions"
