use std::{fs::File, io::BufWriter, path::PathBuf};

use numpy::{Complex32, PyArray2};
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::images::view;
use crate::{arrays::Components, error::OrRaise};

/// A speckle pattern: intensity with mean 1, periodic in both axes.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpecklePattern(pub(super) physics::SpecklePattern);

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
    fn weighted_mean(weights: Components<'_>, patterns: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut failed = None;
        let patterns = patterns.try_iter()?.map_while(|pattern| {
            let pattern = pattern.and_then(|p| Ok(p.cast::<Self>()?.get().0.clone()));
            pattern.map_err(|error| failed = Some(error)).ok()
        });
        let mean = physics::SpecklePattern::weighted_mean(weights.finite("weights")?, patterns);
        match failed {
            Some(error) => Err(error),
            None => Ok(Self(mean.or_raise()?)),
        }
    }

    /// Write the intensity as an NPY file of float32, to be read by ``numpy.load``.
    ///
    /// Parameters
    /// ----------
    /// file : str or os.PathLike
    ///     Where to write.
    fn write_npy(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        Ok(py.detach(|| self.0.write_npy(BufWriter::new(File::create(file)?)))?)
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.0.size();
        let speckle_size = self.0.speckle_size();
        format!("<SpecklePattern: size=({width}, {height}), speckle_size={speckle_size}>")
    }
}

methods! {
    impl SpecklePattern as this: this.0;

    unmade "PupilField.pattern, SpeckleField.to_pattern or weighted_mean";

    /// Width and height, which are the periods, in samples.
    get size -> (usize, usize);

    /// Speckle size in samples.
    get speckle_size -> f64;
}

/// The complex amplitude of a speckle field, of mean square 1, periodic in both axes.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpeckleField(pub(super) physics::SpeckleField);

#[pymethods]
impl SpeckleField {
    /// Amplitude at every sample, complex64 [row, column]: a read-only view without a copy.
    #[getter]
    fn values<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<Complex32>>> {
        // SAFETY: the values lie in this object, which is frozen.
        unsafe { view(slf.clone().into_any(), slf.get().0.values()) }
    }

    /// Return the intensity, the squared magnitude of the amplitude.
    fn to_pattern(&self, py: Python<'_>) -> SpecklePattern {
        SpecklePattern(py.detach(|| self.0.to_pattern()))
    }

    /// Write the amplitude as an NPY file of complex64, to be read by ``numpy.load``.
    ///
    /// Parameters
    /// ----------
    /// file : str or os.PathLike
    ///     Where to write.
    fn write_npy(&self, py: Python<'_>, file: PathBuf) -> PyResult<()> {
        Ok(py.detach(|| self.0.write_npy(BufWriter::new(File::create(file)?)))?)
    }

    fn __repr__(&self) -> String {
        let [width, height] = self.0.size();
        let speckle_size = self.0.speckle_size();
        format!("<SpeckleField: size=({width}, {height}), speckle_size={speckle_size}>")
    }
}

methods! {
    impl SpeckleField as this: this.0;

    unmade "PupilField.field or PupilField.speckle";

    /// Width and height, which are the periods, in samples.
    get size -> (usize, usize);

    /// Speckle size in samples.
    get speckle_size -> f64;
}
