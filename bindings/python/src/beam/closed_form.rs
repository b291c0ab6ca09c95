//! The closed forms as source text.

use pyo3::prelude::*;

/// The closed forms of irradiance and next event, as source text for kernels and for C.
///
/// A kernel on a GPU copies the rows of a placed light, ``light.to_rows()``, and evaluates it
/// itself: the structs have the same layout on both sides.
#[pymodule(submodule)]
pub(crate) mod closed_form {
    /// Irradiance and next event of all lights in WGSL: functions and structs without bindings.
    #[pymodule_export]
    const WGSL: &str = tem00_beam::closed_form::WGSL;

    /// The header tem00_beam.h: irradiance and next event of all lights in C99.
    #[pymodule_export]
    const C_HEADER: &str = tem00_beam::closed_form::C_HEADER;
}
