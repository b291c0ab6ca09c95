//! Bindings of `tem00-speckle`, the module `tem00.speckle`.

use pyo3::prelude::*;

mod field;
mod images;
mod path;
mod pattern;
mod plan;
mod pupil;
mod stack;

/// Pupil fields, patterns, stacks and their look-up.
///
/// Images are indexed [row, column]; sizes and positions are (x, y), width before height.
#[pymodule(submodule)]
pub(crate) mod speckle {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        field::{PupilField, derived_seed, incoherent_fractions},
        path::SlicePath,
        pattern::{SpeckleField, SpecklePattern},
        plan::StackPlan,
        pupil::Pupil,
        stack::SpeckleStack,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::arrays::add_named(module, &["SliceLaw"])
    }
}
