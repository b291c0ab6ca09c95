//! The speckle of a lens at its distance, on the card.

use tem00_gpu::{Gpu, GpuStack};
use tem00_numerics::cast::to_usize;
use tem00_speckle::{PupilField, SlicePath, SpeckleStack};

use crate::{
    AnyError,
    optics::{self, View},
    settings::Values,
};

/// A stack, and what turns a correlation into its slices.
#[derive(Debug)]
pub struct Speckle {
    /// The stack.
    pub stack: GpuStack,
    /// The width of a speckle, in samples.
    pub size: f64,
    /// The overlaps of the pupils of its slices with the first and with the next, up to the first without.
    pub overlaps: Vec<[f32; 2]>,
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

    /// The same, with a stack that the library has made: to be compared.
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
        let plan = optics::plan(&View::new(values)?)?;
        let field = plan.field(to_usize(values.seed) as u64)?;
        let path = match is_at_rest(values) {
            true => SlicePath::Still,
            false => plan.path(),
        };
        Ok(Self {
            stack: make(&field, path)?,
            size: field.speckle_size(),
            overlaps: path.overlaps(field.pupil())?,
        })
    }

    /// Whether these settings, of the same lens and seed, find their slices here.
    pub fn suffices(&self, values: &Values) -> bool {
        is_at_rest(values) || self.stack.slice_count() > 1
    }
}
