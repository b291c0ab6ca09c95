//! The command line of `tem00 calibrate`.

use std::path::PathBuf;

use clap::Args;

/// Calibrate camera and laser plane from photographs of a checkerboard and of the line on it.
#[derive(Args, Debug)]
pub(crate) struct CalibrateArgs {
    /// The folder with the photographs.
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,
}
