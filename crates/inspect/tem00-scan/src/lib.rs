#![doc = include_str!("../README.md")]
//!
//! # Main types
//!
//! A [`MeasurementScene`] is read from a scene file with the sections `[sensor]`, `[detector]`,
//! `[calibration]` and `[scan]`. A [`Measurement`] of it gives a [`MeasuredFrame`] per frame, a
//! [`Scan`] puts them together, and a [`HeightMap`] lays them out. A [`BoardPlan`] renders boards and
//! calibrates with them.
//!
//! # Conventions
//!
//! The conventions of [`tem00_triangulation`]: metres, pixels with y down, standard uncertainties.

mod airy_pattern;
mod assembly;
mod average;
mod boards;
mod error;
mod exposure;
mod frame;
mod frame_correlation;
mod height_map;
mod image_speckle;
mod laser_plane;
mod measurement;
mod motion;
mod point_cloud;
mod quantised;
mod scene;
mod section;
mod sensor_speckle;
mod settings;
mod setup_scene;
mod setup_sensor;
mod speckle_by_waves;
mod speckle_table;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use self::{
    assembly::{Scan, ScannedPart},
    average::mean_point,
    boards::BoardPlan,
    error::ScanError,
    exposure::Exposure,
    frame::{IndirectLight, MeasuredFrame, MeasuredPoint},
    frame_correlation::FrameCorrelation,
    height_map::{HeightMap, Raster},
    measurement::Measurement,
    point_cloud::{write_pcd, write_ply},
    quantised::QuantisedGrid,
    scene::MeasurementScene,
    sensor_speckle::SensorSpeckle,
    settings::{Averaging, RawFormat, ScanSettings},
    setup_scene::setup_scene,
    setup_sensor::SetupSensor,
};
