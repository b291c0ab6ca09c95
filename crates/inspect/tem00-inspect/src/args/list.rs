//! The command line of `tem00-inspect list`.

use clap::{Args, ValueEnum};

/// List the names that set-ups can use: detectors, sensors.
///
/// Each entry has its source, and typical values are marked.
#[derive(Args, Debug)]
#[command(after_help = LIST_EXAMPLES)]
pub(crate) struct ListArgs {
    /// The list.
    #[arg(value_name = "WHAT")]
    pub(crate) what: Listed,
}

const LIST_EXAMPLES: &str = "\
Examples:
  tem00-inspect list detectors            how a line is found";

/// The lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Listed {
    /// Methods that find a line in a column.
    Detectors,
    /// Typical sensors, the defaults of files.
    Sensors,
}
