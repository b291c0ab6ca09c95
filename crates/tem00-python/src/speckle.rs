//! Bindings of `tem00-speckle`, the module `tem00.speckle`.

use pyo3::prelude::*;

mod arguments;
mod field;
mod files;
mod images;
mod light;
mod objective;
mod paper;
mod path;
mod pattern;
mod plan;
mod pupil;
mod stack;
mod sum;

/// Pupil fields, patterns, stacks and their look-up.
///
/// Images are indexed [row, column]; sizes and positions are (x, y), width before height.
#[pymodule(submodule)]
pub(crate) mod speckle {
    #[pymodule_export]
    use super::{
        field::PupilField,
        light::{CoherentBackground, Exposure, PixelArray},
        objective::{LitArea, ObjectiveSpeckle},
        paper::paper,
        path::SlicePath,
        pattern::{SpeckleField, SpecklePattern},
        plan::{StackNeeds, StackPlan},
        pupil::{Pupil, Transmission},
        stack::{SliceLaw, SpeckleStack, StackOptions},
        sum::{Bandwidth, IncoherentSum},
    };
}
