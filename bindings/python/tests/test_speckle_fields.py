"""Fields and patterns against Fourier transforms of SciPy and the patterns of pyspeckle."""

import numpy as np
import pyspeckle  # type: ignore[import-untyped]
import pytest
from numpy.typing import NDArray
from scipy import fft

from tem00.speckle import Pupil, PupilField

SIZE = (96, 80)
SPECKLE_SIZE = 2.5
DIAMETER = (SIZE[0] / SPECKLE_SIZE, SIZE[1] / SPECKLE_SIZE)


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
    amplitude = field.field(offset, defocus)
    np.testing.assert_allclose(amplitude.values, expected, atol=SINGLE)
    intensity = np.abs(expected) ** 2
    np.testing.assert_allclose(field.pattern(offset, defocus).values, intensity, atol=SINGLE)
    np.testing.assert_allclose(amplitude.to_pattern().values, intensity, atol=SINGLE)


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


def test_amplitude_correlations_are_sums_over_the_pupil() -> None:
    field = PupilField.from_speckle_size(SIZE, SPECKLE_SIZE, 1)
    kx, ky = np.meshgrid(np.arange(-25, 26), np.arange(-25, 26))
    inside = np.hypot(kx / DIAMETER[0], ky / DIAMETER[1]) <= 0.5 + 1e-12
    x, y = 1.7, -0.4
    waves = np.exp(-2j * np.pi * (kx * x / SIZE[0] + ky * y / SIZE[1]))[inside]
    # A thousand terms in double precision.
    assert field.amplitude_correlation(x, y) == pytest.approx(waves.mean(), abs=1e-12)
    gap = np.arccos(0.3) - 0.3 * np.sqrt(1 - 0.3**2)
    assert field.pupil.overlap(0.3, 0.0) == pytest.approx(2 / np.pi * gap, rel=1e-12)
    area = np.sqrt(4 / np.pi * np.count_nonzero(inside))
    assert field.effective_diameter == pytest.approx(area, rel=1e-12)


def test_sampled_pupils_transmit_what_they_were_given() -> None:
    x, y = np.meshgrid(*2 * [np.linspace(-1, 1, 60)])
    amplitude = np.where(np.hypot(x, y) <= 1, np.exp(3j * x**3 - y**2), 0)
    pupil = Pupil.sampled(amplitude)
    np.testing.assert_array_equal(pupil.values, amplitude.astype(np.complex64))
    open_pupil = PupilField(128, 60, 2)
    seen = fft.ifft2(open_pupil.with_pupil(pupil).field().values)
    phasors = fft.ifft2(open_pupil.field().values)
    # The lattice point k lies in the cell k + 30; well inside the disc, where both have light.
    k = np.arange(-20, 20)
    cells = amplitude[10:50, 10:50]
    ratio = seen[k[:, np.newaxis], k] / phasors[k[:, np.newaxis], k]
    # Relative to the rounding of a single point, 1e-6 of the sum of all 2800.
    np.testing.assert_allclose(ratio / ratio[20, 20], cells / cells[20, 20], atol=1e-4)


def test_fields_say_what_they_are_made_of() -> None:
    field = PupilField.from_speckle_size((640, 480), 3.2, 7)
    assert (field.size, field.diameter, field.seed) == ((640, 480), (200.0, 150.0), 7)
    assert (field.phasors, field.samples, field.pupil) == ("unit", None, Pupil.circle())
    assert field.with_speckle_size(4.0).diameter == (160.0, 120.0)
    assert field.with_phasors("gaussian").phasors == "gaussian"
    samples = PupilField.from_samples(measured(), SIZE, SPECKLE_SIZE)
    assert (samples.seed, samples.phasors) == (None, None)
    assert samples.samples is not None
    np.testing.assert_array_equal(samples.samples, measured())
