#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - SI units and radians; world vectors are [`DVec3`], image points [`DVec2`] in pixels with y
//!   down.
//! - A [`Speckle`] is created from the camera and the laser in the *reference state*. A [`Motion`]
//!   leads from the reference state to the current frame; points and normals are given in the
//!   current frame.
//! - Factors are dimensionless with mean 1: multiply the radiance that a surface scatters from this
//!   laser to the camera by the factor.
//!
//! # Two levels
//!
//! | level | names |
//! |---|---|
//! | interface of a renderer | [`Laser`], [`Camera`], [`Speckle`], [`Motion`], [`Pose`], [`SpeckleFrame`] |
//! | interface of a kernel on a graphics card | [`WGSL`], [`KernelSpeckle`], [`KernelFrame`] |
//! | building blocks | [`SpeckleLaw`] and [`SpeckleShift`], [`SpectralLaw`] and [`SpectralShift`], [`Perspective`], [`Trajectory`], and the crates beam, camera, decorrelation, speckle |
//!
//! # Validity
//!
//! The limits of the parts apply: a lit patch much wider than a resolution cell, fully developed
//! speckle of a rough surface, and a pupil free of aberrations. The lens blurs the profile of a
//! laser line thinner than a few speckles before the factor multiplies it.

mod error;
mod frame;
mod kernel;
mod laser;
mod motion;
mod patterns;
mod perspective;
mod prepared;
mod shift;
mod speckle;
mod spectral;
mod state;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod trajectory;

pub use error::ShadingError;
pub use frame::SpeckleFrame;
pub use glam::{DMat3, DVec2, DVec3};
pub use kernel::{KernelFrame, KernelSpeckle, WGSL};
pub use laser::{
    BeamShape, EmittedRay, Laser, LaserBuilder, LaserDescription, LaserEvent, LaserEventBatch,
    PlacedLight, SampledEvent,
};
pub use motion::Motion;
pub use perspective::Perspective;
pub use prepared::PreparedSpeckle;
pub use shift::{BLOCK, LightPath, SeenPoint, SpeckleLaw, SpeckleShift};
pub use speckle::Speckle;
pub use spectral::{Bandwidth, SpectralLaw, SpectralShift, SurfaceLight};
pub use tem00_camera::{Camera, CameraDescription};
/// Pose of a rigid body relative to the reference state: a rotation and a translation.
pub use tem00_decorrelation::RigidMotion as Pose;
pub use tem00_decorrelation::{Illumination, Wavefront};
pub use trajectory::{Keyframe, Rotation, Trajectory};
