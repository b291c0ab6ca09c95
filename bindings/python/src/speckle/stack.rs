use numpy::{Complex32, PyArray2};
use pyo3::prelude::*;
use tem00_speckle::{self as physics, SlicePath as Path, StackOptions};

use super::{
    field::PupilField,
    images::{View, view},
    path::SlicePath,
};
use crate::{
    arguments::optional,
    arrays::{
        Floats, LIMIT, Numbers, Values, Whole, evaluate, map_complex, map_inner, named_class,
    },
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// Speckle that moves and decorrelates: slices of one random field behind a wandering pupil.
///
/// A look-up takes a position (x, y) in samples and a coordinate u in slices. Along x and y the
/// pattern repeats after its size, along u after ``slice_count`` slices.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpeckleStack(physics::SpeckleStack, physics::PupilField);

immutable!(SpeckleStack);

/// Options with a limit of the memory.
pub(super) fn within(memory_limit: Option<u64>) -> StackOptions {
    StackOptions {
        memory_limit: memory_limit.unwrap_or(u64::MAX),
    }
}

impl SpeckleStack {
    /// Generates the slices of a field along a path.
    pub(super) fn of(
        field: physics::PupilField,
        path: Path,
        options: StackOptions,
    ) -> PyResult<Self> {
        let stack = physics::SpeckleStack::generate_with(&field, path, options).or_raise()?;
        Ok(Self(stack, field))
    }

    /// The number of a slice; negative ones count from the end, as in Python.
    fn slice(&self, index: &Whole<'_>) -> PyResult<usize> {
        let (given, count) = (index.signed("index")?, self.0.slice_count());
        let length = i64::try_from(count)?;
        let place = if given < 0 { given + length } else { given };
        match usize::try_from(place) {
            Ok(place) if place < count => Ok(place),
            _ => {
                let message = format!("index must be -{count} to {}, got {given}", count - 1);
                Err(refused("index", message))
            }
        }
    }
}

#[pymethods]
impl SpeckleStack {
    /// Return the coefficients that look-ups interpolate, complex64 [row, column].
    ///
    /// They are those of the prefiltered cubic spline: a read-only view without a copy.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    fn coefficients<'py>(
        slf: &Bound<'py, Self>,
        index: Whole<'py>,
    ) -> PyResult<View<'py, Complex32>> {
        let slice = slf.get().slice(&index)?;
        view(slf, |this| Some(this.0.coefficients(slice)))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let parts = (PupilField(self.1.clone()), self.path());
        by_constructor::<Self>(py, "generate", parts)
    }
}

methods! {
    impl SpeckleStack as this: this.0;

    unmade "generate";

    /// Generate the slices of a field along a path.
    ///
    /// Parameters
    /// ----------
    /// field : PupilField
    ///     Field that the slices are cut from.
    /// path : SlicePath
    ///     Path of the pupil over the field.
    /// memory_limit : int, optional
    ///     Bytes that the slices may take; by default all that the machine has.
    ///
    /// Raises
    /// ------
    /// MemoryError
    ///     If the slices take more than the limit, or than the machine has.
    #[staticmethod]
    #[pyo3(signature = (field, path, memory_limit = None))]
    build generate(py;
        field: Bound<'py, PyAny>, path: Bound<'py, PyAny>, memory_limit: Option<Bound<'py, PyAny>>
    ) = {
        take!(field: physics::PupilField, path: Path);
        let limit = optional(memory_limit, "memory_limit")?;
        py.detach(|| Self::of(field, path, within(limit)))
    };

    /// Return the closed forms of a slice and of its join to the next.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    ///
    /// Returns
    /// -------
    /// SliceLaw
    call slice_law(py; index: Whole<'py>) -> Values<'py> = {
        let law = this.0.slice_law(this.slice(&index)?);
        let rows = |rows: &[&[f32]]| {
            let rows: Vec<_> = rows.iter().map(|row| row.to_vec()).collect();
            PyArray2::from_vec2(py, &rows)
        };
        let mean_square = rows(&law.mean_square.each_ref().map(|row| &row[..]))?;
        let covariance = rows(&law.covariance.each_ref().map(|row| &row[..]))?;
        let turns: Floats = law.turns.into();
        named_class(py, "SliceLaw")?.call1((mean_square, covariance, turns))
    };

    /// Return where the pupil of a slice stands, in its diameters along x and y.
    ///
    /// Parameters
    /// ----------
    /// index : int
    ///     Slice; negative ones count from the last.
    call offset(_py; index: Whole<'py>) -> (f64, f64) = {
        Ok(this.0.offset(this.slice(&index)?).into())
    };

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
    ///     Intensity in the common shape of the arguments.
    call intensity_at(py; x: Numbers<'py>, y: Numbers<'py>, u: Numbers<'py>) -> Values<'py> = {
        let places = columns!(LIMIT; x, y, u);
        let [intensity] = evaluate(py, places, [&[]], |[x, y, u], [out]| {
            this.0.intensity_batch(x, y, u, out);
        })?;
        Ok(intensity)
    };

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
    call amplitude_at(py;
        x: Numbers<'py>, y: Numbers<'py>, u: Numbers<'py>
    ) -> Bound<'py, PyAny> = {
        map_complex(py, columns!(LIMIT; x, y, u), |[x, y, u]| {
            this.0.amplitude_at(x, y, u)
        })
    };

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
    ///     Mean intensity in the common shape of x, y and u.
    call average_over(py;
        x: Numbers<'py>, y: Numbers<'py>, size: Numbers<'py>, u: Numbers<'py>
    ) -> Values<'py> = {
        let size: [f64; 2] = size.vector("size")?;
        if let Some(bad) = size.into_iter().find(|side| *side < 0.0) {
            return Err(refused(
                "size",
                format!("size must be 0 or more, got {bad}"),
            ));
        }
        map_inner(py, columns!(LIMIT; x, y, u), &[], |[x, y, u]| {
            [this.0.average_over([x, y], size, u)]
        })
    };

    /// Field the slices were cut from. That of a straight path closes on itself after the length of
    /// the path.
    get field -> PupilField = this.0.field().clone();

    /// Path of the pupil.
    get path -> SlicePath = this.0.path();

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
    ///     Shift in pupil diameters, to one side or the other; beyond the reach of the path it
    ///     counts as the reach.
    map coordinate_at(shift);

    shown size, speckle_size, path;
}
