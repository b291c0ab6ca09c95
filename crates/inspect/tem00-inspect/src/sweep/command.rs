//! The command of a sweep.

use std::{ffi::OsStr, io, path::PathBuf};

use clap::Args;
use tem00_cli::RenderArgs;
use tem00_config::Change;
use tem00_report::failure::Failure;

use super::grid::{Grid, Swept};
use crate::{
    args::{BudgetArgs, TriangulateArgs},
    budget, triangulate,
};

/// The help for options and values that a command does not take.
pub(super) const HELP: &str = "the grid names the options and the keys";

/// A command with the options and the file that all tasks have in common.
pub(super) enum SweptCommand {
    Budget(BudgetArgs),
    Render(Box<RenderArgs>),
    Triangulate(TriangulateArgs),
}

impl SweptCommand {
    /// Reads the options of a grid.
    pub(super) fn of(grid: &Grid) -> Result<Self, Failure> {
        Ok(match grid.command {
            Swept::Budget => Self::Budget(parsed(grid)?),
            Swept::Render => Self::Render(Box::new(parsed(grid)?)),
            Swept::Triangulate => Self::Triangulate(parsed(grid)?),
        })
    }

    /// Executes the command with changes of its file. Its printed output is in its files as well.
    pub(super) fn run(
        &self,
        changes: &[Change],
        folder: PathBuf,
        threads: Option<u16>,
    ) -> Result<(), Failure> {
        macro_rules! run {
            ($args:ident, $command:path) => {{
                let mut args = $args.clone();
                args.common.files = args.common.files.with(changes);
                args.common.output = Some(folder);
                args.common.threads = threads.or(args.common.threads);
                $command(&args, &mut io::sink())
            }};
        }
        match self {
            Self::Budget(args) => run!(args, budget::run),
            Self::Render(args) => run!(args, tem00_cli::render),
            Self::Triangulate(args) => run!(args, triangulate::run),
        }
    }
}

/// Returns the options of a command and its file, whose name may be the name of an option.
fn parsed<A: Args>(grid: &Grid) -> Result<A, Failure> {
    let command = A::augment_args(clap::Command::new(grid.command.name()).no_binary_name(true));
    let options = grid.options.iter().map(OsStr::new);
    let words = options.chain([OsStr::new("--"), grid.file.as_os_str()]);
    let matches = command.try_get_matches_from(words);
    let parsed = matches.and_then(|matches| A::from_arg_matches(&matches));
    parsed.map_err(|error| {
        let text = error.to_string();
        let message = text.trim_start_matches("error: ").replace('\n', " ");
        Failure::input(format!("`options`: {message}"), HELP)
    })
}
