//! The program `tem00-inspect`.

use std::{env, process::ExitCode};

fn main() -> ExitCode {
    let arguments: Vec<_> = env::args_os().collect();
    ExitCode::from(tem00_inspect::run(&arguments))
}
