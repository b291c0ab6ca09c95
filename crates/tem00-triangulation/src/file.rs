//! Sections of scene files and set-up files.

mod detector;
mod sensor;

pub use detector::read_detector;
pub use sensor::read_sensor;
