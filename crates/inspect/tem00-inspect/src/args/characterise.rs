//! The command line of `tem00-inspect characterise`.

use clap::Args;

use super::SetupArgs;

/// Measure artefacts with a set-up, and report the characteristics that buyers of sensors ask for.
///
/// A level flat, tilted flats, a sphere and grooves of falling width are rendered as the set-up
/// sees them, with its speckle and the noise of its sensor, and evaluated: amplification,
/// linearity, flatness, noise, spatial resolution, x-y mapping and fidelity in the terms of ISO
/// 25178-600, and probing size, probing form and flat form in those of ISO 10360-8. The report has
/// the definition of each.
#[derive(Args, Debug)]
#[command(after_help = CHARACTERISE_EXAMPLES)]
pub(crate) struct CharacteriseArgs {
    #[command(flatten)]
    pub(crate) common: SetupArgs,

    /// Number of places at which flats and grooves are measured, 4 to 1000.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16,
        value_parser = clap::value_parser!(u16).range(4..=1000)
    )]
    pub(crate) repetitions: u16,

    /// Samples per pixel of the rendered frames, 1 to 65536.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16,
        value_parser = clap::value_parser!(u32).range(1..=65536)
    )]
    pub(crate) spp: u32,

    /// Random seed of speckle and noise.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
}

const CHARACTERISE_EXAMPLES: &str = "\
Examples:
  tem00-inspect characterise examples/setups/data_sheet.toml                   the characteristics, into out/data_sheet/
  tem00-inspect characterise examples/setups/data_sheet.toml --repetitions 64  the same, with half of the uncertainty

Files:
  characteristics.json  the characteristics, in SI units, with their definitions
  characteristics.html  all of it in one report that opens offline
  response.svg|png      errors of the heights of a flat over the range
  grooves.svg|png       how deep grooves are seen, over their width";
