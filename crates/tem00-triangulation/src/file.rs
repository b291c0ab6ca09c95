//! Sections of scene files and set-up files.

mod calibration;
mod sensor;

pub use calibration::{BoardSettings, CalibrationMethod, CalibrationSettings, read_calibration};
pub use sensor::read_sensor;
