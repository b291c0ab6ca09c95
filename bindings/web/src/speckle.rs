//! The speckle of a lens at its distance, on the card.

use tem00_decorrelation::ImagingGeometry;
use tem00_gpu::{Gpu, GpuStack};
use tem00_numerics::cast::to_usize;
use tem00_shading::{Camera, KernelFrame, Laser, Pose, ShadingError};
use tem00_speckle::{PupilField, SlicePath, SpeckleError, SpeckleStack, StackNeeds, StackPlan};

use crate::{
    AnyError,
    optics::{self, SENSOR},
    settings::Values,
};

/// The slices may take so many bytes: what every card lets a kernel see of one buffer.
const MEMORY: u64 = 128 << 20;
/// The largest motion of the pupil over the speckle that is looked up, in its diameters.
const MOTION: f64 = 1.0;

/// A stack, and its sizes.
#[derive(Debug)]
pub struct Speckle {
    /// The stack.
    pub stack: GpuStack,
    plan: StackPlan,
}

/// Sizes of the speckle that repeats nothing in an image of so many pixels.
///
/// # Errors
///
/// Returns an error if the image holds more speckles than the largest pattern.
pub fn plan(
    image: [f64; 2],
    geometry: &ImagingGeometry,
    memory_limit: u64,
) -> Result<StackPlan, SpeckleError> {
    StackPlan::new(&StackNeeds {
        image,
        region: image,
        speckle_size: geometry.speckle_size_in_pixels(),
        motion: Some(MOTION),
        frames: 2,
        memory_limit,
    })
}

/// The struct `Tem00SpeckleFrame` of a part in a pose, for the stack of a plan.
///
/// # Errors
///
/// Returns an error if a number overflows in single precision.
pub fn frame(
    camera: &Camera,
    laser: &Laser,
    pose: Pose,
    plan: &StackPlan,
) -> Result<[[f32; 4]; 14], ShadingError> {
    let (motion, reach) = (&pose.into(), plan.reach());
    KernelFrame {
        camera,
        laser,
        motion,
        plan,
        reach,
    }
    .to_rows()
}

/// A part at rest needs one slice.
fn is_at_rest(values: &Values) -> bool {
    [values.slide, values.lift, values.tilt]
        .iter()
        .all(|x| x.abs() <= 0.0)
}

impl Speckle {
    /// Plans the stack and makes it on the card.
    ///
    /// # Errors
    ///
    /// Returns an error if the settings make no camera or no stack, or if the card fails.
    pub fn new(gpu: &Gpu, values: &Values) -> Result<Self, AnyError> {
        Self::planned(values, |field, path| {
            Ok(GpuStack::generate(gpu, field, path)?)
        })
    }

    /// Builds the speckle with a stack made by the library, for comparison.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn of_library(gpu: &Gpu, values: &Values) -> Result<Self, AnyError> {
        Self::planned(values, |field, path| {
            Ok(GpuStack::upload(
                gpu,
                &SpeckleStack::generate(field, path)?,
            )?)
        })
    }

    fn planned(
        values: &Values,
        make: impl FnOnce(&PupilField, SlicePath) -> Result<GpuStack, AnyError>,
    ) -> Result<Self, AnyError> {
        let geometry = optics::geometry(values)?;
        let plan = plan(SENSOR.map(f64::from), &geometry, MEMORY)?;
        let field = plan.field(to_usize(values.seed) as u64)?;
        let path = match is_at_rest(values) {
            true => SlicePath::Still,
            false => plan.path(),
        };
        let stack = make(&field, path)?;
        Ok(Self { stack, plan })
    }

    /// Returns whether the slices here suffice for settings with the same lens and seed.
    pub fn suffices(&self, values: &Values) -> bool {
        is_at_rest(values) || self.stack.slice_count() > 1
    }

    /// The rows of the struct `Tem00SpeckleFrame`.
    ///
    /// # Errors
    ///
    /// Returns an error if the settings make no camera, no laser or no pose.
    pub fn rows(&self, values: &Values) -> Result<[[f32; 4]; 14], AnyError> {
        let (camera, laser) = (optics::camera(values)?, optics::laser(values)?);
        Ok(frame(&camera, &laser, optics::pose(values)?, &self.plan)?)
    }
}
