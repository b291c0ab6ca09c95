//! The command lines of `completions` and `man`.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

/// Print a script that completes commands and options in a shell.
#[derive(Args, Debug)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  tem00 completions bash > ~/.local/share/bash-completion/completions/tem00
  tem00-inspect completions bash > ~/.local/share/bash-completion/completions/tem00-inspect
  tem00 completions zsh > ~/.zfunc/_tem00            with ~/.zfunc in $fpath
  tem00 completions fish > ~/.config/fish/completions/tem00.fish";

/// Write the manual pages: one for the program, and one for each command.
#[derive(Args, Debug)]
#[command(after_help = MAN_EXAMPLES)]
pub struct ManArgs {
    /// The folder for the pages, made if it is missing.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

const MAN_EXAMPLES: &str = "\
Examples:
  tem00 man ~/.local/share/man/man1                   then: man tem00-render
  tem00-inspect man ~/.local/share/man/man1           then: man tem00-inspect-budget";
