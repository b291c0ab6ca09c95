//! Sections of scene files and set-up files.

mod detector;

pub use detector::read_detector;
