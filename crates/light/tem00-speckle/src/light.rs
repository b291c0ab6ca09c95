//! Light of more than one wave, and its detection by a sensor.

mod exposure;
mod sum;

pub use exposure::Exposure;
pub use sum::incoherent_fractions;
