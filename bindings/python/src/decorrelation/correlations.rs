use pyo3::prelude::*;
use tem00_decorrelation as physics;

use crate::{
    arrays::{Numbers, Values, map, try_map},
    error::IntoPython,
    pickling::{Recipe, by_constructor},
};

/// Definition of the correlation after a pupil and an axial displacement together.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CorrelationLaw(physics::CorrelationLaw);

impl CorrelationLaw {
    const fn name(self) -> &'static str {
        match self.0 {
            physics::CorrelationLaw::AtImageDisplacement => "at_image_displacement",
            physics::CorrelationLaw::AtPeak => "at_peak",
        }
    }
}

#[pymethods]
impl CorrelationLaw {
    /// Return the law at the displacement of the projected surface point.
    #[staticmethod]
    fn at_image_displacement() -> Self {
        Self(physics::CorrelationLaw::AtImageDisplacement)
    }

    /// Return the law at the peak of the cross-correlation, which defocus moves elsewhere.
    #[staticmethod]
    fn at_peak() -> Self {
        Self(physics::CorrelationLaw::AtPeak)
    }

    fn __repr__(&self) -> String {
        format!("CorrelationLaw.{}()", self.name())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, self.name(), ())
    }
}

methods! {
    impl CorrelationLaw as this: this.0;

    unmade "at_image_displacement or at_peak";

    /// Return the intensity correlation left, in [0, 1].
    ///
    /// Parameters
    /// ----------
    /// pupil_shift : float or array_like
    ///     Displacement across the pupil in pupil diameters.
    /// axial_shift : float or array_like
    ///     Displacement along the axis in axial decorrelation lengths.
    map correlation(pupil_shift, axial_shift);
}

functions! {
    /// Return the intensity correlation left when the speckle slides across a circular pupil.
    ///
    /// Parameters
    /// ----------
    /// shift : float or array_like
    ///     Pupil displacement in pupil diameters.
    map pupil_overlap_correlation(shift);

    /// Return the intensity correlation left when the surface moves along the optical axis.
    ///
    /// Parameters
    /// ----------
    /// shift : float or array_like
    ///     Axial displacement in axial decorrelation lengths.
    map axial_correlation(shift);
}

/// Return the pupil displacement, in pupil diameters, that alone would leave a correlation.
///
/// Parameters
/// ----------
/// correlation : float or array_like
///     Intensity correlation, from 0 to 1.
#[pyfunction]
pub(super) fn equivalent_pupil_shift<'py>(
    py: Python<'py>,
    correlation: Numbers<'py>,
) -> PyResult<Values<'py>> {
    let argument = ("correlation", &correlation);
    try_map(
        py,
        argument,
        physics::equivalent_pupil_shift,
        IntoPython::into_python,
    )
}

/// Return the axial displacement, in axial decorrelation lengths, that alone leaves a correlation.
///
/// Parameters
/// ----------
/// correlation : float or array_like
///     Intensity correlation, from 0 to 1.
#[pyfunction]
pub(super) fn equivalent_axial_shift<'py>(
    py: Python<'py>,
    correlation: Numbers<'py>,
) -> PyResult<Values<'py>> {
    let argument = ("correlation", &correlation);
    try_map(
        py,
        argument,
        physics::equivalent_axial_shift,
        IntoPython::into_python,
    )
}
