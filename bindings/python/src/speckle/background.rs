use numpy::Complex32;
use pyo3::prelude::*;
use tem00_numerics::cast::to_f32;
use tem00_speckle as physics;

use super::{
    images::check_room,
    pattern::{SpeckleField, SpecklePattern},
};
use crate::arrays::{Numbers, map};

/// A uniform wave that interferes with the speckle: partially developed speckle.
///
/// Parameters
/// ----------
/// `beam_ratio` : float
///     Intensity of the background over the mean of the speckle, 0 to `MAX_BEAM_RATIO`.
/// phase : float
///     Phase in radians.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoherentBackground(physics::CoherentBackground);

#[pymethods]
impl CoherentBackground {
    /// The largest beam ratio.
    #[classattr]
    const MAX_BEAM_RATIO: f64 = physics::CoherentBackground::MAX_BEAM_RATIO;

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
            let intensity = self.0.intensity(Complex32::new(to_f32(re), to_f32(im)));
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
}

methods! {
    impl CoherentBackground as this: this.0;

    make new(beam_ratio, phase);

    /// Intensity of the background over the mean of the speckle.
    get beam_ratio -> f64;

    /// Phase in radians.
    get phase -> f64;

    /// Contrast on fully developed speckle.
    get contrast -> f64;

    made_by new(beam_ratio, phase);
}
