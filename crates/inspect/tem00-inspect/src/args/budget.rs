//! The command line of `tem00-inspect budget`.

use clap::Args;

use super::SetupArgs;

/// Compute the height uncertainty of a set-up, and find what dominates it.
///
/// The set-up file holds the values of data sheets: laser line, lens, sensor, angle, surface and
/// detector. The table on standard output is an uncertainty budget after the GUM: for each source
/// its standard uncertainty by formulas, and beside it the one found by trials with simulated
/// frames.
///
/// A set-up whose line saturates the sensor or is not found, or whose trials trust the line in
/// fewer than half of the columns, measures nothing: there is no number, and the exit code is 3.
#[derive(Args, Clone, Debug)]
#[command(after_help = BUDGET_EXAMPLES)]
pub(crate) struct BudgetArgs {
    #[command(flatten)]
    pub(crate) common: SetupArgs,

    /// Number of trials, 10 to a million; 0 skips them.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = trials)]
    pub(crate) trials: u32,

    /// Random seed of the trials.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
}

const BUDGET_EXAMPLES: &str = "\
Examples:
  tem00-inspect budget examples/setups/data_sheet.toml                 the budget, into out/data_sheet/
  tem00-inspect budget examples/setups/data_sheet.toml --trials 2000   the same, with smaller standard errors
  tem00-inspect budget examples/setups/data_sheet.toml --trials 0      formulas alone, at once

Files:
  budget.json             the budget, in SI units
  budget.html             all of it in one report that opens offline
  certificate.xml         a digital calibration certificate, if the set-up has a section [certificate]
  contributions.svg|png   what each source contributes, by formulas and by trials
  over_range.svg|png      the uncertainty over the heights that can be measured";

fn trials(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(trials @ (0 | 10..=1_000_000)) => Ok(trials),
        _ => Err("must be 0, or from 10 to 1000000".into()),
    }
}
