//! From a scene to what a triangulation sensor measures of it, frame by frame.

mod settings;

pub use self::settings::{Averaging, RawFormat, ScanSettings};
