//! Sections of scene files and set-up files.

mod scan;

pub use self::scan::read_scan;
