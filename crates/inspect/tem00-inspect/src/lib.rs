//! The program `tem00-inspect`, which its own binary or the Python package starts.
//! `docs/program.md` in the repository describes its commands.

mod args;
mod bandwidth;
mod budget;
mod calibrate;
mod calibration_file;
mod characterise;
mod date;
mod design;
mod lines;
mod list;
mod saturated_points;
mod source_colours;
mod sweep;
mod triangulate;
mod units;

use std::{ffi::OsString, io::Write, path::Path};

use clap::CommandFactory;
use tem00_report::{failure::Failure, output, program, shell};
use tem00_speckle::SpeckleError;
use tem00_triangulation::TriangulationError;

use crate::args::{Cli, Command};

/// Runs the program with the arguments of a process, the first of which is its own name, and
/// returns the exit code.
///
/// Takes over Ctrl-C and the termination signals of the process: a second signal ends the process
/// at once.
pub fn run(arguments: &[OsString]) -> u8 {
    program::run(arguments, execute)
}

/// Executes the command and prints its results to `out`.
fn execute(cli: &Cli, out: &mut impl Write) -> Result<(), Failure> {
    if cli.quiet {
        output::set_quiet();
    }
    match &cli.command {
        Command::Budget(args) => budget::run(args, out),
        Command::Design(args) => design::run(args, out),
        Command::Characterise(args) => characterise::run(args, out),
        Command::Triangulate(args) => triangulate::run(args, out),
        Command::Lines(args) => lines::run(args, out),
        Command::Calibrate(args) => calibrate::run(args, out),
        Command::Sweep(args) => sweep::run(args, out),
        Command::List(args) => list::run(args, out),
        Command::Completions(args) => shell::completions(args, Cli::command(), out),
        Command::Man(args) => shell::man(args, Cli::command(), out),
    }
}

/// Returns the failure that a set-up does not measure, or that the user interrupted it.
fn measuring(path: &Path, error: &TriangulationError, help: &str) -> Failure {
    if *error == TriangulationError::Cancelled {
        return Failure::Interrupted;
    }
    let no_memory = matches!(
        error,
        TriangulationError::Speckle(SpeckleError::Memory { .. })
    );
    Failure::refused(no_memory, format!("{}: {error}", path.display()), help)
}
