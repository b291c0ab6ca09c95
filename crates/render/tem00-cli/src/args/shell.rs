//! The command lines of `tem00 completions` and `tem00 man`.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

/// Print a script by which a shell completes commands and options.
#[derive(Args, Debug)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub(crate) struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub(crate) shell: Shell,
}

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  tem00 completions bash > ~/.local/share/bash-completion/completions/tem00
  tem00 completions zsh > ~/.zfunc/_tem00            with ~/.zfunc in $fpath
  tem00 completions fish > ~/.config/fish/completions/tem00.fish";

/// Write the manual pages: tem00.1, and one for each command.
#[derive(Args, Debug)]
#[command(after_help = MAN_EXAMPLES)]
pub(crate) struct ManArgs {
    /// The folder for the pages, made if it is missing.
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
}

const MAN_EXAMPLES: &str = "\
Examples:
  tem00 man ~/.local/share/man/man1                   then: man tem00-render";
