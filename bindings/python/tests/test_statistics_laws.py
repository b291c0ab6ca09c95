"""Closed forms: distributions against SciPy, values, refusals."""

import math
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import pytest
import tem00
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


@pytest.mark.parametrize("beam_ratio", [0.0, 0.5, 4.0, 50.0])
def test_speckle_on_a_background_has_a_non_central_chi_squared_law(beam_ratio: float) -> None:
    # |√r + gaussian|²: twice its value, in means of the speckle, has two degrees of freedom.
    scale = 1 / (2 * (1 + beam_ratio))
    law = scipy_stats.ncx2(2, 2 * beam_ratio, scale=scale)
    check(st.CoherentBackground(beam_ratio), law, 1e-9)


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
    joint = law.density(0.3, INTENSITIES)
    expected = math.exp(-0.3) * law.conditional_density(INTENSITIES, 0.3)
    np.testing.assert_allclose(joint, expected, rtol=1e-14)


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (st.PartiallyPolarised(0.0).density(2.0), 8 * math.exp(-4)),
        (st.IncoherentSum([3.0] * 5).contrast, 1 / math.sqrt(5)),
        (st.PhasorSum(20).contrast, math.sqrt(0.95)),
        (st.moment_of_phasor_sum(5, 2), 1.8),
        (st.CoherentBackground.from_contrast(0.6).contrast, 0.6),
        (st.JointIntensity(0.6).intensity_correlation, 0.36),
        (st.JointIntensity(0.6).moment((1, 1)), 1.36),
        (st.exponential_cumulative(math.log(4)), 0.75),
        (st.area_fraction_above(2.0), math.exp(-2)),
        (st.level_crossings(0.5), math.sqrt(math.pi * 0.5) / 2 * math.exp(-0.5)),
        (st.airy_power_spectrum(0.0), 4 / math.pi),
        (st.airy_autocovariance(st.AIRY_HALF_WIDTH), 0.5),
        (st.SPECKLE_DENSITY * st.COHERENCE_AREA, 1.0),
        (st.contrast_of_exposure(lambda t: 1 - t), math.sqrt(2 / 3)),
        (st.boiling_contrast(0.0), 1.0),
        (st.rectangular_pixel_contrast(1.0, 1.0), st.pixel_contrast(1.0)),
        (
            st.ObjectiveSpeckle.rectangle(650e-9, 2.0, 1e-3, 2e-3).autocovariance(0.65e-3, 0.0),
            4 / math.pi**2,
        ),
        (st.ObjectiveSpeckle.disc(650e-9, 2.0, 1e-3).size[0], 1.3e-3),
    ],
)
def test_closed_forms_have_their_values(found: float, expected: float) -> None:
    # Quadratures of the crate are good to 1e-9.
    assert math.isclose(found, expected, rel_tol=1e-8)


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        # Printed digits of the Rust crate, of independent quadratures there.
        (lambda: st.pixel_contrast(1.0), 0.7112),
        (lambda: st.boiling_contrast(1.0), 0.6557),
        (lambda: st.translation_contrast(1.0), 0.8461),
        (lambda: st.gaussian_filter_contrast(0.5), 0.5134),
        (lambda: st.speckle_length(1.0), 0.763677),
        (
            lambda: st.line_centroid_deviation(2.0, 1.0),
            math.sqrt(2 * 0.763677 / (8 * math.sqrt(math.pi))),
        ),
        (
            lambda: st.imaged_line_centroid_deviation(32.0, 0.0),
            math.sqrt(32 * 1.08076 / (8 * math.sqrt(math.pi))),
        ),
        (lambda: st.gaussian_spot_centroid_deviation(1e4), 1 / (math.pi * math.sqrt(2))),
        (lambda: st.disc_spot_centroid_deviation(1e5), 1 / math.pi),
    ],
)
def test_contrasts_and_noise_are_those_of_the_crate(
    function: Callable[[], float], expected: float
) -> None:
    assert abs(function() / expected - 1) < 2e-4


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
    (lambda: st.moment_of_phasor_sum(0, 1), "count"),
    (lambda: st.moment_of_phasor_sum(4, 21), "order"),
    (lambda: st.JointIntensity(1.0), "amplitude_correlation"),
    (lambda: st.JointIntensity(0.5).moment((2, 21)), "orders"),
    (lambda: st.ObjectiveSpeckle.disc(0.0, 1.0, 1.0), "wavelength"),
    (lambda: st.ObjectiveSpeckle.disc(650e-9, math.inf, 1.0), "distance"),
    (lambda: st.ObjectiveSpeckle.rectangle(650e-9, 1.0, 1.0, 0.0), "height"),
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
