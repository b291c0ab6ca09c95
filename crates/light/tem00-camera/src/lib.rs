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
//! A [`Camera`] is created from a [`CameraDescription`]. [`Camera::project`] and [`Camera::ray`]
//! map scene to image and back through the centre of the lens; [`Camera::sample_ray`] and
//! [`Camera::connect`] use any point of the lens. [`Camera::imaging_geometry_at`] gives the lengths
//! that the laws of speckle need.
//!
//! # Scope and non-goals
//!
//! The crate models a thin lens with its pupil at the lens, a flat sensor that may be tilted
//! (Scheimpflug), and radial distortion. It models no chromatic aberration, no aberration other
//! than distortion, and no diffraction: diffraction at the pupil is part of the speckle.

mod camera;
mod description;
mod ray;

pub use camera::{Camera, CameraConnection, CameraRay, IMAGE_MARGIN};
pub use description::{CameraDescription, MAXIMUM_PIXELS, RadialDistortion, SensorTilt};
pub use ray::Ray;
pub use tem00_numerics::Refusal;
