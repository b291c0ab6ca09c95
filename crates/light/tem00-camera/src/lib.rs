#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Lengths are in metres, angles in radians, all in `f64`.
//! - Image points are in pixels, x to the right and y down; the image is upright. The centre of the
//!   first pixel is at 0.5, its edges at 0 and 1.
//!
//! # Main types
//!
//! A [`Camera`] is made of a [`CameraDescription`]. [`Camera::project`] and [`Camera::ray`] go to
//! and fro through the centre of the lens; [`Camera::sample_ray`] and [`Camera::connect`] go
//! through any point of it. [`Camera::imaging_geometry_at`] is what the laws of speckle ask for.
//!
//! # Scope and non-goals
//!
//! A thin lens, its pupil at the lens; a flat sensor that may be tilted (Scheimpflug); radial
//! distortion. No chromatic aberration, no other aberration than distortion, no diffraction: those
//! of the pupil are the speckle's.

mod camera;
mod description;
mod ray;

pub use camera::{Camera, CameraConnection, CameraRay, IMAGE_MARGIN};
pub use description::{CameraDescription, MAXIMUM_PIXELS, RadialDistortion, SensorTilt};
pub use ray::Ray;
pub use tem00_numerics::Refusal;
