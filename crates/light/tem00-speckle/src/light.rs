//! Light that is more than one wave, and what a sensor makes of it.

mod exposure;
mod sum;
mod transform;

pub use exposure::Exposure;
pub use sum::incoherent_fractions;
