//! The command line of `tem00 triangulate`.

use std::path::PathBuf;

use clap::Args;

/// Render what a triangulation sensor sees, and measure the part from it.
#[derive(Args, Debug)]
pub(crate) struct TriangulateArgs {
    /// The scene file, with the sections [sensor] and [detector].
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene: PathBuf,
}
