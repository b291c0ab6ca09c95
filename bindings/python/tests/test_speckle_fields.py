"""Fields and patterns against Fourier transforms of SciPy and the patterns of pyspeckle."""

from collections.abc import Callable

import numpy as np
import pyspeckle  # type: ignore[import-untyped]
import pytest
from numpy.typing import NDArray
from scipy import fft, stats

from tem00.speckle import Pupil, PupilField, SpecklePattern, Transmission

SIZE = (96, 80)
SPECKLE_SIZE = 2.5
DIAMETER = (SIZE[0] / SPECKLE_SIZE, SIZE[1] / SPECKLE_SIZE)

Shape = Callable[
    [NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]], NDArray[np.generic]
]

# Transforms of 1e4 points in single precision: 3e-7 of the brightest speckle, of the intensity 10.
SINGLE = 1e-5


def measured() -> NDArray[np.complex64]:
    """Return a field as if measured in the pupil, of shape (40, 45)."""
    rng = np.random.default_rng(11)
    values = rng.normal(size=(40, 45)) + 1j * rng.normal(size=(40, 45))
    return values.astype(np.complex64)


def lattice(samples: NDArray[np.complex64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the lattice points of samples along x and y, as arrays that broadcast."""
    rows, columns = samples.shape
    return np.arange(columns) - columns // 2, (np.arange(rows) - rows // 2)[:, np.newaxis]


def transformed(
    samples: NDArray[np.complex64], offset: tuple[float, float], defocus: float
) -> NDArray[np.complex128]:
    """Return the field of a circular pupil as SciPy has it, its mean square 1."""
    x, y = lattice(samples)
    centre = [side * diameter for side, diameter in zip(offset, DIAMETER, strict=True)]
    px, py = (x - centre[0]) / DIAMETER[0], (y - centre[1]) / DIAMETER[1]
    radius = np.hypot(px, py)
    lens = np.exp(2j * np.pi * defocus * (2 * radius) ** 2)
    seen = np.where(radius <= 0.5 + 1e-12, samples * lens, 0)
    # The pupil about k = 0, wherever it stands.
    kx, ky = (points - round(c) for points, c in zip((x, y), centre, strict=True))
    pupil = np.zeros(SIZE[::-1], complex)
    pupil[ky % SIZE[1], kx % SIZE[0]] = seen
    amplitude: NDArray[np.complex128] = fft.fft2(pupil) / np.sqrt(np.sum(np.abs(seen) ** 2))
    return amplitude


@pytest.mark.parametrize(
    ("offset", "defocus"),
    [((0.0, 0.0), 0.0), ((0.25, -0.125), 0.0), ((0.0, 0.0), 1.5), ((0.013, 0.107), -0.7)],
)
def test_a_field_is_the_fourier_transform_of_its_pupil(
    offset: tuple[float, float], defocus: float
) -> None:
    field = PupilField.from_samples(measured(), SIZE, SPECKLE_SIZE)
    expected = transformed(measured(), offset, defocus)
    amplitude = field.speckle(offset, defocus)
    np.testing.assert_allclose(amplitude.values, expected, atol=SINGLE)
    intensity = np.abs(expected) ** 2
    np.testing.assert_allclose(field.pattern_at(offset, defocus).values, intensity, atol=SINGLE)
    np.testing.assert_allclose(amplitude.to_pattern().values, intensity, atol=SINGLE)


def test_patterns_in_focus_are_those_at_no_offset() -> None:
    field = PupilField(64, 32, 3)
    assert field.pattern() == field.pattern_at((0.0, 0.0), 0.0)
    assert field.field() == field.speckle((0.0, 0.0), 0.0)
    assert field.pattern() != field.with_seed(4).pattern()


def test_unit_phasors_fill_the_pupil_and_nothing_else() -> None:
    field = PupilField(128, 41, 9)
    pupil = fft.ifft2(field.field().values) * np.sqrt(field.phasor_count)
    k = fft.fftfreq(128, 1 / 128)
    inside = np.hypot(k, k[:, np.newaxis]) <= 20.5
    assert field.phasor_count == np.count_nonzero(inside)
    # 1e-6 of the sum that each point is, for single precision.
    np.testing.assert_allclose(np.abs(pupil), inside, atol=2e-6 * np.sqrt(field.phasor_count))


@pytest.mark.parametrize("pixels_per_speckle", [2, 3])
def test_the_same_phases_give_the_pattern_of_pyspeckle(pixels_per_speckle: int) -> None:
    side = 64
    np.random.seed(5)
    expected = pyspeckle.create_Exponential(side, pixels_per_speckle)
    # pyspeckle draws phases for a lattice as large as the pattern, with the pupil in one corner. It
    # shifts the pattern by half a period, keeps a corner of it and divides by the maximum.
    period = side * pixels_per_speckle
    np.random.seed(5)
    phases = 2 * np.pi * np.random.rand(period, period)[: side + 1, : side + 1]
    field = PupilField.from_samples(np.exp(1j * phases), (period, period), pixels_per_speckle)
    corner = fft.fftshift(field.pattern().values)[:side, :side]
    np.testing.assert_allclose(corner / corner.max(), expected, atol=SINGLE)


def window_statistics(image: NDArray[np.floating], lag: int) -> tuple[float, float]:
    """Return the squared contrast and the autocorrelation at a lag along x."""
    centred = image - image.mean()
    covariance = np.mean(centred[:, :-lag] * centred[:, lag:])
    return float(centred.var() / image.mean() ** 2), float(covariance / centred.var())


def test_contrast_and_width_are_those_of_pyspeckle() -> None:
    np.random.seed(6)
    theirs, ours = [], []
    # Half the maximum of the autocovariance lies 0.515 speckle sizes away: 2 of 4 samples.
    for seed in range(40):
        theirs.append(window_statistics(pyspeckle.create_Exponential(64, 4), 2))
        pattern = PupilField(256, 64, seed).pattern().values[:64, :64]
        ours.append(window_statistics(pattern, 2))
    for name, a, b in zip(("contrast", "width"), zip(*theirs), zip(*ours), strict=True):
        # Welch's test that both have the same mean, each at 5e-4.
        assert stats.ttest_ind(a, b, equal_var=False).pvalue > 5e-4, name


def autocovariance(pattern: SpecklePattern) -> NDArray[np.float64]:
    """Return the autocovariance of one period, by SciPy's transforms."""
    spectrum = fft.fft2(pattern.values.astype(float) - 1.0)
    covariance: NDArray[np.float64] = fft.ifft2(np.abs(spectrum) ** 2).real / spectrum.size
    return covariance


@pytest.mark.parametrize(
    "pupil",
    [Pupil.circle(), Pupil.annulus(inner=0.5), Pupil.rectangle(height=0.4), Pupil.gaussian(0.35)],
    ids=repr,
)
def test_autocovariances_have_the_closed_form(pupil: Pupil) -> None:
    field = PupilField(128, 32, 0).with_pupil(pupil)
    seeds = 100
    measured = np.mean(
        [autocovariance(field.with_seed(seed).pattern()) for seed in range(seeds)], axis=0
    )[:8, :8]
    x, y = np.arange(8), np.arange(8)[:, np.newaxis]
    correlation = np.abs(field.amplitude_correlation(x, y)) ** 2
    expected = correlation - 1 / field.effective_phasor_count
    # The spread of a squared contrast is 1.53 / C for a disc; for N phasors of other pupils it
    # scales by √(disc / N). Five of it for 64 lags, 4e-5 in all.
    disc = np.pi / 4 * 32**2
    spread = 1.53 / 32 * np.sqrt(disc / field.effective_phasor_count)
    np.testing.assert_allclose(measured, expected, atol=5 * spread / np.sqrt(seeds))


def test_amplitude_correlations_are_sums_over_the_pupil() -> None:
    field = PupilField.from_speckle_size(SIZE, SPECKLE_SIZE, 1)
    kx, ky = np.meshgrid(np.arange(-25, 26), np.arange(-25, 26))
    inside = np.hypot(kx / DIAMETER[0], ky / DIAMETER[1]) <= 0.5 + 1e-12
    x, y = 1.7, -0.4
    waves = np.exp(-2j * np.pi * (kx * x / SIZE[0] + ky * y / SIZE[1]))[inside]
    # A thousand terms in double precision.
    assert field.amplitude_correlation(x, y) == pytest.approx(waves.mean(), abs=1e-12)
    shifted = np.hypot((kx - 3) / DIAMETER[0], (ky + 5) / DIAMETER[1]) <= 0.5 + 1e-12
    share = np.count_nonzero(inside & shifted) / np.count_nonzero(inside)
    assert field.overlap((3, -5)) == pytest.approx(share, abs=1e-12)
    area = np.sqrt(4 / np.pi * np.count_nonzero(inside))
    assert field.effective_diameter == pytest.approx(area, rel=1e-12)


def test_decorrelated_samples_are_exponential() -> None:
    # Beyond 1.22 speckle sizes, the first zero of the autocovariance: 4.88 samples.
    field = PupilField(512, 128, 0).with_phasors("gaussian")
    samples = np.concatenate(
        [field.with_seed(seed).pattern().values[::5, ::5].ravel() for seed in range(4)]
    )
    assert stats.kstest(samples, "expon").pvalue > 1e-3


@pytest.mark.parametrize(
    ("pupil", "shape"),
    [
        (Pupil.annulus(inner=0.5), lambda r, x, y: (r <= 0.5) & (r >= 0.25)),
        (Pupil.rectangle(height=0.4), lambda r, x, y: (abs(x) <= 0.5) & (abs(y) <= 0.2)),
        (Pupil.gaussian(radius=0.3), lambda r, x, y: np.exp(-((r / 0.3) ** 2)) * (r <= 0.5)),
    ],
    ids=("annulus", "rectangle", "gaussian"),
)
def test_overlaps_of_pupils_are_their_integrals(pupil: Pupil, shape: Shape) -> None:
    cells = 1000
    x, y = np.meshgrid(*2 * [(np.arange(cells) + 0.5) / cells - 0.5])
    transmission = shape(np.hypot(x, y), x, y).astype(float)
    for columns, rows in [(100, 0), (370, 120), (0, 150), (-640, 90)]:
        here = transmission[max(rows, 0) :, max(columns, 0) : cells + min(columns, 0)]
        there = transmission[: cells - rows, max(-columns, 0) : cells - max(columns, 0)]
        share = np.sum(here * there) / np.sum(transmission**2)
        # Cells on the rims: about one in a thousand, at random to either side.
        assert pupil.overlap(columns / cells, rows / cells) == pytest.approx(share, abs=1e-3)


def test_sampled_pupils_transmit_what_they_were_given() -> None:
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, 60)])
    amplitude = np.where(np.hypot(x, y) <= 1, np.exp(3j * x**3 - y**2), 0)
    transmission = Transmission.from_complex(amplitude)
    np.testing.assert_array_equal(transmission.values, amplitude.astype(np.complex64))
    open_pupil = PupilField(128, 60, 2)
    seen = fft.ifft2(open_pupil.with_pupil(Pupil.sampled(transmission)).field().values)
    phasors = fft.ifft2(open_pupil.field().values)
    # The lattice point k lies in the cell k + 30; well inside the disc, where both have light.
    k = np.arange(-20, 20)
    cells = amplitude[10:50, 10:50]
    ratio = seen[k[:, np.newaxis], k] / phasors[k[:, np.newaxis], k]
    # Relative to the rounding of a single point, 1e-6 of the sum of all 2800.
    np.testing.assert_allclose(ratio / ratio[20, 20], cells / cells[20, 20], atol=1e-4)
    assert Transmission(np.ones((3, 4))).values.shape == (3, 4)


def test_fields_say_what_they_are_made_of() -> None:
    field = PupilField.from_speckle_size((640, 480), 3.2, 7)
    assert (field.size, field.diameter, field.seed) == ((640, 480), (200.0, 150.0), 7)
    assert (field.phasors, field.samples, field.pupil.kind) == ("unit", None, "circle")
    assert field.with_speckle_size(4.0).diameter == (160.0, 120.0)
    assert field.with_phasors("gaussian").phasors == "gaussian"
    samples = PupilField.from_samples(measured(), SIZE, SPECKLE_SIZE)
    assert (samples.seed, samples.phasors) == (None, None)
    assert samples.samples is not None
    np.testing.assert_array_equal(samples.samples, measured())
