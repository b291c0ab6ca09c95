//! The command line of `tem00 list`.

use clap::{Args, ValueEnum};
use tem00_report::args::length;

/// List the names that scenes can use: metals, materials, surfaces.
///
/// Each entry states its source, and typical values are marked.
#[derive(Args, Debug)]
#[command(after_help = LIST_EXAMPLES)]
pub(crate) struct ListArgs {
    /// The list.
    #[arg(value_name = "WHAT")]
    pub(crate) what: Listed,

    /// Vacuum wavelength for metals, as in "650 nm".
    #[arg(long, value_name = "LENGTH", default_value = "650 nm", value_parser = length)]
    pub(crate) wavelength: f64,
}

const LIST_EXAMPLES: &str = "\
Examples:
  tem00 list metals --wavelength 532nm    n, k and reflectance, with their source
  tem00 list surfaces                     finishes such as \"milled steel\"";

/// The lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Listed {
    /// Metals with their complex refractive index.
    Metals,
    /// Materials of surfaces with their keys.
    Materials,
    /// Surfaces by finishing process and metal.
    Surfaces,
}
