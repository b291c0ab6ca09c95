//! Light that is more than one wave, and what a sensor makes of it.

use numpy::{Complex32, PyArray2};
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::{
    arguments::{Whole, counts, finite, finite_pair},
    field::PupilField,
    images::{check_bytes, check_room},
    pattern::{SpeckleField, SpecklePattern},
};
use crate::{
    arrays::{Numbers, image_array, map},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// A uniform wave that interferes with the speckle: partially developed speckle.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherentBackground(physics::CoherentBackground);

#[pymethods]
impl CoherentBackground {
    /// The largest beam ratio.
    #[classattr]
    const MAX_BEAM_RATIO: f64 = physics::CoherentBackground::MAX_BEAM_RATIO;

    /// Return the background of a beam ratio and a phase.
    ///
    /// Parameters
    /// ----------
    /// `beam_ratio` : float
    ///     Intensity of the background over the mean of the speckle, 0 to `MAX_BEAM_RATIO`.
    /// phase : float
    ///     Phase in radians.
    #[staticmethod]
    fn new(beam_ratio: f64, phase: f64) -> PyResult<Self> {
        let background = physics::CoherentBackground::new(beam_ratio, phase);
        Ok(Self(background.or_raise()?))
    }

    /// Intensity of the background over the mean of the speckle.
    #[getter]
    const fn beam_ratio(&self) -> f64 {
        self.0.beam_ratio()
    }

    /// Phase in radians.
    #[getter]
    const fn phase(&self) -> f64 {
        self.0.phase()
    }

    /// Contrast on fully developed speckle.
    #[getter]
    fn contrast(&self) -> f64 {
        self.0.contrast()
    }

    /// Return the intensity, with expected mean 1, where the speckle has an amplitude.
    ///
    /// Parameters
    /// ----------
    /// amplitude : `array_like` of complex
    ///     Amplitude of the speckle, of mean square 1.
    ///
    /// Returns
    /// -------
    /// float or numpy.ndarray
    ///     Intensity in the shape of the argument.
    fn intensity<'py>(
        &self,
        py: Python<'py>,
        amplitude: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let amplitude = py.import("numpy")?.call_method1("asarray", (amplitude,))?;
        let (re, im): (Numbers<'_>, Numbers<'_>) = (
            amplitude.getattr("real")?.extract()?,
            amplitude.getattr("imag")?.extract()?,
        );
        map(py, [("amplitude", &re), ("amplitude", &im)], |[re, im]| {
            let intensity = self.0.intensity(Complex32::new(single(re), single(im)));
            // What single precision does not hold is refused as not a number.
            if intensity.is_finite() {
                intensity
            } else {
                f64::NAN
            }
        })
    }

    /// Return the intensity of a whole field on the background.
    ///
    /// Parameters
    /// ----------
    /// field : `SpeckleField`
    ///     Amplitude of the speckle.
    fn pattern(&self, py: Python<'_>, field: &SpeckleField) -> PyResult<SpecklePattern> {
        check_room(field.0.size(), 4)?;
        Ok(SpecklePattern(py.detach(|| self.0.pattern(&field.0))))
    }

    fn __repr__(&self) -> String {
        let (ratio, phase) = (self.0.beam_ratio(), self.0.phase());
        format!("CoherentBackground.new(beam_ratio={ratio}, phase={phase})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "new", (self.0.beam_ratio(), self.0.phase()))
    }
}

/// An exposure during which the pattern moves, or changes, or both, at a constant rate.
///
/// `Exposure()` is the one without motion.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exposure(physics::Exposure);

#[pymethods]
impl Exposure {
    /// The largest image drift along an axis, in speckle sizes.
    #[classattr]
    const MAX_IMAGE_DRIFT: f64 = physics::Exposure::MAX_IMAGE_DRIFT;
    /// The largest pupil drift along an axis, in pupil diameters.
    #[classattr]
    const MAX_PUPIL_DRIFT: f64 = physics::Exposure::MAX_PUPIL_DRIFT;

    #[new]
    fn new() -> Self {
        Self(physics::Exposure::default())
    }

    /// Return the same exposure with another drift of the pattern over the sensor.
    ///
    /// Parameters
    /// ----------
    /// drift : (float, float)
    ///     Drift along x and y in speckle sizes.
    fn with_image_drift(&self, drift: [f64; 2]) -> PyResult<Self> {
        Ok(Self(self.0.with_image_drift(drift).or_raise()?))
    }

    /// Return the same exposure with another drift of the light over the pupil.
    ///
    /// Parameters
    /// ----------
    /// drift : (float, float)
    ///     Drift along x and y in pupil diameters.
    fn with_pupil_drift(&self, drift: [f64; 2]) -> PyResult<Self> {
        Ok(Self(self.0.with_pupil_drift(drift).or_raise()?))
    }

    /// Drift of the pattern over the sensor, along x and y in speckle sizes.
    #[getter]
    fn image_drift(&self) -> (f64, f64) {
        self.0.image_drift().into()
    }

    /// Drift of the light over the pupil, along x and y in pupil diameters.
    #[getter]
    fn pupil_drift(&self) -> (f64, f64) {
        self.0.pupil_drift().into()
    }

    /// Number of patterns whose mean the exposure is, 1 without pupil drift.
    #[getter]
    fn moments(&self) -> usize {
        self.0.moments()
    }

    /// Return the exposure of the undisplaced pupil in focus.
    ///
    /// Parameters
    /// ----------
    /// field : `PupilField`
    ///     Field behind the pupil.
    fn pattern(&self, py: Python<'_>, field: &PupilField) -> PyResult<SpecklePattern> {
        self.pattern_at(py, field, [0.0; 2], 0.0)
    }

    /// Return the exposure in whose middle the pupil is displaced and out of focus.
    ///
    /// Parameters
    /// ----------
    /// field : `PupilField`
    ///     Field behind the pupil.
    /// offset : (float, float)
    ///     Displacement of the pupil in its diameters.
    /// defocus : float
    ///     Half turns of phase from the centre of the pupil to its rim.
    fn pattern_at(
        &self,
        py: Python<'_>,
        field: &PupilField,
        offset: [f64; 2],
        defocus: f64,
    ) -> PyResult<SpecklePattern> {
        let (offset, defocus) = (finite_pair("offset", offset)?, finite("defocus", defocus)?);
        // Two patterns, their spectrum and what it is summed to.
        check_room(field.0.size(), 2 * 4 + 3 * 8)?;
        let pattern = py.detach(|| self.0.pattern_at(&field.0, offset, defocus));
        Ok(SpecklePattern(pattern))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Exposure: image_drift={:?}, pupil_drift={:?}>",
            self.image_drift(),
            self.pupil_drift()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "_restore", (self.image_drift(), self.pupil_drift()))
    }

    /// Make an exposure again of its drifts.
    #[staticmethod]
    fn _restore(image_drift: [f64; 2], pupil_drift: [f64; 2]) -> PyResult<Self> {
        Self::new()
            .with_image_drift(image_drift)?
            .with_pupil_drift(pupil_drift)
    }
}

/// The pixels of a sensor on a pattern: boxes of any size at any pitch, in samples.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PixelArray(physics::PixelArray);

#[pymethods]
impl PixelArray {
    /// The largest number of pixels along an axis.
    #[classattr]
    const MAX_COUNT: usize = physics::PixelArray::MAX_COUNT;
    /// The largest length in samples.
    #[classattr]
    const MAX_LENGTH: f64 = physics::PixelArray::MAX_LENGTH;

    /// Return an array of pixels of the size of their pitch, the first about the sample (0, 0).
    ///
    /// Parameters
    /// ----------
    /// count : (int, int)
    ///     Number of pixels along x and y.
    /// pitch : (float, float)
    ///     Distance of neighbours along x and y in samples.
    #[staticmethod]
    fn new(count: [Whole<'_>; 2], pitch: [f64; 2]) -> PyResult<Self> {
        let count = counts("count", &count)?;
        Ok(Self(physics::PixelArray::new(count, pitch).or_raise()?))
    }

    /// Return the same array with pixels of another size.
    ///
    /// Parameters
    /// ----------
    /// size : (float, float)
    ///     Width and height of a pixel in samples; 0 makes points of them.
    fn with_size(&self, size: [f64; 2]) -> PyResult<Self> {
        Ok(Self(self.0.with_size(size).or_raise()?))
    }

    /// Return the same array in another place.
    ///
    /// Parameters
    /// ----------
    /// origin : (float, float)
    ///     Middle of the first pixel in samples.
    fn with_origin(&self, origin: [f64; 2]) -> PyResult<Self> {
        Ok(Self(self.0.with_origin(origin).or_raise()?))
    }

    /// Number of pixels along x and y.
    #[getter]
    fn count(&self) -> (usize, usize) {
        self.0.count().into()
    }

    /// Distance of neighbours along x and y in samples.
    #[getter]
    fn pitch(&self) -> (f64, f64) {
        self.0.pitch().into()
    }

    /// Width and height of a pixel in samples.
    #[getter]
    fn size(&self) -> (f64, f64) {
        self.0.size().into()
    }

    /// Middle of the first pixel in samples.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        self.0.origin().into()
    }

    /// Return the mean intensity over each pixel.
    ///
    /// Parameters
    /// ----------
    /// pattern : `SpecklePattern`
    ///     Pattern on the sensor, which repeats beyond its period.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     float32 of shape (rows, columns).
    fn image<'py>(
        &self,
        py: Python<'py>,
        pattern: &SpecklePattern,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let ([columns, rows], [width, height]) = (self.0.count(), pattern.0.size());
        // The image, and weights of each column and row of pixels.
        check_bytes(4 * (columns * rows + columns * width + rows * height) as u64)?;
        image_array(py, py.detach(|| self.0.image(&pattern.0)))
    }

    fn __repr__(&self) -> String {
        format!(
            "<PixelArray: count={:?}, pitch={:?}, size={:?}, origin={:?}>",
            self.count(),
            self.pitch(),
            self.size(),
            self.origin()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let arguments = (self.count(), self.pitch(), self.size(), self.origin());
        by_constructor::<Self>(py, "_restore", arguments)
    }

    /// Make an array again of its lengths.
    #[staticmethod]
    fn _restore(
        count: [Whole<'_>; 2],
        pitch: [f64; 2],
        size: [f64; 2],
        origin: [f64; 2],
    ) -> PyResult<Self> {
        Self::new(count, pitch)?
            .with_size(size)?
            .with_origin(origin)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "amplitudes are stored in single precision"
)]
const fn single(x: f64) -> f32 {
    x as f32
}
