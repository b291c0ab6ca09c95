#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! Lengths are in metres, angles in radians, power in watts. Light travels along +z of its own
//! frame. At the beam radius the irradiance has fallen to 1/e² of its value on the axis. Beams are
//! given by radius, not diameter, divergence as a half-angle, and a fan by its full angle.
//!
//! # Two faces
//!
//! *Physics*, in `f64` and in the frame of the beam. Constructors check their arguments, so that no
//! later call fails.
//!
//! - Beams: [`GaussianBeam`] (z = 0 at the waist), [`LocatedBeam`] (at a reference plane),
//!   [`AstigmaticBeam`] (elliptic).
//! - Laser lines: [`LaserLine`] (z = 0 at the lens) with a [`LineProfile`].
//!
//! *Renderer*, in world coordinates: [`SpotLight`], [`LineLight`] and [`TabulatedLineLight`], plain
//! structs prepared from these types by a [`Placement`] and queried through the trait [`Emitter`]:
//! next-event estimation, ray sampling, densities, radiance, bounds and batches. Kernels that
//! cannot call a library use the text of their [closed forms](closed_form) in WGSL and C.
//!
//! # Scope and non-goals
//!
//! The crate models paraxial, scalar beams of one wavelength, with M² ≥ 1, in free space and
//! through ideal lenses, mirrors and interfaces. Lenses, mirrors, apertures and fits of measured
//! beams are in `tem00-optics`. Not modelled are aberrations, beams wider than 0.5 rad, higher
//! modes other than through M², spots that rotate as they propagate, pulses, polarisation,
//! interference between beams, and the reflection of light at a surface. The crate is not a
//! laser-safety tool.

mod astigmatic;
pub mod closed_form;
mod exponential;
mod gaussian;
mod line;
mod located;
mod normal;
mod placed;
mod profile;

pub use astigmatic::AstigmaticBeam;
pub use gaussian::GaussianBeam;
pub use glam::DVec3;
pub use line::{FanGeometry, FocusCurve, LaserLine};
pub use located::LocatedBeam;
pub use placed::{
    ApertureHit, Axis, Bounds, Emitter, LineLight, NextEvent, NextEventSlices, Placement, RayPdf,
    RaySample, SampledEvent, SpotLight, TabulatedLineLight,
};
pub use profile::{AngularKnot, AngularProfile, LineProfile};
pub use tem00_numerics::Refusal;
