use tem00_speckle::{PupilField, SpeckleError, SpeckleStack, StackOptions, StackPlan};

use super::Stack;
use crate::{
    numbers::code,
    pointers::borrow,
    status::{Failure, Status},
    threads::on_threads,
};

/// The way the pupil takes from slice to slice of a stack.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlicePath {
    /// Single slice: the pattern moves, but does not change.
    Still = 0,
    /// A circle, as of Bergmann et al. 2016: slices are uncorrelated after `half_period`.
    Circle = 1,
    /// A straight line of `length` pupil diameters: a motion over `length` - 1 diameters never
    /// returns to speckle it has left.
    Straight = 2,
}

/// Parameters of a stack.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct StackDescription {
    /// Width of the pattern, in samples, after which it repeats.
    pub width: usize,
    /// Height of the pattern, in samples.
    pub height: usize,
    /// Diameter of the pupil along the width, in lattice points: the speckles after which the
    /// pattern repeats, from 8 to half the width. 0 if `speckle_size` is to say it.
    pub diameter: usize,
    /// Speckle size in samples, at least 2 and at most an eighth of the smaller side; read if
    /// `diameter` is 0, else it is width / diameter.
    pub speckle_size: f64,
    /// Seed of the pattern.
    pub seed: u64,
    /// The way the pupil takes: a `tem00_slice_path`.
    pub path: u32,
    /// Half the number of slices, not read for a still path.
    pub half_period: usize,
    /// Length of a straight path in pupil diameters, at least 2; not read for others.
    pub length: usize,
    /// Bytes that the slices may take; `UINT64_MAX` for all the machine has.
    pub memory_limit: u64,
    /// Number of threads that generate it, at most 1024; 0 for all the cores of the machine. The
    /// stack is the same, to the last bit, for any number.
    pub threads: u32,
}

/// Demands on a stack: image, motion and memory.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct StackNeeds {
    /// Width and height of the image, in pixels.
    pub image: [f64; 2],
    /// Width and height of all that is looked up in any frame, in pixels: the image, and what
    /// motion brings in.
    pub region: [f64; 2],
    /// Speckle size on the sensor, in pixels.
    pub speckle_size: f64,
    /// 1 if the speckle changes, 0 if it never does.
    pub changes: u32,
    /// Largest motion of the pupil over the speckle, in its diameters; not read if nothing changes.
    pub motion: f64,
    /// Number of frames among which the speckle is compared.
    pub frames: u32,
    /// Bytes that the slices may take.
    pub memory_limit: u64,
}

impl StackDescription {
    fn stack(&self) -> Result<Stack, Failure> {
        let (path, field) = (self.slice_path()?, self.field()?);
        let options = StackOptions {
            memory_limit: self.memory_limit,
        };
        let stack = on_threads(self.threads, || {
            SpeckleStack::generate_with(&field, path, options)
        })?;
        Ok(Stack(stack?))
    }

    /// The field; a refusal names what the description says.
    fn field(&self) -> Result<PupilField, Failure> {
        self.field_of_sizes().map_err(|error| {
            let parameter = match error.parameter() {
                "size" if self.width >= self.height => "width",
                "size" => "height",
                "speckle_size" if self.diameter > 0 => "diameter",
                other => other,
            };
            Failure::argument(parameter, error)
        })
    }

    /// The field of a plan of these sizes has the same bits.
    fn field_of_sizes(&self) -> Result<PupilField, SpeckleError> {
        let size = [self.width, self.height];
        if self.diameter == 0 {
            return PupilField::from_speckle_size(size, self.speckle_size, self.seed);
        }
        if self.width == self.height {
            return PupilField::new(self.width, self.diameter, self.seed);
        }
        let speckle_size = self.width as f64 / self.diameter as f64;
        PupilField::from_speckle_size(size, speckle_size, self.seed)
    }

    fn slice_path(&self) -> Result<tem00_speckle::SlicePath, Failure> {
        use tem00_speckle::SlicePath::{Circle, Still, Straight};
        let (half_period, length) = (self.half_period, self.length);
        let straight = Straight {
            half_period,
            length,
        };
        code(
            "path",
            self.path,
            &[Still, Circle { half_period }, straight],
        )
    }
}

impl StackNeeds {
    fn plan(&self) -> Result<StackDescription, Failure> {
        let changes = code("changes", self.changes, &[false, true])?;
        let plan = StackPlan::new(&tem00_speckle::StackNeeds {
            image: self.image,
            region: self.region,
            speckle_size: self.speckle_size,
            motion: changes.then_some(self.motion),
            frames: self.frames,
            memory_limit: self.memory_limit,
        })?;
        let [width, height] = plan.size();
        let (path, half_period, length) = path_numbers(plan.path());
        Ok(StackDescription {
            width,
            height,
            diameter: plan.diameter()[0],
            speckle_size: plan.field(0)?.speckle_size(),
            seed: 0,
            path: path as u32,
            half_period,
            length,
            memory_limit: self.memory_limit,
            threads: 0,
        })
    }
}

/// The path, its half period and its length as C counts them.
pub(super) fn path_numbers(path: tem00_speckle::SlicePath) -> (SlicePath, usize, usize) {
    use tem00_speckle::SlicePath as P;
    match path {
        P::Still => (SlicePath::Still, 0, 0),
        P::Circle { half_period } => (SlicePath::Circle, half_period, 0),
        P::Straight {
            half_period,
            length,
        } => (SlicePath::Straight, half_period, length),
    }
}

/// Generates a stack, 8 bytes for each sample of each slice, on the threads that its description
/// asks for.
///
/// On failure `*stack` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_create(
    description: *const StackDescription,
    stack: *mut *mut Stack,
) -> Status {
    create!(description: borrow => stack: description.stack())
}

/// Chooses a stack that repeats nothing in the region and takes no more memory than allowed: writes
/// its description, with the seed 0 and all the cores of the machine, for `tem00_stack_create`.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_plan(
    needs: *const StackNeeds,
    description: *mut StackDescription,
) -> Status {
    answer!(needs: borrow => description: needs.plan()?)
}
