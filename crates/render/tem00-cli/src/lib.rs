//! The program `tem00`, which its own binary or the Python package starts. `docs/program.md` in the
//! repository describes its commands.

mod args;
mod comparison;
mod frame_files;
mod inspection;
mod list;
mod pattern;
mod preview;
mod render;
mod speckle;
mod stats;
mod summary;

use std::{
    ffi::OsString,
    io::{self, Write},
    path::Path,
};

use clap::CommandFactory;
use tem00_report::{atomic::probe_writable, failure::Failure, output, program, shell};

use crate::args::{Cli, Command};
pub use crate::{
    args::{RenderArgs, SceneArgs},
    frame_files::check_room,
    inspection::Inspection,
    render::{frames, run as render, tracer_failure},
};

/// The commands of `tem00-inspect`.
const INSPECTION: &str = "budget calibrate characterise design lines sweep triangulate";

/// Runs the program with the arguments of a process, the first of which is its own name, and
/// returns the exit code.
///
/// Takes over Ctrl-C and the termination signals of the process: a second signal ends the process
/// at once.
pub fn run(arguments: &[OsString]) -> u8 {
    let command = arguments.get(1).and_then(|command| command.to_str());
    let is_other = |command: &&str| INSPECTION.split(' ').any(|other| other == *command);
    if let Some(command) = command.filter(is_other) {
        let _ = writeln!(
            io::stderr(),
            "`{command}` is a command of the program tem00-inspect: `tem00-inspect {command}`"
        );
        return 2;
    }
    program::run(arguments, execute)
}

/// Checks, before the work starts, that a file can be written.
fn check_writable(path: &Path) -> Result<(), Failure> {
    probe_writable(path).map_err(|error| {
        Failure::input(
            format!("cannot write {}: {error}", path.display()),
            "name a file in a folder that exists and may be written",
        )
    })
}

/// Executes the command and prints its results to `out`.
fn execute(cli: &Cli, out: &mut impl Write) -> Result<(), Failure> {
    if cli.quiet {
        output::set_quiet();
    }
    match &cli.command {
        Command::Render(args) => render::run(args, out),
        Command::Pattern(args) => pattern::run(args, out),
        Command::Stats(args) => stats::run(args, out),
        Command::Speckle(args) => speckle::run(args, out),
        Command::List(args) => list::run(args, out),
        Command::Completions(args) => shell::completions(args, Cli::command(), out),
        Command::Man(args) => shell::man(args, Cli::command(), out),
    }
}
