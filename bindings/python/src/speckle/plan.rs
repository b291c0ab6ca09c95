use pyo3::prelude::*;
use tem00_speckle::{self as physics, SlicePath as Path};

use super::{
    field::PupilField,
    path::SlicePath,
    stack::{SpeckleStack, within},
};
use crate::{arguments::optional, error::OrRaise};

class! {
    /// Sizes of a stack that repeats nothing where it is looked up and takes no more memory than
    /// that needs.
    ///
    /// Parameters
    /// ----------
    /// image : (float, float)
    ///     Width and height of the image in pixels.
    /// region : (float, float)
    ///     Width and height of all that is looked up in any frame, in pixels.
    /// speckle_size : float
    ///     Speckle size on the sensor in pixels.
    /// motion : float or None
    ///     Largest motion of the pupil over the speckle, in its diameters; None if the speckle
    ///     never changes.
    /// frames : int
    ///     Number of frames among which the speckle is compared.
    /// memory_limit : int
    ///     Bytes that the slices may take.
    ///
    /// Raises
    /// ------
    /// MemoryError
    ///     If not even the smallest stack fits the memory limit.
    "tem00.speckle" StackPlan(physics::StackPlan): Copy
}

#[pymethods]
impl StackPlan {
    /// Return the place in a stack of one of several patterns that share it, in periods along x and
    /// y.
    ///
    /// Parameters
    /// ----------
    /// number : int
    ///     Number of the pattern; the first, 0, is at the origin.
    #[staticmethod]
    fn place(number: Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
        take!(number: usize);
        Ok(physics::StackPlan::place(number).into())
    }
}

methods! {
    impl StackPlan as this: this.0;

    /// Generate the stack of this plan.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    /// memory_limit : int, optional
    ///     Bytes that the slices may take; by default all that the machine has.
    #[pyo3(signature = (seed, memory_limit = None))]
    call stack(py;
        seed: Bound<'py, PyAny>, memory_limit: Option<Bound<'py, PyAny>>
    ) -> SpeckleStack = {
        take!(seed: u64);
        let limit = optional(memory_limit, "memory_limit")?;
        let field = this.0.field(seed).or_raise()?;
        py.detach(|| SpeckleStack::of(field, this.0.path(), within(limit)))
    };

    make new(
        image: [f64; 2], region: [f64; 2], speckle_size: f64, motion: Option<f64>, frames: u32,
        memory_limit: u64
    ) = physics::StackPlan::new(&physics::StackNeeds {
        image, region, speckle_size, motion, frames, memory_limit,
    });

    /// Return the plan of known sizes; whether a pattern can have them is seen by its ``field``.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// diameter : (int, int)
    ///     Diameter of the pupil along each axis in lattice points.
    /// path : SlicePath
    ///     Path of the slices.
    make from_sizes(size: [usize; 2], diameter: [usize; 2], path: Path) =
        PyResult::Ok(physics::StackPlan::from_sizes(size, diameter, path));

    /// Return the plan with a square pattern.
    ///
    /// Parameters
    /// ----------
    /// size : int
    ///     Side of the pattern in samples.
    /// diameter : int
    ///     Diameter of the pupil in lattice points.
    try with_square(size: usize, diameter: usize) -> StackPlan = {
        let plan = this.0.with_square(size, diameter);
        plan.field(0).map(|_| plan)
    };

    /// Return the pupil field of this plan.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    try field(seed: u64) -> PupilField = this.0.field(seed);

    /// Width and height of the pattern in samples.
    get size -> (usize, usize);

    /// Diameter of the pupil along each axis in lattice points.
    get diameter -> (usize, usize);

    /// Path of the slices.
    get path -> SlicePath = this.0.path();

    /// Bytes that the slices take.
    get memory_bytes -> u64;

    /// Slices that a motion of the pupil by its diameter passes.
    get slices_per_diameter -> f64;

    /// Largest motion of the pupil that the slices tell apart from every smaller one, in diameters.
    get reach -> f64;

    made_by from_sizes(size, diameter, path);
}
