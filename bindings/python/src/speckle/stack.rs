use numpy::{Complex32, PyArray2};
use pyo3::{prelude::*, types::PyComplex};
use tem00_speckle as physics;

use super::{
    arguments::{finite_pair, index},
    field::PupilField,
    images::view,
    options::StackOptions,
    path::SlicePath,
    slice_law::SliceLaw,
};
use crate::{
    arrays::{Floats, Numbers, Values, Whole, fill_in_kind, map, map_many},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// Speckle that moves and decorrelates: slices of one random field behind a wandering pupil.
///
/// A look-up takes a position (x, y) in samples and a coordinate u in slices. Along x and y the
/// pattern repeats after its size, along u after ``slice_count`` slices.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpeckleStack(
    pub(super) physics::SpeckleStack,
    /// What it was generated from, before a straight path closed it.
    pub(super) physics::PupilField,
);

#[pymethods]
impl SpeckleStack {
    /// Generate the slices of a field along a path.
    ///
    /// Parameters
    /// ----------
    /// field : PupilField
    ///     Field that the slices are cut from.
    /// path : SlicePath
    ///     Path of the pupil over the field.
    /// options : StackOptions, optional
    ///     Memory limit; by default all that the machine has.
    ///
    /// Raises
    /// ------
    /// MemoryError
    ///     If the slices take more than the limit, or than the machine has.
    #[staticmethod]
    #[pyo3(signature = (field, path, options = None))]
    fn generate(
        py: Python<'_>,
        field: &PupilField,
        path: &SlicePath,
        options: Option<&StackOptions>,
    ) -> PyResult<Self> {
        let (field, path) = (&field.0, path.0);
        let options = options.map_or_else(physics::StackOptions::default, |options| options.0);
        let stack = py.detach(|| physics::SpeckleStack::generate_with(field, path, options));
        Ok(Self(stack.or_raise()?, field.clone()))
    }

    /// Return the coefficients that look-ups interpolate, complex64 [row, column].
    ///
    /// They are those of the prefiltered spline: a read-only view without a copy.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    fn coefficients<'py>(
        slf: &Bound<'py, Self>,
        index: Whole<'py>,
    ) -> PyResult<Bound<'py, PyArray2<Complex32>>> {
        let slice = slf.get().slice(&index)?;
        // SAFETY: the coefficients lie in this object, which is frozen.
        unsafe { view(slf.clone().into_any(), slf.get().0.coefficients(slice)) }
    }

    /// Return the closed forms of a slice and of its join to the next.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    fn slice_law(&self, index: Whole<'_>) -> PyResult<SliceLaw> {
        Ok(SliceLaw(self.0.slice_law(self.slice(&index)?)))
    }

    /// Return where the pupil of a slice stands, in its diameters along x and y.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    fn offset(&self, index: Whole<'_>) -> PyResult<(f64, f64)> {
        Ok(self.0.offset(self.slice(&index)?).into())
    }

    /// Return the intensity, with mean 1, at positions and slice coordinates.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Position in samples; the period is the size.
    /// u : array_like
    ///     Coordinate in slices; the period is ``slice_count``.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Intensity in the common shape of the arguments; in float32 where all arrays are, for their
    ///     rounded coordinates.
    fn intensity_at<'py>(
        &self,
        py: Python<'py>,
        x: Floats<'py>,
        y: Floats<'py>,
        u: Floats<'py>,
    ) -> PyResult<Values<'py>> {
        fill_in_kind(
            py,
            [("x", x), ("y", y), ("u", u)],
            |[x, y, u], intensity| self.0.intensity_batch_f32(x, y, u, intensity),
            |[x, y, u], intensity| self.0.intensity_batch(x, y, u, intensity),
        )
    }

    /// Return the amplitude whose squared magnitude is the intensity, for light whose fields add.
    ///
    /// Stacks along one path have one frame, so that their amplitudes add.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Position in samples; the period is the size.
    /// u : array_like
    ///     Coordinate in slices; the period is ``slice_count``.
    ///
    /// Returns
    /// -------
    /// complex or ndarray of complex
    ///     Amplitude in the common shape of the arguments.
    fn amplitude_at<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        u: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [re, im] = map_many(py, [("x", &x), ("y", &y), ("u", &u)], |[x, y, u]| {
            let amplitude = self.0.amplitude_at(x, y, u);
            [amplitude.re, amplitude.im]
        })?;
        re.add(im.mul(PyComplex::from_doubles(py, 0.0, 1.0))?)
    }

    /// Return the mean of the intensity over boxes: what pixels see whose whole area takes part.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Centre of the box in samples.
    /// size : (float, float)
    ///     Width and height of the box in samples, 0 or more.
    /// u : array_like
    ///     Coordinate in slices.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Mean intensity in the common shape of x, y and u; in float32 where all their arrays are.
    fn average_over<'py>(
        &self,
        py: Python<'py>,
        x: Floats<'py>,
        y: Floats<'py>,
        size: [f64; 2],
        u: Floats<'py>,
    ) -> PyResult<Values<'py>> {
        let size = finite_pair("size", size)?;
        if let Some(bad) = size.into_iter().find(|side| *side < 0.0) {
            return Err(refused(
                "size",
                format!("size must be 0 or more, got {bad}"),
            ));
        }
        fill_in_kind(
            py,
            [("x", x), ("y", y), ("u", u)],
            |[x, y, u], average| self.0.average_batch_f32([x, y], size, u, average),
            |[x, y, u], average| {
                for (i, average) in average.iter_mut().enumerate() {
                    *average = self.0.average_over([x[i], y[i]], size, u[i]);
                }
            },
        )
    }

    /// A stack is pickled as the field and the path that it is made of.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let parts = (PupilField(self.1.clone()), self.path());
        by_constructor::<Self>(py, "generate", parts)
    }

    fn __repr__(&self) -> String {
        format!(
            "<SpeckleStack: size={:?}, speckle_size={}, path={}>",
            self.size(),
            self.speckle_size(),
            self.path().__repr__()
        )
    }
}

methods! {
    impl SpeckleStack as this: this.0;

    unmade "generate";

    /// Field the slices were cut from. That of a straight path closes on itself after the length of
    /// the path.
    get field -> PupilField = PupilField(this.0.field().clone());

    /// Path of the pupil.
    get path -> SlicePath = SlicePath(this.0.path());

    /// Width and height, which are the periods in the plane, in samples.
    get size -> (usize, usize);

    /// Speckle size in samples.
    get speckle_size -> f64;

    /// Number of slices, the period in u.
    get slice_count -> usize;

    /// Bytes that the slices take.
    get memory_bytes -> u64;

    /// Return the correlation of the intensities looked up at two coordinates, exactly.
    ///
    /// Parameters
    /// ----------
    /// u, v : array_like
    ///     Coordinates in slices, on slices or between.
    map correlation_between(u, v);

    /// Return the correlation of the intensities at u = 0 and u = distance, in closed form.
    ///
    /// Parameters
    /// ----------
    /// distance : array_like
    ///     Distance in slices.
    map correlation_at(distance);

    /// Return the coordinate u at which a look-up has a given correlation to that at u = 0.
    ///
    /// Parameters
    /// ----------
    /// correlation : array_like
    ///     Correlation; 1 and more give 0, 0 and less the first slice of no correlation.
    map coordinate_of(correlation);

    /// Return the coordinate u where the pupil has moved by a shift over the speckle.
    ///
    /// Parameters
    /// ----------
    /// shift : array_like
    ///     Shift in pupil diameters, to one side or the other; beyond the reach of the path it counts as the reach.
    map coordinate_at(shift);
}

impl SpeckleStack {
    fn slice(&self, slice: &Whole<'_>) -> PyResult<usize> {
        index("index", slice, self.0.slice_count())
    }
}
