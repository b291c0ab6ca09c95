"""Closed forms against SciPy: distributions, Bessel functions, quadrature."""

import math
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import pytest
import tem00
from scipy import integrate, special
from scipy import stats as scipy_stats
from tem00 import statistics as st
from tem00._typing import FloatArray

INTENSITIES = np.concatenate([[0.0, 1e-9, 1e-3], np.linspace(0.05, 12.0, 60)])


class Law(Protocol):
    """A law of the intensity."""

    def density(self, intensity: FloatArray) -> FloatArray: ...
    def cumulative(self, intensity: FloatArray) -> FloatArray: ...


def check(law: Law, scipy_law: Any, tolerance: float) -> None:
    """Compare a law with SciPy's, in absolute terms."""
    # SciPy has no non-central density at 0 itself.
    bright = INTENSITIES[1:]
    np.testing.assert_allclose(
        law.density(bright), scipy_law.pdf(bright), atol=tolerance, rtol=0
    )
    np.testing.assert_allclose(
        law.cumulative(INTENSITIES), scipy_law.cdf(INTENSITIES), atol=tolerance, rtol=0
    )


def test_speckle_has_the_exponential_law() -> None:
    law = scipy_stats.expon()
    # Both are one exponential: a few ulp of 1.
    np.testing.assert_allclose(
        st.exponential_density(INTENSITIES), law.pdf(INTENSITIES), atol=1e-15
    )
    np.testing.assert_allclose(
        st.exponential_cumulative(INTENSITIES), law.cdf(INTENSITIES), atol=1e-15
    )


@pytest.mark.parametrize("shape", [1.0, 1.5, 4.0, 37.0, 1e3])
def test_averaged_speckle_has_the_gamma_law(shape: float) -> None:
    # M ln M is good to an ulp of itself: 1e3 · 7 · 2e-16 · the density of 13.
    check(st.GammaIntensity(shape), scipy_stats.gamma(shape, scale=1 / shape), 1e-10)


@pytest.mark.parametrize("degree", [0.2, 0.5, 0.9])
def test_polarised_parts_add_up_to_their_hypoexponential_law(degree: float) -> None:
    law = st.PartiallyPolarised(degree)
    means = [(1 + degree) / 2, (1 - degree) / 2]
    expected = sum(
        sign * np.exp(-INTENSITIES / mean) for sign, mean in zip((1, -1), means)
    ) / (means[0] - means[1])
    # Cancellation of two terms of the size 1/degree.
    np.testing.assert_allclose(law.density(INTENSITIES), expected, atol=1e-14)
    np.testing.assert_allclose(
        st.IncoherentSum(means).density(INTENSITIES), expected, atol=1e-14
    )


def test_equal_patterns_add_up_to_a_gamma_law() -> None:
    check(st.IncoherentSum([3.0] * 5), scipy_stats.gamma(5, scale=1 / 5), 1e-12)


@pytest.mark.parametrize("beam_ratio", [0.0, 0.5, 4.0, 50.0])
def test_speckle_on_a_background_has_a_non_central_chi_squared_law(beam_ratio: float) -> None:
    # |√r + gaussian|²: twice its value, in means of the speckle, has two degrees of freedom.
    scale = 1 / (2 * (1 + beam_ratio))
    law = scipy_stats.ncx2(2, 2 * beam_ratio, scale=scale)
    check(st.CoherentBackground(beam_ratio), law, 1e-9)


def test_a_phasor_sum_has_the_moments_of_drawn_phasors() -> None:
    count = 9
    random = np.random.default_rng(3)
    phases = random.uniform(0, 2 * np.pi, size=(count, 400_000))
    intensity = np.abs(np.exp(1j * phases).sum(axis=0)) ** 2 / count
    for order in (1, 2, 3):
        moments = intensity**order
        error = moments.std() / math.sqrt(moments.size)
        # Four standard errors: α = 6e-5.
        assert abs(moments.mean() - st.moment_of_phasor_sum(count, order)) < 4 * error
    law = st.PhasorSum(count)
    assert scipy_stats.kstest(intensity[:2_000], law.cumulative).pvalue > 1e-3


@pytest.mark.parametrize("correlation", [0.0, 0.4, 0.95])
def test_two_correlated_intensities_have_a_non_central_chi_squared_law(correlation: float) -> None:
    law = st.JointIntensity(correlation)
    share = 1 - correlation**2
    for given in (0.0, 0.7, 5.0):
        noncentrality = 2 * correlation**2 * given / share
        scipy_law = scipy_stats.ncx2(2, noncentrality, scale=share / 2)
        # SciPy has no non-central density at 0 itself.
        bright = INTENSITIES[1:]
        np.testing.assert_allclose(
            law.conditional_density(bright, given), scipy_law.pdf(bright), atol=1e-9
        )
        np.testing.assert_allclose(
            law.conditional_cumulative(INTENSITIES, given), scipy_law.cdf(INTENSITIES), atol=1e-9
        )
        mean, variance = law.conditional_mean(given), law.conditional_variance(given)
        assert math.isclose(mean, scipy_law.mean(), rel_tol=1e-12)
        assert math.isclose(variance, scipy_law.var(), rel_tol=1e-12)
    joint = law.density((0.3, INTENSITIES))
    expected = math.exp(-0.3) * law.conditional_density(INTENSITIES, 0.3)
    np.testing.assert_allclose(joint, expected, rtol=1e-14)


def overlap(shift: FloatArray | float) -> FloatArray:
    """Fraction of a disc of diameter 1 that its displaced copy covers, from SciPy's quadrature."""
    def of(s: float) -> float:
        if abs(s) >= 1:
            return 0.0
        chord = lambda x: 2 * math.sqrt(max(0.0, 1 - x * x))
        return 2 / math.pi * integrate.quad(chord, abs(s), 1, epsabs=1e-12)[0]

    return np.asarray(np.vectorize(of)(shift), dtype=np.float64)


def airy(r: FloatArray) -> FloatArray:
    """Return [2 J₁(πr) / πr]² by SciPy."""
    x = np.pi * np.maximum(np.asarray(r), 1e-12)
    return (2 * special.j1(x) / x) ** 2


def test_the_autocovariance_is_that_of_an_airy_disc() -> None:
    lags = np.linspace(0, 20, 401)
    # SciPy's J₁ is good to some 1e-16.
    np.testing.assert_allclose(st.airy_autocovariance(lags), airy(lags), atol=1e-14)
    assert airy(np.array(st.AIRY_FIRST_ZERO)) < 1e-30
    assert math.isclose(float(airy(np.array(st.AIRY_HALF_WIDTH))), 0.5, rel_tol=1e-12)
    frequencies = np.array([0.0, 0.2, 0.5, 0.99, 1.0, 1.5])
    # The chord has a root at the end, where the quadrature is good to 1e-9.
    np.testing.assert_allclose(
        st.airy_power_spectrum(frequencies), 4 / np.pi * overlap(frequencies), atol=1e-8
    )


@pytest.mark.parametrize("size", [(0.5, 0.5), (1.0, 1.0), (2.0, 2.0), (1.0, 2.0), (0.3, 3.0)])
def test_the_contrast_of_pixels_is_a_double_integral(size: tuple[float, float]) -> None:
    def integrand(y: float, x: float) -> float:
        r = np.array(math.hypot(size[0] * x, size[1] * y))
        return float(4 * (1 - x) * (1 - y) * airy(r))

    squared, error = integrate.dblquad(integrand, 0, 1, 0, 1, epsabs=1e-9)
    contrast = st.rectangular_pixel_contrast(size)
    assert error < 1e-7
    assert abs(contrast**2 - squared) < 1e-7
    if size[0] == size[1]:
        assert abs(st.pixel_contrast(size[0]) - contrast) < 1e-8


@pytest.mark.parametrize("row_height", [0.0, 0.5, 3.0])
def test_the_noise_of_lines_is_an_integral(row_height: float) -> None:
    def spectrum(f: float) -> float:
        return float(8 / np.pi * overlap(f) * np.sinc(row_height * f) ** 2)

    length = integrate.quad(spectrum, 0, 1, limit=200)[0]
    # The nested quadrature of the overlap is good to 1e-7.
    assert abs(st.speckle_length(row_height) - length) < 1e-6
    radii = np.array([0.5, 2.0, 16.0])
    law = np.sqrt(radii * length / (8 * math.sqrt(np.pi)))
    np.testing.assert_allclose(st.line_centroid_deviation(radii, row_height), law, rtol=1e-6)
    # What a lens images joins the law as the cube of the width: 0.9 % are missing at 1.
    imaged = st.imaged_line_centroid_deviation(radii, row_height) / law
    np.testing.assert_allclose(imaged[1:], 1.0, atol=0.002)
    assert 0.9 < imaged[0] < 0.96


def test_wide_spots_scatter_by_the_pupil_alone() -> None:
    # Next are h/w of a Gaussian and ln(a)/a of a disc.
    assert abs(st.gaussian_spot_centroid_deviation(1e4) - 1 / (np.pi * math.sqrt(2))) < 1e-4
    assert abs(st.disc_spot_centroid_deviation(1e5) - 1 / np.pi) < 1e-4


@pytest.mark.parametrize("amount", [0.3, 1.0, 2.5])
def test_the_contrast_of_exposures_and_filters_is_an_integral(amount: float) -> None:
    def exposure(gamma: Callable[[float], float]) -> float:
        return math.sqrt(integrate.quad(lambda t: 2 * (1 - t) * gamma(t), 0, 1, limit=200)[0])

    boiling = exposure(lambda t: float(overlap(t * amount)) ** 2)
    moving = exposure(lambda t: float(airy(np.array(t * amount))))
    # The nested quadrature of the overlap is good to 1e-7.
    assert abs(st.boiling_contrast(amount) - boiling) < 1e-6
    assert abs(st.translation_contrast(amount) - moving) < 1e-9
    assert abs(st.contrast_of_exposure(lambda t: float(airy(np.array(t * amount)))) - moving) < 1e-9
    weighed = lambda q: q * float(overlap(q)) * math.exp(-((2 * math.pi * amount * q) ** 2))
    filtered = math.sqrt(8 * integrate.quad(weighed, 0, 1, limit=200)[0])
    assert abs(st.gaussian_filter_contrast(amount) - filtered) < 1e-6


def test_objective_speckle_is_the_transform_of_the_lit_area() -> None:
    wavelength, distance = 650e-9, 2.0
    lags = np.linspace(0, 3e-3, 7)
    spot = st.ObjectiveSpeckle(wavelength, distance, st.LitArea.gaussian_spot(0.5e-3))
    w = 0.5e-3
    expected = []
    for lag in lags:
        wave = lambda x, lag=lag: math.exp(-2 * x * x / w**2) * math.cos(
            2 * math.pi * x * lag / (wavelength * distance)
        )
        field = integrate.quad(wave, -4 * w, 4 * w, epsabs=1e-16, limit=200)[0]
        expected.append((field / (w * math.sqrt(math.pi / 2))) ** 2)
    # exp(−32) of the light lies beyond four radii.
    np.testing.assert_allclose(spot.autocovariance((lags, 0.0)), expected, atol=1e-10)
    sheet = st.ObjectiveSpeckle(wavelength, distance, st.LitArea.rectangle(1e-3, 2e-3))
    # NumPy's sinc has the factor π.
    across = np.sinc(lags / 1.3e-3) ** 2 * np.sinc(lags / 0.65e-3) ** 2
    np.testing.assert_allclose(sheet.autocovariance((lags, lags)), across, atol=1e-14)
    assert np.allclose(sheet.size, (1.3e-3, 0.65e-3), rtol=1e-14)


def test_levels_and_sizes_follow_their_formulas() -> None:
    x = np.array([0.1, 0.5, 2.0])
    expected = np.sqrt(np.pi * x) / 2 * np.exp(-x)
    np.testing.assert_allclose(st.level_crossings(x), expected, rtol=1e-14)
    np.testing.assert_allclose(st.area_fraction_above(x), scipy_stats.expon.sf(x), rtol=1e-14)
    assert math.isclose(st.SPECKLE_DENSITY * st.COHERENCE_AREA, 1.0)
    kappa = integrate.quad(lambda q: float(overlap(q)) ** 2 * q, 0, 1)[0]
    spread = 8 / math.pi * math.sqrt(2 * math.pi * kappa) / 32
    assert math.isclose(st.contrast_squared_spread(32.0), spread, rel_tol=1e-6)
    assert st.size_before_pixels(0.9) is None
    assert math.isclose(st.contrast_of_phasor_sum(5), math.sqrt(0.8))


SPECKLE = (650e-9, 1.0)
REFUSALS: list[tuple[Callable[[], object], str]] = [
    (lambda: st.GammaIntensity(0.5), "shape"),
    (lambda: st.GammaIntensity.from_contrast(math.nan), "contrast"),
    (lambda: st.PartiallyPolarised(1.5), "degree"),
    (lambda: st.IncoherentSum([1.0, -1.0]), "weights"),
    (lambda: st.IncoherentSum([]), "weights"),
    (lambda: st.CoherentBackground(-1.0), "beam_ratio"),
    (lambda: st.CoherentBackground.from_contrast(2.0), "contrast"),
    (lambda: st.PhasorSum(3), "count"),
    (lambda: st.PhasorSum(-3), "count"),
    (lambda: st.contrast_of_phasor_sum(0), "count"),
    (lambda: st.moment_of_phasor_sum(0, 1), "count"),
    (lambda: st.moment_of_phasor_sum(4, 21), "order"),
    (lambda: st.JointIntensity(1.0), "amplitude_correlation"),
    (lambda: st.JointIntensity(0.5).moment((2, 21)), "orders"),
    (lambda: st.ObjectiveSpeckle(0.0, 1.0, st.LitArea.disc(1.0)), "wavelength"),
    (lambda: st.ObjectiveSpeckle(650e-9, math.inf, st.LitArea.disc(1.0)), "distance"),
    (lambda: st.LitArea.rectangle(1.0, 0.0), "height"),
    (lambda: st.contrast_squared_spread(0.0), "speckles_across"),
    (lambda: st.contrast_squared_spread([1.0, -1.0]), "speckles_across"),
    (lambda: st.size_before_pixels(math.nan), "measured"),
    (lambda: st.contrast_of_exposure(lambda t: 2.0), "correlation"),
    (lambda: st.contrast_of_exposure(lambda t: math.nan), "correlation"),
]


@pytest.mark.parametrize(("call", "parameter"), REFUSALS)
def test_a_refusal_names_the_parameter(call: Callable[[], object], parameter: str) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        call()
    assert caught.value.parameter == parameter


def test_an_error_in_a_callback_is_that_of_the_call() -> None:
    def fails(t: float) -> float:
        raise RuntimeError("no correlation")

    with pytest.raises(RuntimeError, match="no correlation"):
        st.contrast_of_exposure(fails)
