//! Bindings of `tem00-speckle`, the module `tem00.speckle`.

use pyo3::prelude::*;

mod arguments;
mod exposure;
mod field;
mod images;
mod options;
mod path;
mod pattern;
mod plan;
mod pupil;
mod seed;
mod slice_law;
mod stack;
mod sum;

/// Pupil fields, patterns, stacks and their look-up.
///
/// Images are indexed [row, column]; sizes and positions are (x, y), width before height.
#[pymodule(submodule)]
pub(crate) mod speckle {
    #[pymodule_export]
    use super::{
        exposure::Exposure,
        field::PupilField,
        options::StackOptions,
        path::SlicePath,
        pattern::{SpeckleField, SpecklePattern},
        plan::{StackNeeds, StackPlan},
        pupil::{Pupil, Transmission},
        seed::derived_seed,
        slice_law::SliceLaw,
        stack::SpeckleStack,
        sum::incoherent_fractions,
    };
}
