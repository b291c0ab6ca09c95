"""Estimators and hypothesis tests against NumPy and SciPy."""

import math
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest
import tem00
from numpy.typing import NDArray
from scipy import fft, ndimage
from scipy import stats as scipy_stats
from tem00 import statistics as st


def pattern(seed: int, size: int = 256, pupil: int = 64) -> NDArray[np.float32]:
    """Return a speckle pattern by NumPy: speckles of size / pupil pixels, periodic."""
    return (np.abs(field(seed, size, pupil)) ** 2).astype(np.float32)


def field(seed: int, size: int = 256, pupil: int = 64) -> NDArray[np.complex128]:
    """Return the field of a circular pupil of random phasors."""
    y, x = np.indices((size, size)) - pupil / 2 + 0.5
    inside = x**2 + y**2 <= (pupil / 2) ** 2
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, (size, size))
    phasors = np.where(inside, np.exp(1j * phases), 0)
    return np.fft.fft2(phasors) / math.sqrt(np.count_nonzero(inside))


SAMPLES = np.random.default_rng(1).gamma(3.0, 2.0, size=(50, 40))


def test_the_contrast_is_that_of_scipy() -> None:
    contrast = st.Contrast.from_samples(SAMPLES)
    assert math.isclose(contrast.value, scipy_stats.variation(SAMPLES, axis=None, ddof=1))
    low, high = contrast.confidence_interval(0.9)
    factor = math.exp(scipy_stats.norm.ppf(0.95) * contrast.standard_error / contrast.value)
    assert math.isclose(high, contrast.value * factor, rel_tol=1e-9)
    assert math.isclose(low, contrast.value / factor, rel_tol=1e-9)
    assert str(contrast) == f"{contrast.value:.3f} ± {contrast.standard_error:.3f}"
    assert contrast.with_speckle_size(3.0).standard_error > 2 * contrast.standard_error
    image = pattern(3, size=48, pupil=16)
    fluctuation = image - image.mean(dtype=float)
    covariance = (fluctuation * np.roll(fluctuation, (-1, -3), axis=(0, 1))).mean()
    lags = st.autocovariance(image, "periodic")
    assert lags.dtype == np.float32
    assert abs(lags[1, 3] - covariance / fluctuation.var()) < 1e-6
    assert st.autocovariance(image, "finite").shape == (96, 96)


def test_gamma_fits_are_those_of_scipy() -> None:
    shape, _, scale = scipy_stats.gamma.fit(SAMPLES.ravel(), floc=0)
    fit = st.GammaFit.by_likelihood(SAMPLES)
    # SciPy's root finder stops at 1e-8 or better.
    assert math.isclose(fit.shape, shape, rel_tol=1e-7)
    assert math.isclose(fit.mean, shape * scale, rel_tol=1e-7)
    by_moments = st.GammaFit.by_moments(SAMPLES)
    assert math.isclose(by_moments.shape, (SAMPLES.mean() / SAMPLES.std(ddof=1)) ** 2)
    assert fit.distribution() == st.GammaIntensity(fit.shape)
    # Information of the shape: n (ψ′(M) − 1/M).
    from scipy.special import polygamma

    information = SAMPLES.size * (float(polygamma(1, fit.shape)) - 1 / fit.shape)
    assert math.isclose(fit.standard_error, 1 / math.sqrt(information), rel_tol=1e-10)


def test_the_correlation_of_images_is_that_of_scipy() -> None:
    first, second = pattern(1), pattern(2)
    mixed = (first + 0.5 * second).astype(np.float32)
    expected = scipy_stats.pearsonr(first.ravel().astype(float), mixed.ravel().astype(float))
    assert math.isclose(
        st.pearson_correlation(first, mixed), float(expected.statistic), rel_tol=1e-12
    )


def test_the_power_spectrum_is_that_of_scipy() -> None:
    image = pattern(4)
    fluctuation = image - image.mean(dtype=float)
    expected = np.abs(fft.fft2(fluctuation)) ** 2 / (fluctuation**2).sum()
    # Single precision of values up to some ten times the mean of a flat spectrum over the pupil.
    np.testing.assert_allclose(st.power_spectrum(image), expected, atol=1e-6 * expected.max())


def test_rings_are_averages_by_distance() -> None:
    size = 32
    lags = np.random.default_rng(5).normal(size=(size, size)).astype(np.float32)
    steps = np.minimum(np.arange(size), size - np.arange(size))
    radius = np.hypot(steps[:, None], steps[None, :])
    rings = st.radial_average(lags, (1.0, 1.0))
    labels = np.rint(radius).astype(int)
    indices = range(len(rings))
    assert len(rings) == size // 2 + 1
    means = ndimage.mean(lags.astype(float), labels, indices)
    np.testing.assert_allclose([ring.mean for ring in rings], means, atol=1e-12)
    np.testing.assert_allclose(
        [ring.radius for ring in rings], ndimage.mean(radius, labels, indices), rtol=1e-12
    )
    assert [ring.cells for ring in rings] == [np.count_nonzero(labels == i) for i in indices]


def test_the_local_contrast_is_that_of_windows() -> None:
    image = pattern(6, size=64, pupil=20)
    windows = np.lib.stride_tricks.sliding_window_view(image.astype(float), (5, 5))
    expected = windows.std(axis=(2, 3), ddof=1) / windows.mean(axis=(2, 3))
    got = st.local_contrast(image, 5)
    # Rounded to single precision.
    np.testing.assert_allclose(got, expected, rtol=1e-6)


def test_every_stride_th_pixel_is_a_sample() -> None:
    image = pattern(7)
    # 256 is 51 strides of 5 and one pixel more.
    expected = image[::5, ::5][:51, :51].ravel()
    np.testing.assert_array_equal(st.decorrelated_samples(image, 5), expected)


def test_speckles_have_the_size_they_were_made_with() -> None:
    sizes = [st.SpeckleSize.from_image(pattern(seed), "periodic") for seed in range(20, 30)]
    measured = np.array([[size.x, size.y] for size in sizes])
    # Speckles of 256/64 = 4 pixels, 64 of them across: 0.62/64 per image, less along one axis
    # each; the mean of ten images within four standard errors of 4 · 1.5 % /√10. The size shrinks
    # by 0.86 · 16 / 65536.
    assert np.all(np.abs(measured.mean(axis=0) - 4) < 4 * 4 * 0.015 / math.sqrt(10))
    lags = st.autocovariance(pattern(20), "periodic")
    assert st.SpeckleSize.from_autocovariance(lags) == sizes[0]


def test_singularities_are_where_the_phase_turns() -> None:
    wave = field(8, size=96, pupil=24).astype(np.complex64)
    phase = np.angle(wave.astype(complex))
    corners = [
        phase,
        np.roll(phase, -1, 1),
        np.roll(phase, (-1, -1), (0, 1)),
        np.roll(phase, -1, 0),
    ]
    around = [corners[(i + 1) % 4] - corners[i] for i in range(4)]
    wrapped = sum((step + np.pi) % (2 * np.pi) - np.pi for step in around)
    charges = np.rint(wrapped / (2 * np.pi)).astype(int)
    found = st.phase_singularities(wave, "periodic")
    expected = [(x, y, charges[y, x]) for y, x in zip(*np.nonzero(charges))]
    assert [(s.x, s.y, s.charge) for s in found] == expected
    assert sum(s.charge for s in found) == 0
    density = st.VortexDensity.from_field(wave, "periodic")
    assert density.count == len(found)
    assert density.value == len(found) / 96**2
    # π/8 per h², h = 4: within four standard errors and the stated 1.5/h² of false pairs.
    excess = density.value - st.VORTEX_DENSITY / 16
    assert abs(excess) < 4 * density.standard_error + 1.5 / 16 * st.VORTEX_DENSITY / 16


def test_hypothesis_tests_agree_with_scipy() -> None:
    samples = np.random.default_rng(9).exponential(size=500)
    ours = st.GoodnessOfFit(samples, scipy_stats.expon.cdf).kolmogorov_smirnov()
    scipys: Any = scipy_stats.kstest(samples, "expon")
    assert math.isclose(ours.statistic, scipys.statistic, rel_tol=1e-12)
    # The p-value is that of many samples with Stephens' correction.
    assert abs(ours.p_value - scipys.pvalue) < 0.01
    again = st.GoodnessOfFit(samples, st.exponential_cumulative).kolmogorov_smirnov()
    # An ulp of 1 between both distribution functions.
    assert math.isclose(again.statistic, ours.statistic, abs_tol=1e-15)

    t_ours = st.t_test_mean(samples, 1.1)
    t_scipy: Any = scipy_stats.ttest_1samp(samples, 1.1)
    assert math.isclose(t_ours.statistic, abs(t_scipy.statistic), rel_tol=1e-12)
    assert math.isclose(t_ours.p_value, t_scipy.pvalue, rel_tol=1e-9)


def test_rounded_samples_are_compared_at_the_edges_of_their_levels() -> None:
    light = np.random.default_rng(10).exponential(3.0, size=4_000)
    rounded = np.rint(light)

    law: Any = scipy_stats.expon(scale=3.0).cdf

    assert scipy_stats.kstest(rounded, law).pvalue < 1e-6
    levels = st.GreyLevels.from_values(rounded)
    assert levels is not None
    assert levels.step == 1.0
    fit = st.GoodnessOfFit(rounded, law, levels)
    # The edges are few, the distance at them no larger than that of the light itself.
    assert fit.kolmogorov_smirnov().p_value >= scipy_stats.kstest(light, law).pvalue - 0.02
    assert fit.chi_squared(1).p_value > 1e-3
    # Mean and contrast of a rounded exponential, summed.
    n = np.arange(400)
    p = scipy_stats.expon.cdf(n + 0.5, scale=3) - scipy_stats.expon.cdf(n - 0.5, scale=3)
    mean = float((p * n).sum())
    contrast = math.sqrt(float((p * n**2).sum()) - mean**2) / mean
    assert math.isclose(levels.exponential_mean(mean), 3.0, rel_tol=1e-10)
    assert math.isclose(levels.exponential_contrast(mean), contrast, rel_tol=1e-10)
    assert st.GreyLevels.from_values(light) is None
    assert np.ptp(levels.spread(rounded)) < rounded.max() + 1


IMAGE = np.ones((4, 4))
LEVELS = cast(st.GreyLevels, st.GreyLevels.from_values([0.0, 0.0, 1.0, 1.0, 2.0, 2.0]))
HOLE = np.array([[1.0, math.nan], [1.0, 2.0]])
REFUSALS: list[tuple[Callable[[], object], str]] = [
    (lambda: st.Contrast.from_samples([-1.0, 1.0]), "samples"),
    (lambda: st.Contrast.from_samples([2.0, 1.0]).with_speckle_size(0.0), "speckle_size"),
    (lambda: st.Contrast.from_samples([2.0, 1.0]).confidence_interval(1.0), "level"),
    (lambda: st.GammaFit.by_likelihood([0.0, 1.0]), "samples"),
    (lambda: st.GammaFit.by_moments([1.0, 1.0]), "samples"),
    (lambda: st.GammaFit.by_moments([0.0, 0.0, 0.0, 9.0]).distribution(), "shape"),
    (lambda: st.pearson_correlation(pattern(1), IMAGE), "second"),
    (lambda: st.pearson_correlation(HOLE, IMAGE), "first"),
    (lambda: st.autocovariance(IMAGE, "periodic"), "image"),
    (lambda: st.autocovariance(HOLE, "periodic"), "image"),
    (lambda: st.autocovariance(np.ones(4), "periodic"), "image"),
    (lambda: st.autocovariance(np.ones((0, 4)), "periodic"), "image"),
    (lambda: st.autocovariance(np.full((2, 2), 1e300), "periodic"), "image"),
    (lambda: st.autocovariance(IMAGE, "wrap"), "boundary"),  # type: ignore[arg-type]
    (lambda: st.power_spectrum(IMAGE), "image"),
    (lambda: st.radial_average(IMAGE, (1.0, 0.0)), "step"),
    (lambda: st.decorrelated_samples(IMAGE, 0), "stride"),
    (lambda: st.decorrelated_samples(IMAGE, -1), "stride"),
    (lambda: st.local_contrast(IMAGE, 9), "window"),
    (lambda: st.local_contrast(-IMAGE, 2), "image"),
    (lambda: st.SpeckleSize.from_image(IMAGE, "finite"), "image"),
    (lambda: st.SpeckleSize.from_autocovariance(IMAGE), "lags"),
    (lambda: st.phase_singularities(np.full((2, 2), np.nan), "finite"), "field"),
    (lambda: st.VortexDensity.from_field(np.ones((1, 4)), "finite"), "field"),
    (lambda: st.GoodnessOfFit([], scipy_stats.expon.cdf), "samples"),
    (lambda: st.GoodnessOfFit([1.0], lambda x: 2 * x), "cumulative"),
    (lambda: st.GoodnessOfFit([1.0], lambda x: [0.5, 0.5]), "cumulative"),
    (lambda: st.t_test_mean([1.0, 2.0], math.nan), "mean"),
    (lambda: LEVELS.exponential_mean(0.0), "rounded"),
    (lambda: st.GoodnessOfFit([], st.exponential_cumulative, LEVELS), "samples"),
]


@pytest.mark.parametrize(("call", "parameter"), REFUSALS)
def test_a_refusal_names_the_parameter(call: Callable[[], object], parameter: str) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        call()
    assert caught.value.parameter == parameter
