//! From a scene to what a triangulation sensor measures of it, frame by frame.

mod exposure;
mod frame;
mod measurement;
mod motion;
mod scene;
mod settings;
mod speckle_table;

pub use self::{
    exposure::{Exposure, LAMP_WAVELENGTH},
    frame::{MeasuredFrame, MeasuredPoint},
    measurement::Measurement,
    motion::ScanMotion,
    scene::MeasurementScene,
    settings::{Averaging, RawFormat, ScanSettings},
    speckle_table::{SensorSpeckle, SpeckleTable},
};
