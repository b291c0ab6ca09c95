use numpy::PyArray2;
use pyo3::prelude::*;
use tem00_speckle as physics;

use super::{arguments::counts, images::check_bytes, pattern::SpecklePattern};
use crate::{
    arrays::{Whole, image_array},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

/// The pixels of a sensor on a pattern: boxes of any size at any pitch, in samples.
///
/// Parameters
/// ----------
/// count : (int, int)
///     Number of pixels along x and y.
/// pitch : (float, float)
///     Distance of neighbours along x and y in samples.
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

    #[new]
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

    /// Return the mean intensity over each pixel.
    ///
    /// Parameters
    /// ----------
    /// pattern : SpecklePattern
    ///     Pattern on the sensor, which repeats beyond its period.
    ///
    /// Returns
    /// -------
    /// ndarray
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
            "PixelArray(count={:?}, pitch={:?}).with_size({:?}).with_origin({:?})",
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

methods! {
    impl PixelArray as this: this.0;

    /// Number of pixels along x and y.
    get count -> (usize, usize);

    /// Distance of neighbours along x and y in samples.
    get pitch -> (f64, f64);

    /// Width and height of a pixel in samples.
    get size -> (f64, f64);

    /// Middle of the first pixel in samples.
    get origin -> (f64, f64);
}
