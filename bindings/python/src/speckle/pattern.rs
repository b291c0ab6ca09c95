use numpy::Complex32;
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::images::{View, array, view};
use crate::{arguments::Take, error::OrRaise};

/// Gives the samples of an object to Python, and to NumPy for the object itself.
macro_rules! samples {
    ($(#[$doc:meta])+ $class:ident: $sample:ty) => {
        #[pymethods]
        impl $class {
            $(#[$doc])+
            #[getter]
            fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<View<'py, $sample>> {
                view(slf, |this| Some(this.0.values()))
            }

            #[pyo3(signature = (dtype = None, copy = None))]
            fn __array__<'py>(
                slf: &Bound<'py, Self>,
                dtype: Option<Bound<'py, PyAny>>,
                copy: Option<bool>,
            ) -> PyResult<Bound<'py, PyAny>> {
                array(slf, dtype, copy)
            }
        }
    };
}

class! {
    /// A speckle pattern: intensity with mean 1, periodic in both axes.
    "tem00.speckle" SpecklePattern(physics::SpecklePattern)
}

samples! {
    /// Intensity at every sample, float32 [row, column]: a read-only view without a copy.
    SpecklePattern: f32
}

methods! {
    impl SpecklePattern as this: this.0;

    unmade "PupilField.pattern, SpeckleField.to_pattern or weighted_mean";

    /// Return the mean of patterns with weights: light that adds by intensities.
    ///
    /// Parameters
    /// ----------
    /// weights : array_like, shape (n,)
    ///     Mean intensities in any unit, 0 or more.
    /// patterns : iterable of SpecklePattern
    ///     As many patterns, of one size. They are drawn one by one.
    #[staticmethod]
    build weighted_mean(_py; weights: Bound<'py, PyAny>, patterns: &Bound<'py, PyAny>) = {
        take!(weights: Vec<f64>);
        let mut failed = None;
        let patterns = patterns.try_iter()?.map_while(|pattern| {
            let pattern = pattern.and_then(|one| Take::take(&one, "patterns"));
            pattern.map_err(|error| failed = Some(error)).ok()
        });
        let mean = physics::SpecklePattern::weighted_mean(&weights, patterns);
        match failed {
            Some(error) => Err(error),
            None => Ok(Self(mean.or_raise()?)),
        }
    };

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

samples! {
    /// Amplitude at every sample, complex64 [row, column]: a read-only view without a copy.
    SpeckleField: Complex32
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
