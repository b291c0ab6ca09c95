use pyo3::{
    prelude::*,
    types::{PyTuple, PyType},
};
use tem00_speckle as physics;

use super::{
    arguments::counts, field::PupilField, options::StackOptions, path::SlicePath,
    stack::SpeckleStack,
};
use crate::{
    arrays::Whole,
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// Demands on a stack: image, motion and memory.
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
///     Largest motion of the pupil over the speckle, in its diameters; None if the speckle never
///     changes.
/// frames : int
///     Number of frames among which the speckle is compared.
/// memory_limit : int
///     Bytes that the slices may take.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StackNeeds(physics::StackNeeds);

#[pymethods]
impl StackNeeds {
    #[new]
    fn new(
        image: [f64; 2],
        region: [f64; 2],
        speckle_size: f64,
        motion: Option<f64>,
        frames: Whole<'_>,
        memory_limit: Whole<'_>,
    ) -> PyResult<Self> {
        Ok(Self(physics::StackNeeds {
            image,
            region,
            speckle_size,
            motion,
            frames: frames.unsigned("frames")?,
            memory_limit: memory_limit.unsigned("memory_limit")?,
        }))
    }

    fn __repr__(&self) -> String {
        let needs = &self.0;
        let motion = needs.motion.map_or("None".to_owned(), |m| m.to_string());
        format!(
            "StackNeeds(image={:?}, region={:?}, speckle_size={}, motion={motion}, frames={}, \
             memory_limit={})",
            self.image(),
            self.region(),
            needs.speckle_size,
            needs.frames,
            needs.memory_limit
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let needs = &slf.get().0;
        let arguments = (
            needs.image,
            needs.region,
            needs.speckle_size,
            needs.motion,
            needs.frames,
            needs.memory_limit,
        );
        Ok((slf.get_type(), arguments.into_pyobject(slf.py())?))
    }
}

methods! {
    impl StackNeeds as this: this.0;

    /// Width and height of the image in pixels.
    field image -> (f64, f64);

    /// Width and height of all that is looked up, in pixels.
    field region -> (f64, f64);

    /// Speckle size on the sensor in pixels.
    field speckle_size -> f64;

    /// Largest motion of the pupil in its diameters, or None.
    field motion -> Option<f64>;

    /// Number of frames among which the speckle is compared.
    field frames -> u32;

    /// Bytes that the slices may take.
    field memory_limit -> u64;
}

/// Sizes of a stack that repeats nothing where it is looked up and takes no more memory than that
/// needs.
///
/// Parameters
/// ----------
/// needs : StackNeeds
///     What the stack is to be looked up for.
///
/// Raises
/// ------
/// ParameterError
///     If a value of ``needs`` is out of range.
/// MemoryError
///     If not even the smallest stack fits the memory limit.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StackPlan(physics::StackPlan);

/// The largest number of plans to choose from: the longest list of candidates has a hundred.
const MAX_PLANS: usize = 1 << 16;

#[pymethods]
impl StackPlan {
    #[new]
    fn new(needs: &StackNeeds) -> PyResult<Self> {
        Ok(Self(physics::StackPlan::new(&needs.0).or_raise()?))
    }

    /// Return the plan of known sizes.
    ///
    /// Whether a pattern can have them is seen by its ``field``, as for the ``candidates``.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// diameter : (int, int)
    ///     Diameter of the pupil along each axis in lattice points.
    /// path : SlicePath
    ///     Path of the slices.
    #[staticmethod]
    fn from_sizes(
        size: [Whole<'_>; 2],
        diameter: [Whole<'_>; 2],
        path: &SlicePath,
    ) -> PyResult<Self> {
        let (size, diameter) = (counts("size", &size)?, counts("diameter", &diameter)?);
        Ok(Self(physics::StackPlan::from_sizes(size, diameter, path.0)))
    }

    /// Return the plans for ``needs`` in the order of their worth, whatever memory they take.
    ///
    /// Parameters
    /// ----------
    /// needs : StackNeeds
    ///     What the stack is to be looked up for.
    #[staticmethod]
    fn candidates(needs: &StackNeeds) -> PyResult<Vec<Self>> {
        let plans = physics::StackPlan::candidates(&needs.0).or_raise()?;
        Ok(plans.into_iter().map(Self).collect())
    }

    /// Return the first of ``plans`` that takes at most ``memory_limit`` bytes.
    ///
    /// Parameters
    /// ----------
    /// plans : sequence of StackPlan
    ///     Plans in the order of their worth, at most 65,536.
    /// memory_limit : int
    ///     Bytes that the slices may take.
    #[staticmethod]
    fn first_within(plans: &Bound<'_, PyAny>, memory_limit: Whole<'_>) -> PyResult<Self> {
        let count = plans.len()?;
        if count > MAX_PLANS {
            let message = format!("plans must be at most {MAX_PLANS}, got {count}");
            return Err(refused("plans", message));
        }
        let plans: Vec<PyRef<'_, Self>> = plans.extract()?;
        let plans = plans.iter().map(|plan| plan.0);
        let limit = memory_limit.unsigned("memory_limit")?;
        Ok(Self(
            physics::StackPlan::first_within(plans, limit).or_raise()?,
        ))
    }

    /// Return the place in a stack of one of several patterns that share it, in periods along x and y.
    ///
    /// Parameters
    /// ----------
    /// number : int
    ///     Number of the pattern; the first, 0, is at the origin.
    #[staticmethod]
    fn place(number: Whole<'_>) -> PyResult<(f64, f64)> {
        Ok(physics::StackPlan::place(number.unsigned("number")?).into())
    }

    /// Return the plan with a square pattern.
    ///
    /// Parameters
    /// ----------
    /// size : int
    ///     Side of the pattern in samples.
    /// diameter : int
    ///     Diameter of the pupil in lattice points.
    fn with_square(&self, size: Whole<'_>, diameter: Whole<'_>) -> PyResult<Self> {
        let (size, diameter) = (size.unsigned("size")?, diameter.unsigned("diameter")?);
        let plan = self.0.with_square(size, diameter);
        plan.field(0).or_raise()?;
        Ok(Self(plan))
    }

    /// Return the plan with 2 * ``half_period`` slices on its path.
    ///
    /// Parameters
    /// ----------
    /// half_period : int
    ///     Half the number of slices.
    fn with_half_period(&self, half_period: Whole<'_>) -> PyResult<Self> {
        let plan = self
            .0
            .with_half_period(half_period.unsigned("half_period")?);
        plan.path().check().or_raise()?;
        Ok(Self(plan))
    }

    /// Return the plan with its slices on the circle of Bergmann et al. 2016.
    fn on_circle(&self) -> PyResult<Self> {
        let plan = self.0.on_circle();
        plan.path().check().or_raise()?;
        Ok(Self(plan))
    }

    /// Return whether the pattern repeats nothing within the region.
    fn holds_region(&self, needs: &StackNeeds) -> bool {
        self.0.holds_region(&needs.0)
    }

    /// Return whether each frame has the speckle of its own motion.
    fn holds_motion(&self, needs: &StackNeeds) -> bool {
        self.0.holds_motion(&needs.0)
    }

    /// Return the pupil field of this plan.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    fn field(&self, seed: Whole<'_>) -> PyResult<PupilField> {
        Ok(PupilField(self.0.field(seed.unsigned("seed")?).or_raise()?))
    }

    /// Generate the stack of this plan.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    /// options : StackOptions
    ///     Memory limit.
    fn stack(
        &self,
        py: Python<'_>,
        seed: Whole<'_>,
        options: &StackOptions,
    ) -> PyResult<SpeckleStack> {
        let seed = seed.unsigned("seed")?;
        let field = self.0.field(seed).or_raise()?;
        let stack = py.detach(|| self.0.stack(seed, options.0));
        Ok(SpeckleStack(stack.or_raise()?, field))
    }

    fn __repr__(&self) -> String {
        format!(
            "StackPlan.from_sizes(size={:?}, diameter={:?}, path={})",
            self.size(),
            self.diameter(),
            self.path().__repr__()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        let sizes = (self.size(), self.diameter(), self.path());
        by_constructor::<Self>(py, "from_sizes", sizes)
    }
}

methods! {
    impl StackPlan as this: this.0;

    /// Width and height of the pattern in samples.
    get size -> (usize, usize);

    /// Diameter of the pupil along each axis in lattice points.
    get diameter -> (usize, usize);

    /// Path of the slices.
    get path -> SlicePath = SlicePath(this.0.path());

    /// Bytes that the slices take.
    get memory_bytes -> u64;

    /// Slices that a motion of the pupil by its diameter passes.
    get slices_per_diameter -> f64;

    /// Largest motion of the pupil that the slices tell apart from every smaller one, in diameters.
    get reach -> f64;
}
