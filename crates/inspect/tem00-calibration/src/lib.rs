#![doc = include_str!("../README.md")]

mod board;
mod calibration;
mod camera_model;
mod corners;
mod covariance;
mod estimate;
mod flat_field;
mod homography;
mod lattice;
mod least_squares;
mod model;
mod perturbation;
mod plane_fit;
mod ring;
mod settings;
mod start;

pub use board::Checkerboard;
pub use calibration::{Calibration, CalibrationQuality};
pub use camera_model::CameraModel;
pub use corners::find_corners;
pub use covariance::{CalibrationCovariance, PARAMETERS, Parameter};
pub use estimate::{BoardView, calibrate};
pub use settings::{BoardSettings, CalibrationSettings, read_calibration};

/// The positions and directions of this crate.
pub use glam::{DMat3, DVec2, DVec3};
