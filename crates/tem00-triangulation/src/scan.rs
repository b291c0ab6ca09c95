//! From a scene to what a triangulation sensor measures of it, frame by frame.

mod assembly;
mod average;
mod exposure;
mod frame;
mod frame_correlation;
mod height_map;
mod measurement;
mod motion;
mod point_cloud;
mod scene;
mod sensor_speckle;
mod settings;
mod speckle_table;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use self::{
    assembly::{Scan, ScannedPart},
    average::{SpeckleCorrelation, averaged_profile, brightest_points, mean_point},
    exposure::{Exposure, LAMP_WAVELENGTH},
    frame::{MeasuredFrame, MeasuredPoint},
    frame_correlation::FrameCorrelation,
    height_map::{HeightMap, HeightScale, Raster},
    measurement::Measurement,
    motion::ScanMotion,
    point_cloud::write_point_cloud,
    scene::MeasurementScene,
    sensor_speckle::SensorSpeckle,
    settings::{Averaging, RawFormat, ScanSettings},
};
