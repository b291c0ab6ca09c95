#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Lengths are in metres, angles in radians, times in seconds, `f64`; images are `f32` or `u16`.
//! - Positions in an image are in pixels, x to the right and y *down*; the centre of the first
//!   pixel is at 0.5, its edges at 0 and 1.
//! - A line runs from left to right in the image; each *column* gives its position, along y.
//! - Widths of lines are full widths between the points of 1/e², four standard deviations of a
//!   Gaussian.
//! - Uncertainties are standard uncertainties unless called expanded.

mod budget;
mod design;
mod detector;
mod dorsch;
mod error;
mod file;
mod geometry;
mod line_image;
mod measurement;
mod named;
mod position_noise;
mod sensor;
mod setup;

pub use budget::{
    Budget, BudgetTerm, ErrorDistribution, Evaluation, MonteCarloEstimate, Simulation,
    SimulationOptions, SubsurfaceShift, UncertaintySource, simulate,
};
pub use design::{
    Candidate, Constraint, DesignFigure, DesignFigures, DesignOutcome, DesignQuestion,
    DesignSearch, Exclusion, Neighbours, Objective, Spacing, Sweep, neighbours, pareto_front,
};
pub use detector::{DetectorSettings, FilterOrder, LineDetector, LineMethod, LinePoint, Validity};
pub use dorsch::Dorsch;
pub use error::TriangulationError;
pub use file::{
    parse_setup, parse_setup_with, read_design, read_detector, read_sensor, read_setup,
    read_setup_with, read_uncertainty,
};
pub use geometry::{LaserPlane, ProfilePoint, Triangulator, UncertainPoint};
pub use line_image::{LineImage, LineImageData};
pub use measurement::{Measurement, MeasurementInput, SetupUncertainty, VirtualExperiment};
pub use position_noise::{ColumnLight, PositionNoise, speckle_covariance};
pub use sensor::{PhotonTransferPoint, RawFrame, Sensor, SensorDescription};
pub use setup::{
    Averages, BandwidthEffect, HeightRange, ImagedLine, LaserLineData, LightLevel, QuantityUnit,
    Setup, SetupCamera, SetupDescription, SetupEnvironment, SetupQuantity, SetupSurface,
    Subsurface,
};

pub use tem00_coherence::{LaserLight, PeakShape, Relief, SpectrumForm};
/// The light of a laser and the relief of a surface.
pub use tem00_translucence::Material;

/// The positions and directions of this crate.
pub use glam::{DVec2, DVec3};
