"""Arguments outside what is allowed are refused by name, in every function that takes sizes."""

from collections.abc import Callable

import numpy as np
import pytest
import tem00
from numpy.lib.stride_tricks import as_strided
from tem00 import beam
from tem00 import decorrelation as dc
from tem00 import statistics as st
from tem00.speckle import Pupil, PupilField, SpecklePattern

PAIR = st.JointIntensity(0.5)
LEVELS = st.GreyLevels.from_values([0.0, 1.0, 2.0, 1.0] * 20)
assert LEVELS is not None
BEAM = beam.GaussianBeam.from_waist(650e-9, 1e-4)
CAMERA = dc.ImagingGeometry.from_lens(650e-9, 25e-3, 8.0, 0.3, 3.45e-6)


# What has a size, as a function of that size, and the name of the argument.
SIZES: list[tuple[str, Callable[[float], object]]] = [
    ("pixel_size", st.pixel_contrast),
    ("width", lambda x: st.rectangular_pixel_contrast(x, 1.0)),
    ("height", lambda x: st.rectangular_pixel_contrast(1.0, x)),
    ("spread", st.gaussian_filter_contrast),
    ("drift", st.boiling_contrast),
    ("drift", st.translation_contrast),
    ("speckles_across", st.contrast_squared_spread),
    ("row_height", st.speckle_length),
    ("radius", lambda x: st.line_centroid_deviation(x, 1.0)),
    ("row_height", lambda x: st.line_centroid_deviation(1.0, x)),
    ("radius", lambda x: st.imaged_line_centroid_deviation(x, 1.0)),
    ("row_height", lambda x: st.imaged_line_centroid_deviation(1.0, x)),
    ("radius", st.gaussian_spot_centroid_deviation),
    ("radius", st.disc_spot_centroid_deviation),
    ("measured", st.size_before_pixels),
    ("given", PAIR.conditional_mean),
    ("given", PAIR.conditional_variance),
    ("given", lambda x: PAIR.conditional_density(1.0, x)),
    ("given", lambda x: PAIR.conditional_cumulative(1.0, x)),
    ("rounded", LEVELS.exponential_mean),
    ("rounded", LEVELS.exponential_contrast),
    ("diameter", lambda x: st.ObjectiveSpeckle.disc(650e-9, 1.0, x)),
    ("width", lambda x: st.ObjectiveSpeckle.rectangle(650e-9, 1.0, x, 1.0)),
    ("height", lambda x: st.ObjectiveSpeckle.rectangle(650e-9, 1.0, 1.0, x)),
    ("radius", lambda x: st.ObjectiveSpeckle.gaussian_spot(650e-9, 1.0, x)),
    ("depth", lambda x: CAMERA.defocus_at(x)),
    ("depth", lambda x: CAMERA.axial_decorrelation_length_at(x)),
    ("radius", lambda x: beam.GaussianBeam.from_waist(650e-9, 1e-4).encircled_power(x, 0.0)),
]


@pytest.mark.parametrize(("name", "function"), SIZES, ids=range(len(SIZES)))
@pytest.mark.parametrize("bad", [-1.0, -0.5, -1e-300, np.nan, np.inf])
def test_sizes_below_zero_are_refused_by_name(
    name: str, function: Callable[[float], object], bad: float
) -> None:
    with pytest.raises(tem00.ParameterError, match=name) as caught:
        function(bad)
    assert caught.value.parameter == name


@pytest.mark.parametrize("function", [function for _, function in SIZES], ids=range(len(SIZES)))
def test_sizes_above_zero_are_taken(function: Callable[[float], object]) -> None:
    function(1.0)
    function(3.0)


# What takes a wavelength, as a function of it.
WAVELENGTHS: list[Callable[[float], object]] = [
    lambda w: beam.GaussianBeam.from_waist(w, 1e-4),
    lambda w: beam.GaussianBeam.from_divergence(w, 1e-3),
    lambda w: beam.AstigmaticBeam.from_divergences(w, (1e-3, 2e-3)),
    lambda w: beam.LocatedBeam.from_complex_parameter(0.05j, w, 1.0),
    lambda w: beam.CausticFit(w, [0.0, 0.1, 0.2, 0.3], [1e-4, 2.3e-4, 4.3e-4, 6.3e-4]),
    lambda w: dc.ImagingGeometry.from_lens(w, 25e-3, 8.0, 0.3, 3.45e-6),
    lambda w: dc.ImagingGeometry.from_thick_lens(w, 25e-3, 8.0, 1.0, 3.45e-6, surface_to_pupil=0.3),
    lambda w: dc.ImagingGeometry.from_distances(w, 0.3, 27e-3, 3e-3, 3.45e-6),
    CAMERA.with_wavelength,
    lambda w: dc.Configuration(
        wavelength=w,
        point=[0.0, 0.0, 0.0],
        normal=[0.0, 0.0, 1.0],
        illumination=dc.Illumination.collimated([0.0, 0.0, 1.0]),
        camera=dc.CameraFrame.look_at([0.0, 0.0, 0.3], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        pupil=[0.0, 0.0, 0.3],
    ),
    lambda w: st.ObjectiveSpeckle.disc(w, 1.0, 1e-3),
]


@pytest.mark.parametrize("function", WAVELENGTHS, ids=range(len(WAVELENGTHS)))
# Nanometres, micrometres, a frequency, and what is none at all.
@pytest.mark.parametrize("bad", [650, 0.65, 4.6e14, 1e-9, 0.0, -650e-9, np.nan, np.inf])
def test_a_wavelength_is_that_of_light_in_metres(
    function: Callable[[float], object], bad: float
) -> None:
    with pytest.raises(tem00.ParameterError, match="from 10 nm to 1 mm, in metres, got") as caught:
        function(bad)
    assert caught.value.parameter == "wavelength"
    function(633e-9)


def test_one_bad_element_refuses_an_array() -> None:
    sizes = np.ones((3, 5))
    sizes[1, 2] = -0.25
    with pytest.raises(tem00.ParameterError, match=r"pixel_size must be 0 or more, got -0.25"):
        st.pixel_contrast(sizes)
    np.testing.assert_allclose(st.pixel_contrast(np.zeros(2)), 1.0, atol=1e-12)


MASKED = np.ma.masked_greater([[0.25, 0.5], [0.75, 1e20]], 1.0)


# One door for each way in which arrays are read.
@pytest.mark.parametrize(
    ("parameter", "function"),
    [
        ("samples", st.Contrast.from_samples),
        ("pixel_size", st.pixel_contrast),
        ("image", lambda image: st.autocovariance(image, "finite")),
        ("image", lambda image: st.autocovariance(image.astype(np.float32), "finite")),
        ("amplitude", Pupil.sampled),
    ],
)
def test_masked_elements_are_refused(parameter: str, function: Callable[[object], object]) -> None:
    with pytest.raises(tem00.ParameterError, match="some elements are masked") as caught:
        function(MASKED)
    assert caught.value.parameter == parameter
    function(MASKED.filled(0.5))
    function(np.ma.array(MASKED.filled(0.5)))


def test_errors_of_what_numpy_cannot_read_name_the_argument() -> None:
    with pytest.raises(TypeError, match="argument 'z': expected numbers, got <U1"):
        BEAM.radius_at("a")  # type: ignore[arg-type]
    with pytest.raises(tem00.ParameterError, match="argument 'z': .*inhomogeneous") as caught:
        BEAM.radius_at([[1.0], [1.0, 2.0]])
    assert caught.value.parameter == "z"
    field = PupilField(64, 32, 1)
    with pytest.raises(TypeError, match="argument 'patterns'"):
        SpecklePattern.weighted_mean([1.0], [field])  # type: ignore[list-item]
    with pytest.raises(tem00.ParameterError, match="size must be a whole number of 0 or more"):
        PupilField(-4, 16, 1)


def test_arrays_too_large_to_copy_are_a_memory_error() -> None:
    # 2⁴⁰ times the same number, of which a copy would take 8 TiB.
    wide = np.broadcast_to(np.float64(1.0), 1 << 40)
    calls: list[Callable[[], object]] = [
        lambda: st.pixel_contrast(wide),
        lambda: st.IncoherentSum(wide),
        lambda: st.t_test_mean(wide, 1.0),
        lambda: st.Contrast.from_samples(wide),
        lambda: dc.pupil_overlap_correlation(wide),
    ]
    for call in calls:
        with pytest.raises(MemoryError, match="8796093022208 bytes"):
            call()
    image = as_strided(np.ones((1, 1), np.float32), (1 << 20, 1 << 20), (0, 0))
    with pytest.raises(MemoryError, match="4398046511104 bytes"):
        st.autocovariance(image, "periodic")
