//! The options of the commands that read a set-up.

use std::path::PathBuf;

use clap::Args;
use tem00_report::args::FileArgs;

/// A set-up, and where the report on it goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct SetupArgs {
    /// The set-up file, or - for standard input.
    #[arg(value_name = "SETUP.toml")]
    pub(crate) setup: PathBuf,

    #[command(flatten)]
    pub(crate) files: FileArgs,

    /// The folder for the files, made if it is missing [default: out/<name of the set-up>].
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    /// Threads to work with, 1 to 1024, four for each core at most; the result does not depend on it [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    /// Print JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
}
