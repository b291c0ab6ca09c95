"""Sums and exposures, against NumPy and SciPy."""

import numpy as np
import pytest
from scipy import fft

from tem00.speckle import PupilField, SpecklePattern, incoherent_fractions

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


def test_a_drift_over_the_sensor_is_a_sinc_in_the_spectrum(field: PupilField) -> None:
    drift = (1.5, -0.6)
    turns = fft.fftfreq(128)
    samples = [side * field.speckle_size for side in drift]
    smear = np.sinc(turns * samples[0] + turns[:, np.newaxis] * samples[1])
    expected = fft.ifft2(fft.fft2(field.pattern().values.astype(float)) * smear).real
    np.testing.assert_allclose(field.pattern(image_drift=drift).values, expected, atol=SINGLE)


def test_a_drift_over_the_pupil_is_a_mean_of_moments(field: PupilField) -> None:
    # 30 √½, rounded up.
    times = (np.arange(22) + 0.5) / 22 - 0.5
    patterns = [field.pattern((0.1 + 0.4 * t, 0.3 * t), 0.2).values for t in times]
    exposed = field.pattern((0.1, 0.0), 0.2, pupil_drift=(0.4, 0.3))
    np.testing.assert_allclose(exposed.values, np.mean(patterns, axis=0), atol=SINGLE)


