//! A program from its command line to its exit code.

use std::{
    ffi::OsString,
    io::{self, StdoutLock, Write},
};

use clap::Parser;
use tem00_config::is_hazard;

use crate::{failure::Failure, interrupt, output::Printable};

/// Runs a program with the arguments of a process, the first of which is its own name, and returns
/// the exit code. `run` executes the command and prints its results.
///
/// Takes over Ctrl-C and the termination signals of the process: a second signal ends the process
/// at once.
pub fn run<P: Parser>(
    arguments: &[OsString],
    run: impl FnOnce(&P, &mut Printable<StdoutLock<'static>>) -> Result<(), Failure>,
) -> u8 {
    let program = match P::try_parse_from(arguments) {
        Ok(program) => program,
        Err(error) => return refuse(&error, arguments),
    };
    let mut out = Printable(io::stdout().lock());
    let done = interrupt::install().and_then(|()| run(&program, &mut out));
    // Within Python nothing else empties the buffer.
    match done.and(out.flush().map_err(|error| Failure::stdout(&error))) {
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

/// Prints what is wrong with the command line, or the requested help, and returns the exit code.
fn refuse(error: &clap::Error, arguments: &[OsString]) -> u8 {
    // Names of files that a shell fills in may hold anything.
    let is_plain = |argument: &OsString| !argument.to_string_lossy().contains(is_hazard);
    let _ = if arguments.iter().all(is_plain) {
        error.print()
    } else {
        write!(Printable(io::stderr()), "{}", error.render())
    };
    if error.use_stderr() { 2 } else { 0 }
}
