"""Speckle in light that is not of one wavelength, against quadrature by SciPy."""

import math

import numpy as np
import pytest
import tem00
from scipy import integrate
from numpy.typing import NDArray
from tem00.coherence import (
    ResolutionCell,
    Spectrum,
    cascade_variance,
    mixed_contrast,
)
from tem00.speckle import PupilField, SlicePath, SpeckleStack

WAVELENGTH, SIN_APERTURE, LINEWIDTH = 450e-9, 0.025, 20e-9
SPREAD = 2 * math.pi * LINEWIDTH / WAVELENGTH**2 / math.sqrt(8 * math.log(2))


def cell(rms_height: float = 0.0, defocus: float = 0.0) -> ResolutionCell:
    """Lit along the normal, seen under 30 degrees."""
    to_pupil = (0.5, 0.0, math.sqrt(0.75))
    return ResolutionCell(
        (0, 0, 1), to_pupil, (0, 0, 1), SIN_APERTURE, WAVELENGTH,
        rms_height=rms_height, defocus=defocus,
    )


def overlap(shift: float) -> float:
    s = min(abs(shift), 1.0)
    return 2 / math.pi * (math.acos(s) - s * math.sqrt(1 - s * s))


@pytest.mark.parametrize("height", [0.0, 0.4e-6, 6e-6])
def test_contrast_and_line_noise_are_means_over_pairs_of_wave_numbers(height: float) -> None:
    tilt = math.tan(math.radians(30))
    factor = (1 + math.cos(math.radians(30))) / math.cos(math.radians(30))
    full = 4 * math.pi * SIN_APERTURE / (WAVELENGTH * tilt)
    assert cell(height).tilt_wave_number == pytest.approx(full, rel=1e-12)
    assert cell(height).path_spread == pytest.approx(factor * height, rel=1e-12)

    def mean(shared: object) -> float:
        assert callable(shared)

        def integrand(x: float) -> float:
            kappa = 2 * SPREAD * x
            weight = math.exp(-x * x - (kappa * factor * height) ** 2) / math.sqrt(math.pi)
            return float(weight * shared(min(abs(kappa) / full, 1.0)))

        return float(2 * integrate.quad(integrand, 0, 8, epsabs=1e-12, limit=200)[0])

    line = Spectrum(WAVELENGTH, LINEWIDTH)
    assert cell(height).contrast(line) ** 2 == pytest.approx(
        mean(lambda s: overlap(s) ** 2), rel=1e-7
    )
    thin = mean(lambda s: 1 - 1.5 * s + 0.5 * s**3)
    assert cell(height).line_noise_ratio(line) ** 2 == pytest.approx(thin, rel=1e-7)
    tall = cell(height).line_noise_ratio(line, tall_rows=True)
    assert tall**2 == pytest.approx(mean(overlap), rel=1e-7)
    modes = cell(height).modes(line)
    assert modes.sum() == pytest.approx(1)
    assert np.sqrt((modes**2).sum()) == pytest.approx(cell(height).contrast(line), abs=2e-3)


def test_frames_grains_and_defocus() -> None:
    line = Spectrum(WAVELENGTH, LINEWIDTH)
    tilted = cell()
    assert tilted.covariance(line, (0, 0)) == pytest.approx(tilted.contrast(line) ** 2)
    assert tilted.covariance(line, (0.3, 0)) > tilted.covariance(line, (0, 0.3))
    assert tilted.autocovariance(line, (1, 0)) > tilted.autocovariance(line, (0, 1))
    assert cell(defocus=1.5e-3).contrast(line) == pytest.approx(0.401, abs=1e-3)
    np.testing.assert_allclose(tilted.tilt @ (0.5, 0, math.sqrt(0.75)), 0, atol=1e-15)


def test_lines_have_the_coherence_of_their_shapes() -> None:
    unit = WAVELENGTH**2 / LINEWIDTH
    assert Spectrum(WAVELENGTH, LINEWIDTH).coherence_length == pytest.approx(
        math.sqrt(2 * math.log(2) / math.pi) * unit
    )
    assert Spectrum.lorentzian(WAVELENGTH, LINEWIDTH).coherence_length == pytest.approx(
        unit / math.pi
    )
    assert Spectrum.rectangular(WAVELENGTH, LINEWIDTH).coherence_length == pytest.approx(unit)
    comb = Spectrum.comb(WAVELENGTH, 1e-9, 3)
    again = WAVELENGTH**2 / 0.5e-9
    np.testing.assert_allclose(comb.squared_coherence(np.array([0.0, again])), 1, atol=1e-9)
    assert comb.squared_coherence(again / 3) == pytest.approx(0, abs=1e-9)
    two = Spectrum.from_peaks([450e-9, 451e-9], [1.0, 3.0])
    assert 450e-9 < two.wavelength < 451e-9
    assert Spectrum(WAVELENGTH).coherence_length == math.inf
    assert comb.squared_coherence(1e308) == pytest.approx(1 / 9)


@pytest.mark.parametrize(
    ("wrong", "parameter"),
    [
        (lambda: Spectrum(0.0), "wavelength"),
        (lambda: Spectrum(650.0), "wavelength"),
        (lambda: Spectrum(650e-9, 100e-9), "linewidth"),
        (lambda: Spectrum.comb(650e-9, 1e-9, 0), "count"),
        (lambda: Spectrum.from_peaks([650e-9], [-1.0]), "powers"),
        (lambda: Spectrum.from_peaks([650e-9], [1.0, 2.0]), "powers"),
        (lambda: ResolutionCell((0, 0, -1), (0, 0, 1), (0, 0, 1), 0.1, 1e-6), "to_source"),
        (lambda: ResolutionCell((0, 0, 1), (0, 0, 1), (0, 0, 1), 2.0, 1e-6), "sin_aperture"),
        (lambda: cell(rms_height=-1.0), "rms_height"),
        (lambda: cell(defocus=math.inf), "defocus"),
        (lambda: cell().autocovariance(Spectrum(WAVELENGTH), (1e9, 0)), "lag"),
        (lambda: cell().autocovariance(Spectrum(650e-9), (0, 0)), "spectrum"),
        (lambda: cell().covariance(Spectrum(650e-9), (0, 0)), "spectrum"),
        (lambda: cell().contrast(Spectrum(1.02 * WAVELENGTH)), "spectrum"),
        (lambda: cell().line_noise_ratio(Spectrum(650e-9)), "spectrum"),
        (lambda: cell().modes(Spectrum(650e-9)), "spectrum"),
        (lambda: cell().patterns(Spectrum(650e-9)), "spectrum"),
    ],
)
def test_what_cannot_be_is_refused_by_name(wrong: object, parameter: str) -> None:
    assert callable(wrong)
    with pytest.raises(tem00.ParameterError) as caught:
        wrong()
    assert caught.value.parameter == parameter


def test_multiple_light_counts_with_what_its_paths_share() -> None:
    """Normally distributed delays, by sums over pairs of random paths."""
    line = Spectrum(WAVELENGTH, 0.1e-9)
    delays = np.random.default_rng(1).normal(0.82e-3, 0.3e-3, 1500)
    within = float(np.mean(line.squared_coherence(delays[:, None] - delays)))
    shared = float(np.mean(line.squared_coherence(delays)))
    spread = 2 * math.pi * 0.1e-9 / WAVELENGTH**2 / math.sqrt(8 * math.log(2))
    assert within == pytest.approx((1 + (2 * spread * 0.3e-3) ** 2) ** -0.5, abs=0.02)

    f = 0.3 / 1.3
    contrast = mixed_contrast(f, with_single=shared, within_multiple=within, polarisation=(1, 0))
    squared = (1 - f) ** 2 + f * (1 - f) * shared + f**2 * within / 2
    assert contrast == pytest.approx(math.sqrt(squared), rel=1e-12)
    assert mixed_contrast(f) == pytest.approx(1)
    with pytest.raises(
        tem00.ParameterError, match=r"^within_multiple must be from 0 to 1, got 1\.5$"
    ):
        mixed_contrast(f, within_multiple=1.5)


def test_a_small_lit_part_makes_speckle_of_speckle() -> None:
    assert math.sqrt(1 + 2 * cascade_variance(1.0)) == pytest.approx(1.237, abs=5e-4)
    assert cascade_variance(0) == pytest.approx(1)


@pytest.mark.parametrize("height", [0.0, 0.8e-6])
def test_light_that_is_drawn_has_the_contrast_of_the_law(height: float) -> None:
    line, tilted = Spectrum(WAVELENGTH, LINEWIDTH), cell(height)
    fractions, heights = tilted.patterns(line)
    assert fractions.tolist() == [1.0]
    slices = 2 * 48 / 3
    path = SlicePath.straight(half_period=48, length=3)
    fields = PupilField(256, 64, 1).independent(len(heights))
    stacks = [SpeckleStack.generate(field, path) for field in fields]
    x, y = np.meshgrid(np.arange(51) * 5.0, np.arange(51) * 5.0)
    waves = line.draw((np.arange(64) + 0.5) / 64)

    def intensity(kappa: float) -> NDArray[np.floating]:
        u = slices * kappa / tilted.tilt_wave_number
        parts = [
            root * np.exp(1j * kappa * tilted.height_factor * z) * stack.amplitude_at(x, y, u)
            for stack, (z, root) in zip(stacks, heights)
        ]
        return np.asarray(np.abs(sum(parts)) ** 2)

    exposed = np.mean([intensity(kappa) for kappa in waves], axis=0)
    # Some 2000 speckles, and 1 % each by slices and heights.
    assert exposed.std() / exposed.mean() == pytest.approx(tilted.contrast(line), rel=0.045)


def test_the_extent_of_a_source_adds_patterns() -> None:
    line = Spectrum(WAVELENGTH)
    wide = ResolutionCell(
        [0, 0, 1], [0, 0, 1], [0, 0, 1], 0.025, WAVELENGTH, source_half_angle=0.025
    )
    # As wide as the lens.
    assert wide.contrast(line) == pytest.approx(0.515, abs=1e-3)
    fractions, heights = wide.patterns(line)
    assert np.sum(fractions**2) == pytest.approx(wide.contrast(line) ** 2, rel=1e-3)
    assert heights.tolist() == [[0.0, 1.0]]
    with pytest.raises(tem00.ParameterError, match="source_half_angle"):
        ResolutionCell([0, 0, 1], [0, 0, 1], [0, 0, 1], 0.025, WAVELENGTH, source_half_angle=0.4)
