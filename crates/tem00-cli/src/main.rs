//! The program `tem00`.

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
mod budget;
#[cfg(feature = "full")]
mod calibrate;
#[cfg(feature = "full")]
mod calibration_file;
mod colour;
mod comparison;
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
mod shell;
mod speckle;
#[cfg(feature = "full")]
mod stats;
mod summary;
#[cfg(feature = "full")]
mod triangulate;

use std::{
    env,
    io::{self, Write},
    process::{self, ExitCode},
};

use clap::Parser;
use tem00_config::is_hazard;

use crate::{
    args::{Cli, Command},
    failure::Failure,
    output::Printable,
};

fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| refuse(&error));
    if cli.quiet {
        output::be_quiet();
    }
    match run(&cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(report) = failure.report() {
                // Without standard error there is nobody left to tell.
                let _ = write!(io::stderr(), "{report}");
            }
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Prints what is wrong with the command line, or the help that was asked for, and ends.
fn refuse(error: &clap::Error) -> ! {
    #[cfg(not(feature = "full"))]
    if let Some(message) = args::left_out(error) {
        let _ = writeln!(io::stderr(), "{message}");
        process::exit(error.exit_code());
    }
    // Names of files that a shell fills in may hold anything.
    if env::args_os().all(|argument| !argument.to_string_lossy().contains(is_hazard)) {
        error.exit();
    }
    let _ = write!(Printable(io::stderr()), "{}", error.render());
    process::exit(error.exit_code());
}

fn run(command: &Command) -> Result<(), Failure> {
    interrupt::install()?;
    let mut out = Printable(io::stdout().lock());
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
        Command::Design(args) => design::run(args, &mut out),
    }?;
    out.flush().map_err(|error| Failure::stdout(&error))
}
