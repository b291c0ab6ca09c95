//! The command line of `tem00-inspect sweep`.

use std::path::PathBuf;

use clap::Args;
use tem00_report::args::IndexRange;

/// Run a command for all combinations of given values, on one machine or on many.
///
/// The grid file names a command, its file, the keys that vary and the results to keep. Every
/// combination is a task with a number. A task that is done leaves a row in the folder and is not
/// done again, unless the file, its options or its values have changed; rows appear whole or not at
/// all, so that tasks may be shared among machines that share the folder, in any way, and after any
/// stop. The table is the same.
#[derive(Args, Debug)]
#[command(after_help = SWEEP_EXAMPLES)]
pub(crate) struct SweepArgs {
    /// The grid file.
    #[arg(value_name = "GRID.toml")]
    pub(crate) grid: PathBuf,

    /// The folder for the rows, the table and the files of all tasks, made if it is missing
    /// [default: out/<name of the grid>].
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,

    /// Print all tasks and their values as a table (CSV), and do none.
    #[arg(long, conflicts_with_all = ["tasks", "gather"])]
    pub(crate) list: bool,

    /// Do these tasks alone, counted from 0: one, or FIRST..LAST with both ends; makes no table.
    #[arg(long = "task", value_name = "N|FIRST..LAST", conflicts_with = "gather")]
    pub(crate) tasks: Option<IndexRange>,

    /// Make the table of the rows that are there, and do no task.
    #[arg(long)]
    pub(crate) gather: bool,

    /// Number of threads, 1 to 1024 and at most four per core; it does not change the result
    /// [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

const SWEEP_EXAMPLES: &str = "\
Examples:
  tem00-inspect sweep examples/setups/sweeps/lens_and_line.toml            all tasks, and the table
  tem00-inspect sweep examples/setups/sweeps/lens_and_line.toml --list     what the tasks are
  tem00-inspect sweep examples/setups/sweeps/lens_and_line.toml --task 3   one of them
  tem00-inspect sweep examples/setups/sweeps/lens_and_line.toml --gather   the table

Files:
  sweep.csv             a row for each task: its values, its results, and whether it has any
  rows/000003.json …    the row of a task
  tasks/000003/ …       the files of the command";
