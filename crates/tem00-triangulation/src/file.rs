//! Sections of scene files and set-up files.

mod detector;
mod scan;
mod sensor;

pub use self::detector::read_detector;
pub use self::scan::read_scan;
pub use self::sensor::read_sensor;
