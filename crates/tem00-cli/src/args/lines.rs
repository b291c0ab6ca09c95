//! The command line of `tem00 lines`.

use std::path::PathBuf;

use clap::Args;

/// Find laser lines in images, to a fraction of a pixel.
#[derive(Args, Debug)]
pub(crate) struct LinesArgs {
    /// The images: PNG or TIFF of 8 to 16 bits.
    #[arg(required = true, value_name = "IMAGE")]
    pub(crate) images: Vec<PathBuf>,
}
