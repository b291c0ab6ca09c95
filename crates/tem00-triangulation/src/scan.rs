//! From a scene to what a triangulation sensor measures of it, frame by frame.

mod exposure;
mod motion;
mod settings;
mod speckle_table;

pub use self::{
    exposure::{Exposure, LAMP_WAVELENGTH},
    motion::ScanMotion,
    settings::{Averaging, RawFormat, ScanSettings},
    speckle_table::{SensorSpeckle, SpeckleTable},
};
