#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - SI units and radians; world vectors are [`DVec3`], image points [`DVec2`] in pixels with y
//!   down.
//! - The camera and the laser that a [`Speckle`] is made for stand as they do in the *reference
//!   state*. A [`Motion`] leads from there to now; points and normals are given as they are now.
//! - Factors are dimensionless with mean 1: multiply the radiance that a surface sends from this
//!   laser to the camera.
//!
//! # Two levels
//!
//! | level | names |
//! |---|---|
//! | what a renderer calls | [`Laser`], [`Camera`], [`Speckle`], [`Motion`], [`Pose`], [`SpeckleFrame`] |
//! | what a kernel on a graphics card calls | [`WGSL`], [`KernelSpeckle`], [`KernelFrame`] |
//! | what these are made of | [`SpeckleLaw`] and [`SpeckleShift`], [`SpectralLaw`] and [`SpectralShift`], [`Perspective`], [`Trajectory`], and the crates beam, camera, decorrelation, speckle |
//!
//! # Validity
//!
//! That of the parts: a lit patch much wider than a resolution cell, fully developed speckle of a
//! rough surface, a pupil free of aberrations. The light of a laser line thinner than a few
//! speckles has a profile that the lens blurs before it is multiplied.

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
/// The place of a rigid body, relative to the reference state: a rotation and a translation.
pub use tem00_decorrelation::RigidMotion as Pose;
pub use tem00_decorrelation::{Illumination, Wavefront};
pub use trajectory::{Keyframe, Rotation, Trajectory};
