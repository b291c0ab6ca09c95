"""Samples that a type checker must accept or refuse; it is checked, not run.

Each wrong use bears the comment that silences its error. A stub that is too loose makes the
comment superfluous, which is an error as well.
"""

import numpy as np
from tem00 import ParameterError, decorrelation, statistics
from tem00._typing import FloatArray
from typing_extensions import assert_type

INTENSITIES = np.linspace(0.0, 3.0, 7)


def numbers_and_arrays() -> None:
    """Numbers give numbers, arrays give arrays."""
    law = statistics.GammaIntensity(2.0)
    assert_type(law.density(1.0), float)
    assert_type(law.density(INTENSITIES), FloatArray)
    assert_type(law.density([0.5, 1]), FloatArray)
    assert_type(law.density(INTENSITIES.astype(np.float32)), FloatArray)
    assert_type(law.shape, float)
    law.density("1")  # type: ignore[arg-type]
    law.density(1j)  # type: ignore[call-overload]
    law.density(None)  # type: ignore[call-overload]
    law.shape = 3.0  # type: ignore[misc]
    statistics.Contrast(2.0)  # type: ignore[call-arg]
    statistics.rectangular_pixel_contrast(1.0)  # type: ignore[call-overload]


def literals() -> None:
    """Choices without data are literals."""
    image = np.ones((8, 8), dtype=np.float32)
    statistics.autocovariance(image, "periodic")
    statistics.autocovariance(image, "wrap")  # type: ignore[arg-type]
    statistics.decorrelated_samples(image, 2.5)  # type: ignore[arg-type]


def callbacks() -> None:
    """Distribution functions take an array, correlations a number."""
    law = statistics.GammaIntensity(2.0)
    statistics.GoodnessOfFit(INTENSITIES, law.cumulative)
    statistics.GoodnessOfFit(INTENSITIES, lambda x: 1 - np.exp(-x))
    statistics.GoodnessOfFit(INTENSITIES, 0.5)  # type: ignore[arg-type]
    statistics.contrast_of_exposure(lambda t: 1.0 - t)
    statistics.contrast_of_exposure(lambda t: "none")  # type: ignore[arg-type, return-value]


def optional_results() -> None:
    """What may be missing must be checked."""
    levels = statistics.GreyLevels.from_values([0.0, 0.0, 1.0, 1.0])
    levels.count  # type: ignore[union-attr]
    if levels is not None:
        assert_type(levels.exponential_mean(0.5), float)


def structures() -> None:
    """Cameras and lights take all their values."""
    camera = decorrelation.ImagingGeometry.from_lens(
        wavelength=650e-9,
        focal_length=25e-3,
        f_number=8,
        surface_to_pupil=0.3,
        pixel_pitch=3.45e-6,
    )
    decorrelation.ImagingGeometry.from_lens(wavelength=650e-9)  # type: ignore[call-arg]
    decorrelation.ImagingGeometry.from_distances(camera)  # type: ignore[call-arg, arg-type]
    assert_type(camera.speckle_size, float)
    frame = decorrelation.CameraFrame.look_at([0, 0, 1], np.zeros(3), (0.0, 1.0, 0.0))
    decorrelation.CameraFrame.look_at(1.0, [0, 0, 0], [0, 1, 0])  # type: ignore[arg-type]
    assert_type(frame.axes, FloatArray)


def errors() -> None:
    """The error says which parameter it refuses."""
    try:
        statistics.GammaIntensity(0.0)
    except ParameterError as error:
        assert_type(error.parameter, str)
