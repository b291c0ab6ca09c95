//! The commands `completions` and `man` of a program: completions for shells, and manual pages.

use std::io::Write;

use clap::Command;
use clap_mangen::Man;

use crate::{
    args::{CompletionsArgs, ManArgs},
    failure::Failure,
    output,
};

/// Prints the script by which a shell completes commands and options.
///
/// # Errors
///
/// Returns a failure if it cannot be written.
pub fn completions(
    args: &CompletionsArgs,
    mut program: Command,
    out: &mut impl Write,
) -> Result<(), Failure> {
    // The generator panics where it cannot write.
    let mut script = Vec::new();
    let name = program.get_name().to_owned();
    clap_complete::generate(args.shell, &mut program, name, &mut script);
    out.write_all(&script)
        .map_err(|error| Failure::stdout(&error))
}

/// Writes a page for the program and one for each command, and prints their names.
///
/// # Errors
///
/// Returns a failure if a file cannot be written.
pub fn man(args: &ManArgs, program: Command, out: &mut impl Write) -> Result<(), Failure> {
    output::prepare(&args.folder)?;
    let mut program = program.disable_help_subcommand(true);
    // Gives the commands their names for display: "tem00-render".
    program.build();
    for command in [&program].into_iter().chain(program.get_subcommands()) {
        let name = command.get_display_name().unwrap_or(command.get_name());
        let path = args.folder.join(format!("{name}.1"));
        output::save(&path, |file| Man::new(command.clone()).render(file))?;
        writeln!(out, "{}", path.display()).map_err(|error| Failure::stdout(&error))?;
    }
    Ok(())
}
