//! The command line.

mod budget;
mod calibrate;
mod characterise;
mod design;
mod lines;
mod list;
mod setup;
mod sweep;
mod triangulate;

use clap::{Parser, Subcommand};
use tem00_report::args::{CompletionsArgs, ManArgs};

pub(crate) use self::{
    budget::BudgetArgs,
    calibrate::CalibrateArgs,
    characterise::CharacteriseArgs,
    design::DesignArgs,
    lines::LinesArgs,
    list::{ListArgs, Listed},
    setup::{SETUP_HELP, SetupArgs},
    sweep::SweepArgs,
    triangulate::TriangulateArgs,
};

const EXAMPLES: &str = "\
Examples:
  tem00-inspect budget examples/setups/data_sheet.toml         how well will this set-up measure heights?
  tem00-inspect characterise examples/setups/data_sheet.toml   its noise, resolution, linearity … on rendered artefacts
  tem00-inspect design examples/setups/design.toml             search for a better one
  tem00-inspect sweep examples/setups/sweeps/lens_and_line.toml
                                                      a table over a grid of values, on any machines
  tem00-inspect triangulate examples/scenes/triangulation/groove.toml
                                                      see a part as such a sensor sees it
  tem00-inspect lines frame.png                       find the laser line in a camera frame
  tem00-inspect calibrate photos --corners 9x6 --square \"5 mm\" --pixel-pitch \"3.45 um\"
                                                      calibrate camera and laser plane

Data goes to standard output, everything else to standard error.
Exit codes: 0 success, 1 failure while running, 2 bad input or usage, 3 nothing measured or found,
130 interrupted.";

/// Laser triangulation, from data sheet to height uncertainty, and from camera frames to lines.
#[derive(Debug, Parser)]
#[command(name = "tem00-inspect", version, max_term_width = 100, after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Suppress notes and progress; print only results and errors.
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Budget(BudgetArgs),
    Characterise(CharacteriseArgs),
    Design(DesignArgs),
    Triangulate(TriangulateArgs),
    Lines(LinesArgs),
    Calibrate(CalibrateArgs),
    Sweep(SweepArgs),
    List(ListArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    /// Summaries of options begin with a noun or a verb, and use the terms that a reader searches
    /// for.
    #[test]
    fn help_is_written_in_standard_terms() {
        const CLAUSES: &str = "What How Whether Which Where Why Who";
        const PRIVATE: &str = "field from outside|is none|no number|lamp|nobody|told";
        let mut program = Cli::command();
        program.build();
        for command in program.get_subcommands() {
            let texts = command.get_arguments().map(clap::Arg::get_help);
            for text in texts.chain([command.get_about()]).flatten() {
                let text = text.to_string();
                let first = text.split_whitespace().next().unwrap_or_default();
                let name = command.get_name();
                assert!(
                    !CLAUSES.split(' ').any(|word| word == first),
                    "{name}: {text}"
                );
                let private = PRIVATE.split('|').find(|word| text.contains(word));
                assert_eq!(private, None, "{name}: {text}");
            }
        }
    }
}
