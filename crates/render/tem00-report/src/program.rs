//! A program from its command line to its exit code.

use std::{
    ffi::OsString,
    io::{self, Write},
};

use clap::Parser;
use tem00_config::is_hazard;

use crate::{
    failure::Failure,
    interrupt,
    output::{self, Printable},
};

/// The command line of a program.
pub trait Program: Parser {
    /// Returns whether notes and progress are left out.
    fn is_quiet(&self) -> bool;

    /// Does the command and prints its results to `out`.
    ///
    /// # Errors
    ///
    /// Returns the failure of the command.
    fn obey(&self, out: &mut dyn Write) -> Result<(), Failure>;
}

/// Runs a program with the arguments of a process, the first of which is its own name, and returns
/// the exit code.
///
/// Takes over Ctrl-C and the termination signals of the process: a second one ends it at once.
pub fn run<P: Program>(arguments: &[OsString]) -> u8 {
    let program = match P::try_parse_from(arguments) {
        Ok(program) => program,
        Err(error) => return refuse(&error, arguments),
    };
    if program.is_quiet() {
        output::be_quiet();
    }
    match obey(&program) {
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

/// Does a command whose results nobody reads.
///
/// # Errors
///
/// Returns the failure of the command, or what is wrong with its line.
pub fn obey_line<P: Program>(line: &mut dyn Iterator<Item = OsString>) -> Result<(), Failure> {
    let program = P::try_parse_from(line).map_err(|error| {
        let text = error.to_string();
        let message = text.trim_start_matches("error: ").replace('\n', " ");
        Failure::input(message, "the grid names the options and the keys")
    })?;
    program.obey(&mut io::sink())
}

fn obey(program: &impl Program) -> Result<(), Failure> {
    interrupt::install()?;
    let mut out = Printable(io::stdout().lock());
    let done = program.obey(&mut out);
    // Within Python nothing else empties the buffer.
    done.and(out.flush().map_err(|error| Failure::stdout(&error)))
}
