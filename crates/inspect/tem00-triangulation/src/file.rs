//! Sections of scene files and set-up files.

mod design;
mod detector;
mod sensor;
mod setup;
mod setup_text;
mod uncertainty;

pub use self::design::read_design;
pub use self::detector::read_detector;
pub use self::sensor::read_sensor;
pub use self::setup::{parse_setup, parse_setup_with, read_setup, read_setup_with};
pub use self::uncertainty::read_uncertainty;

#[cfg(test)]
pub(crate) mod tests;
