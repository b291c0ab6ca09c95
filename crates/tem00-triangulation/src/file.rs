//! Sections of scene files and set-up files.

mod scan;
mod sensor;

pub use self::scan::read_scan;
pub use self::sensor::read_sensor;
