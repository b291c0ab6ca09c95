use numpy::{Complex32, PyArray2};
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::images::view;
use crate::error::OrRaise;

class! {
    /// A speckle pattern: intensity with mean 1, periodic in both axes.
    "tem00.speckle" SpecklePattern(physics::SpecklePattern)
}

#[pymethods]
impl SpecklePattern {
    /// Intensity at every sample, float32 [row, column]: a read-only view without a copy.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        // SAFETY: the values lie in this object, which is frozen.
        unsafe { view(slf.clone().into_any(), slf.get().0.values()) }
    }

    /// Return the mean of patterns with weights: light that adds by intensities.
    ///
    /// Parameters
    /// ----------
    /// weights : array_like, shape (n,)
    ///     Mean intensities in any unit, 0 or more.
    /// patterns : iterable of SpecklePattern
    ///     As many patterns, of one size. They are drawn one by one.
    #[staticmethod]
    fn weighted_mean(weights: Bound<'_, PyAny>, patterns: &Bound<'_, PyAny>) -> PyResult<Self> {
        take!(weights: Vec<f64>);
        let mut failed = None;
        let patterns = patterns.try_iter()?.map_while(|pattern| {
            let pattern = pattern.and_then(|p| Ok(p.cast::<Self>()?.get().0.clone()));
            pattern.map_err(|error| failed = Some(error)).ok()
        });
        let mean = physics::SpecklePattern::weighted_mean(&weights, patterns);
        match failed {
            Some(error) => Err(error),
            None => Ok(Self(mean.or_raise()?)),
        }
    }
}

methods! {
    impl SpecklePattern as this: this.0;

    unmade "PupilField.pattern, SpeckleField.to_pattern or weighted_mean";

    /// Width and height, which are the periods, in samples.
    get size -> (usize, usize);

    /// Speckle size in samples.
    get speckle_size -> f64;

    shown size, speckle_size;
}

class! {
    /// The complex amplitude of a speckle field, of mean square 1, periodic in both axes.
    "tem00.speckle" SpeckleField(physics::SpeckleField)
}

#[pymethods]
impl SpeckleField {
    /// Amplitude at every sample, complex64 [row, column]: a read-only view without a copy.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<Complex32>>> {
        // SAFETY: the values lie in this object, which is frozen.
        unsafe { view(slf.clone().into_any(), slf.get().0.values()) }
    }
}

methods! {
    impl SpeckleField as this: this.0;

    unmade "PupilField.field";

    /// Return the intensity.
    fn to_pattern() -> SpecklePattern = this.0.to_pattern();

    /// Width and height, which are the periods, in samples.
    get size -> (usize, usize);

    /// Speckle size in samples.
    get speckle_size -> f64;

    shown size, speckle_size;
}
