#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! Lengths are in metres, angles in radians, power in watts. Light travels along +z of its own
//! frame. A beam radius is where the irradiance has fallen to 1/e² of the axis; the radius and not
//! the diameter, a half-angle for divergence, the full angle for a fan.
//!
//! # Two faces
//!
//! *Physics*, in `f64` and in the frame of the beam. Constructors check, so that nothing fails
//! later.
//!
//! - Beams: [`GaussianBeam`] (z = 0 at the waist), [`LocatedBeam`] (at a reference plane),
//!   [`AstigmaticBeam`] (elliptic).
//! - Laser lines: [`LaserLine`] (z = 0 at the lens) with a [`LineProfile`].
//!
//! *Renderer*, in world coordinates: [`SpotLight`], [`LineLight`] and [`TabulatedLineLight`], plain
//! structs prepared from the above by a [`Placement`], queried through the trait [`Emitter`]:
//! next-event estimation, ray sampling, densities, radiance, bounds and batches. The text of their
//! [closed forms](closed_form) in WGSL and C is for kernels that cannot call a library.
//!
//! # Scope and non-goals
//!
//! Paraxial, scalar beams of one wavelength, with M² ≥ 1, in free space and through ideal lenses,
//! mirrors and interfaces. Lenses, mirrors, apertures and fits of measured beams
//! are in `tem00-optics`. Not here: aberrations, beams wider than 0.5 rad, higher modes other than
//! through M², spots that turn on their way, pulses, polarisation, interference between beams, and
//! what a surface does with the light. It is no laser-safety tool.

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
