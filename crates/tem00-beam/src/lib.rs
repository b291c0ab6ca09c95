//! Gaussian beams and laser lines as light sources that a renderer can evaluate and sample.
//!
//! Lengths are in metres, angles in radians, power in watts. Light travels along +z of its own
//! frame. A beam radius is where the irradiance has fallen to 1/e² of the axis.

mod error;
mod gaussian;
mod line;
mod normal;
mod profile;
mod real;

pub use error::BeamError;
pub use gaussian::GaussianBeam;
pub use glam::DVec3;
pub use line::{FanGeometry, LaserLine};
pub use profile::LineProfile;
pub use real::Real;
