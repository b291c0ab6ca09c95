//! Python bindings of tem00, the extension module `tem00._tem00`.
//!
//! One file for each physics crate; `arrays` takes NumPy arrays in and gives them out, `error`
//! makes Python exceptions of the errors; `methods` declares what only hands on.

#[macro_use]
mod methods;

mod arrays;
mod beam;
mod decorrelation;
mod error;
mod pickling;
mod speckle;
mod statistics;

use pyo3::prelude::*;

#[pymodule]
mod _tem00 {
    #[pymodule_export]
    use super::{
        beam::beam, decorrelation::decorrelation, error::ParameterError, speckle::speckle,
        statistics::statistics,
    };

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
