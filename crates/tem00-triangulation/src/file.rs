//! Sections of scene files and set-up files.

mod detector;
mod sensor;
mod setup;
mod setup_text;
#[cfg(test)]
mod tests;

pub use detector::read_detector;
pub use sensor::read_sensor;
pub use setup::{parse_setup, parse_setup_with, read_setup, read_setup_with};
