//! The command line of `tem00-inspect design`.

use clap::Args;

use super::SetupArgs;

/// Search set-ups for the minimum height uncertainty under constraints.
///
/// The section [design] of the set-up file names the parameters to vary, the constraints and the
/// objective. All combinations are tried; the table on standard output lists the best that keep
/// every constraint. If there is none, it says which constraint excludes how many and the nearest
/// set-up, no best.toml is written, and the exit code is 3.
#[derive(Args, Debug)]
#[command(after_help = DESIGN_EXAMPLES)]
pub(crate) struct DesignArgs {
    #[command(flatten)]
    pub(crate) common: SetupArgs,

    /// Number of best set-ups to list, 1 to 1000.
    #[arg(long, value_name = "N", default_value_t = 10,
          value_parser = clap::value_parser!(u16).range(1..=1_000))]
    pub(crate) best: u16,
}

const DESIGN_EXAMPLES: &str = "\
Examples:
  tem00-inspect design examples/setups/design.toml                     search, into out/design/
  tem00-inspect design examples/setups/design.toml --best 3 -o search
  tem00-inspect budget out/design/best.toml                   the budget of the winner

Files:
  best.toml           the best set-up that keeps every constraint
  design.csv          every set-up that was tried, in SI units
  design.json         the search, its best set-ups, the front, and what constraints exclude
  design.html         all of it in one report that opens offline
  trade_off.svg|png   uncertainty against depth of field
  over_<parameter>    the minimum uncertainty over each varied parameter, by source
  sensitivity         the change of the best by 10 % more or less of each parameter";
