//! From a scene to what a triangulation sensor measures of it, frame by frame.

mod assembly;
mod average;
mod decorrelation;
mod exposure;
mod frame;
mod height_map;
mod measurement;
mod motion;
mod point_cloud;
mod scene;
mod settings;
mod speckle_table;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use self::{
    assembly::{Scan, ScannedPart},
    average::{SpeckleCorrelation, averaged_profile, brightest_points, mean_point},
    decorrelation::{FrameCorrelation, SpeckleChange, SpeckleWitness},
    exposure::{Exposure, LAMP_WAVELENGTH},
    frame::{MeasuredFrame, MeasuredPoint},
    height_map::{HeightMap, HeightScale, Raster},
    measurement::Measurement,
    motion::ScanMotion,
    point_cloud::write_point_cloud,
    scene::MeasurementScene,
    settings::{Averaging, RawFormat, ScanSettings},
    speckle_table::SensorSpeckle,
};
