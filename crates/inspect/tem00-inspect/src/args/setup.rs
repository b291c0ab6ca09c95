//! The options of the commands that read a set-up.

use std::path::PathBuf;

use clap::Args;
use tem00_config::{Document, Problem};
use tem00_report::{
    args::FileArgs,
    failure::Failure,
    folder_lock::FolderLock,
    kind::{Kind, wrong_or},
    output,
};
use tem00_triangulation::{Setup, read_setup_with};

/// The help for a file that is not a set-up.
pub(crate) const SETUP_HELP: &str =
    "examples/setups/ has set-up files, and docs/setup_file.md explains how to write them";

/// A set-up, and where the report on it goes.
#[derive(Args, Clone, Debug)]
pub(crate) struct SetupArgs {
    /// The set-up file, or - for standard input.
    #[arg(value_name = "SETUP.toml")]
    pub(crate) setup: PathBuf,

    #[command(flatten)]
    pub(crate) files: FileArgs,

    /// Output folder, created if missing [default: out/<name of the set-up>].
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    /// Number of threads, 1 to 1024 and at most four per core; it does not change the result
    /// [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,

    /// Print JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
}

impl SetupArgs {
    /// Reads the set-up, and what a command wants of its file besides.
    pub(crate) fn read<T>(
        &self,
        help: &str,
        read: impl FnOnce(&Document<'_>, &Setup) -> Result<T, Problem>,
    ) -> Result<(Setup, T), Failure> {
        read_setup_with(&self.setup, self.files.reading(), read).map_err(|error| {
            wrong_or(&self.setup, Kind::Setup, || {
                Failure::file(&self.setup, &error, help)
            })
        })
    }

    /// Takes the folder for the files; `otherwise` is its name where the set-up has none.
    pub(crate) fn folder(&self, otherwise: &str) -> Result<(PathBuf, FolderLock), Failure> {
        let name = output::name(&self.setup, otherwise);
        let folder = output::folder(self.output.as_deref(), &name);
        let lock = output::prepare(&folder)?;
        Ok((folder, lock))
    }
}
