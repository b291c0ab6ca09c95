//! Sections of scene files and set-up files.

mod sensor;

pub use sensor::read_sensor;
