"""Sums, backgrounds, exposures and pixels, against NumPy and SciPy."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import fft, stats

from tem00.speckle import (
    Exposure,
    PupilField,
    SlicePath,
    SpecklePattern,
    SpeckleStack,
    incoherent_fractions,
)
from tem00.statistics import IncoherentSum

# Sums of patterns in single precision, whose brightest speckle has the intensity 10.
SINGLE = 1e-5


@pytest.fixture(scope="module")
def field() -> PupilField:
    return PupilField(128, 48, 21)


def test_a_mean_adds_its_patterns_in_their_shares(field: PupilField) -> None:
    fractions = incoherent_fractions(1, 1.0, [3.0, 0.0, 1.0])
    np.testing.assert_allclose(fractions, [0.75, 0.25], rtol=1e-15)
    first, second = field.independent(2)
    assert first == field
    expected = 0.75 * first.pattern().values + 0.25 * second.pattern().values
    patterns = (part.pattern() for part in (first, second))
    mean = SpecklePattern.weighted_mean([3.0, 1.0], patterns)
    np.testing.assert_allclose(mean.values, expected, atol=SINGLE)
    assert mean.speckle_size == field.speckle_size


def test_fractions_have_the_contrast_of_their_law() -> None:
    polarised = np.sqrt((1 + 0.36) / 2)
    fractions = incoherent_fractions(3, 0.6, [1.0])
    assert len(fractions) == 6
    law = IncoherentSum(fractions)
    assert law.contrast == pytest.approx(polarised / np.sqrt(3), rel=1e-14)


def test_equal_sums_have_the_gamma_law() -> None:
    field = PupilField(256, 64, 0).with_phasors("gaussian")

    def pattern(seed: int) -> SpecklePattern:
        parts = field.with_seed(seed).independent(3)
        return SpecklePattern.weighted_mean([1.0] * 3, (part.pattern() for part in parts))

    # Beyond the first zero of the autocovariance, 1.22 speckle sizes of 4 samples.
    samples = np.concatenate([pattern(seed).values[::5, ::5].ravel() for seed in range(4)])
    assert stats.kstest(samples, stats.gamma(3, scale=1 / 3).cdf).pvalue > 1e-3


def test_a_drift_over_the_sensor_is_a_sinc_in_the_spectrum(field: PupilField) -> None:
    drift = (1.5, -0.6)
    exposure = Exposure().with_image_drift(drift)
    assert (exposure.image_drift, exposure.pupil_drift, exposure.moments) == (drift, (0, 0), 1)
    turns = fft.fftfreq(128)
    samples = [side * field.speckle_size for side in drift]
    smear = np.sinc(turns * samples[0] + turns[:, np.newaxis] * samples[1])
    expected = fft.ifft2(fft.fft2(field.pattern().values.astype(float)) * smear).real
    np.testing.assert_allclose(exposure.pattern(field).values, expected, atol=SINGLE)


def test_a_drift_over_the_pupil_is_a_mean_of_moments(field: PupilField) -> None:
    exposure = Exposure().with_pupil_drift((0.4, 0.3))
    # 30 √½, rounded up.
    assert exposure.moments == 22
    times = (np.arange(22) + 0.5) / 22 - 0.5
    patterns = [field.pattern_at((0.1 + 0.4 * t, 0.3 * t), 0.2).values for t in times]
    exposed = exposure.pattern_at(field, (0.1, 0.0), 0.2)
    np.testing.assert_allclose(exposed.values, np.mean(patterns, axis=0), atol=SINGLE)
