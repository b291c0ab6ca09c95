//! The command line of `tem00 design`.

use std::path::PathBuf;

use clap::Args;

/// Search set-ups for the least height uncertainty under constraints.
#[derive(Args, Debug)]
pub(crate) struct DesignArgs {
    /// The set-up file, with the section [design].
    #[arg(value_name = "SETUP.toml")]
    pub(crate) setup: PathBuf,
}
