use pyo3::prelude::*;
use tem00_speckle as physics;

use super::{
    arguments::{finite, finite_pair},
    field::PupilField,
    images::check_room,
    pattern::SpecklePattern,
};
use crate::{
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// An exposure during which the pattern moves, or changes, or both, at a constant rate.
///
/// ``Exposure()`` is the one without motion.
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

    /// Return the exposure of the undisplaced pupil in focus.
    ///
    /// Parameters
    /// ----------
    /// field : PupilField
    ///     Field behind the pupil.
    fn pattern(&self, py: Python<'_>, field: &PupilField) -> PyResult<SpecklePattern> {
        self.pattern_at(py, field, [0.0; 2], 0.0)
    }

    /// Return the exposure in whose middle the pupil is displaced and out of focus.
    ///
    /// Parameters
    /// ----------
    /// field : PupilField
    ///     Field behind the pupil.
    /// offset : (float, float)
    ///     Displacement of the pupil in its diameters.
    /// defocus : float
    ///     In axial decorrelation lengths: at 1 the correlation first vanishes. Turns of phase from the
    ///     centre of the pupil to its rim.
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
            "Exposure().with_image_drift({:?}).with_pupil_drift({:?})",
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

methods! {
    impl Exposure as this: this.0;

    /// Drift of the pattern over the sensor, along x and y in speckle sizes.
    get image_drift -> (f64, f64);

    /// Drift of the light over the pupil, along x and y in pupil diameters.
    get pupil_drift -> (f64, f64);

    /// Number of patterns whose mean the exposure is, 1 without pupil drift.
    get moments -> usize;
}
