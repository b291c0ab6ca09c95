//! The program `tem00`, to be started by its own binary or from the Python package.
//! Its commands: `docs/program.md` in the repository.

#![cfg_attr(
    not(feature = "full"),
    allow(
        dead_code,
        reason = "modules serve commands that this build leaves out"
    )
)]

mod args;
mod atomic;
#[cfg(feature = "full")]
mod bandwidth;
#[cfg(feature = "full")]
mod budget;
#[cfg(feature = "full")]
mod calibrate;
#[cfg(feature = "full")]
mod calibration_file;
#[cfg(feature = "full")]
mod characterise;
mod colour;
mod comparison;
#[cfg(feature = "full")]
mod date;
#[cfg(feature = "full")]
mod design;
mod digits;
mod excerpt;
mod failure;
mod folder_lock;
mod frame_files;
mod image;
mod inspection;
mod interrupt;
mod kind;
#[cfg(feature = "full")]
mod lines;
#[cfg(feature = "full")]
mod list;
mod output;
mod pattern;
#[cfg(feature = "full")]
mod plot;
mod preview;
mod progress;
mod render;
mod report;
#[cfg(feature = "full")]
mod saturated_points;
#[cfg(feature = "full")]
mod shell;
mod speckle;
#[cfg(feature = "full")]
mod stats;
mod summary;
#[cfg(feature = "full")]
mod sweep;
#[cfg(feature = "full")]
mod triangulate;

use std::{
    ffi::OsString,
    io::{self, Write},
};

use clap::Parser;
use tem00_config::is_hazard;

use crate::{
    args::{Cli, Command},
    failure::Failure,
    output::Printable,
};

/// Runs the program with the arguments of a process, the first of which is its own name, and returns
/// the exit code.
///
/// Takes over Ctrl-C and the termination signals of the process: a second one ends it at once.
pub fn run(arguments: &[OsString]) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error, arguments),
    };
    if cli.quiet {
        output::be_quiet();
    }
    match obey(&cli.command) {
        Ok(()) => 0,
        Err(failure) => {
            if let Some(report) = failure.report() {
                // Without standard error there is nobody left to tell.
                let _ = write!(io::stderr(), "{report}");
            }
            failure.exit_code()
        }
    }
}

/// Prints what is wrong with the command line, or the help that was asked for, and returns the exit code.
fn refuse(error: &clap::Error, arguments: &[OsString]) -> u8 {
    #[cfg(not(feature = "full"))]
    if let Some(message) = args::left_out(error) {
        let _ = writeln!(io::stderr(), "{message}");
        return 2;
    }
    // Names of files that a shell fills in may hold anything.
    let _ = if arguments
        .iter()
        .all(|argument| !argument.to_string_lossy().contains(is_hazard))
    {
        error.print()
    } else {
        write!(Printable(io::stderr()), "{}", error.render())
    };
    if error.use_stderr() { 2 } else { 0 }
}

fn obey(command: &Command) -> Result<(), Failure> {
    interrupt::install()?;
    let mut out = Printable(io::stdout().lock());
    let done = run_command(command, &mut out);
    // Within Python nothing else empties the buffer.
    done.and(out.flush().map_err(|error| Failure::stdout(&error)))
}

/// Runs a command that prints to `out`.
fn run_command(command: &Command, mut out: &mut dyn Write) -> Result<(), Failure> {
    match command {
        Command::Render(args) => render::run(args, &mut out),
        Command::Pattern(args) => pattern::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Stats(args) => stats::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Lines(args) => lines::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Calibrate(args) => calibrate::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Triangulate(args) => triangulate::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Completions(args) => shell::completions(args, &mut out),
        #[cfg(feature = "full")]
        Command::Man(args) => shell::man(args, &mut out),
        #[cfg(feature = "full")]
        Command::List(args) => list::run(args, &mut out),
        Command::Speckle(args) => speckle::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Budget(args) => budget::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Characterise(args) => characterise::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Design(args) => design::run(args, &mut out),
        #[cfg(feature = "full")]
        Command::Sweep(args) => sweep::run(args, &mut out, run_command),
    }
}
