//! The command line of `tem00 budget`.

use std::path::PathBuf;

use clap::Args;

/// Say what height uncertainty a set-up gives, and what dominates it.
#[derive(Args, Debug)]
pub(crate) struct BudgetArgs {
    /// The set-up file.
    #[arg(value_name = "SETUP.toml")]
    pub(crate) setup: PathBuf,
}
