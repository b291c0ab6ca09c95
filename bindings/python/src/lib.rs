//! Python bindings of tem00, the extension module `tem00._tem00`.
//!
//! One file for each physics crate; `arrays` takes NumPy arrays in and gives them out, `error`
//! makes Python exceptions of the errors; `methods` declares what only hands on. `main` and
//! `inspect` are the programs.

#[macro_use]
mod methods;

#[macro_use]
mod classes;

#[macro_use]
mod functions;

mod arguments;
mod arrays;
mod beam;
mod coherence;
mod decorrelation;
mod error;
mod pickling;
mod shading;
mod speckle;
mod statistics;

use pyo3::prelude::*;

/// Runs the program ``tem00`` with the arguments of this process; returns the exit code.
#[cfg(not(target_family = "wasm"))]
#[pyfunction]
fn main(py: Python<'_>) -> PyResult<u8> {
    run(py, tem00_cli::run)
}

/// Runs the program ``tem00-inspect`` with the arguments of this process; returns the exit code.
#[cfg(not(target_family = "wasm"))]
#[pyfunction]
fn inspect(py: Python<'_>) -> PyResult<u8> {
    run(py, tem00_inspect::run)
}

#[cfg(not(target_family = "wasm"))]
fn run(py: Python<'_>, program: fn(&[std::ffi::OsString]) -> u8) -> PyResult<u8> {
    let arguments: Vec<std::ffi::OsString> = py.import("sys")?.getattr("argv")?.extract()?;
    Ok(py.detach(|| program(&arguments)))
}

#[pymodule]
mod _tem00 {
    #[pymodule_export]
    use super::{
        beam::beam, coherence::coherence, decorrelation::decorrelation, error::ParameterError,
        shading::shading, speckle::speckle, statistics::statistics,
    };

    #[cfg(not(target_family = "wasm"))]
    #[pymodule_export]
    use super::{inspect, main};

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
