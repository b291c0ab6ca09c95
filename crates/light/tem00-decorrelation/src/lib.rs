#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - SI units and radians; world vectors are [`DVec3`], vectors in the pupil or image [`DVec2`].
//! - A [`CameraFrame`] has `b1` to the right and `b2` up in the pupil plane, and `b3` from the
//!   scene towards the camera.
//! - Directions lead *away from the surface*: to the pupil, to the light source.
//! - A wavefront has a *curvature* 1/R, positive where the wave diverges; zero is a plane wave.
//! - `correlation` is always the correlation of intensity: 1 for the same pattern, 0 for a new one.
//!
//! # Main types
//!
//! | question | answer |
//! |---|---|
//! | How large are the speckles of this camera? | [`ImagingGeometry`] |
//! | Which way is the camera turned, where does it see the point? | [`CameraFrame`], [`LineOfSight`] |
//! | How is the point lit? | [`Illumination`], [`Wavefront`] |
//! | What moved, turned, or has other light? | [`Configuration`], [`RigidMotions`] |
//! | What happens to the speckle? | [`SpeckleMotion`] |
//! | What happens at many points of a body? | [`RigidChange`] |
//! | What does my kernel on a GPU compute? | [`closed_form`] |
//! | Where do I look in the pattern? | [`ImagingGeometry::pattern_coordinate`] |
//!
//! One law of motion holds between any two states of a surface point. A translation is a motion
//! whose rotation is the identity: [`RigidMotion::along`].
//!
//! # Scope and non-goals
//!
//! The laws assume a circular pupil free of aberrations, fully developed speckle, and a lit patch
//! much wider than a resolution cell and much smaller than its distances to pupil and source.
//! Further limits:
//!
//! - *Large rotations and changes of the light* also stretch the field across the pupil.
//!   Displacements are given at the pupil centre; the correlation neglects the stretch.
//! - *Another wavelength or direction of illumination* changes the phases of the surface heights.
//!   The resulting loss depends on the roughness and not on the geometry, and is not part of any
//!   correlation of this crate: see [`Configuration::height_phase_change`].
//! - *Spots or lines thinner than a speckle* have no pattern that moves; they need a wave-optical
//!   simulation.
//! - Not covered: surfaces that deform, volume scattering, lenses telecentric towards the surface,
//!   annular and other pupils.
//!
//! # References
//!
//! - M. Sjödahl, *Calculation of speckle displacement, decorrelation, and object-point location in
//!   imaging systems*, Applied Optics 34, 1995.
//! - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, Journal of
//!   the Optical Society of America A 3, 1986.
//! - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
//!   Speckle into a Physically-Based Renderer*, 2016, §6.3 and §6.4.

pub mod closed_form;
mod configuration;
mod correlation;
mod frame;
mod geometry;
mod illumination;
mod lens;
mod motion;
mod rigid;
mod rigid_change;
mod vector;
mod wavefront;

pub use configuration::{Configuration, ConfigurationData};
pub use correlation::{
    CorrelationLaw, add_axial_shifts, axial_correlation, equivalent_axial_shift,
    equivalent_pupil_shift, pupil_overlap_correlation,
};
pub use frame::{CameraFrame, LineOfSight};
pub use geometry::ImagingGeometry;
pub use glam::{DMat3, DVec2, DVec3};
pub use illumination::Illumination;
pub use lens::{Focus, LensData, PupilDistances, ThickLensData};
pub use motion::SpeckleMotion;
pub use rigid::{RigidMotion, RigidMotions};
pub use rigid_change::{ChangedPoint, PointChange, RigidChange};
pub use tem00_numerics::Refusal;
pub use wavefront::Wavefront;

/// The smallest cosine between two directions that still counts as different from zero, `2⁻²⁶`.
///
/// It is the square root of the rounding unit: below it, the relative rounding error of a cosine is
/// larger than the cosine itself.
const GRAZING_COSINE: f64 = 1.0 / 67_108_864.0;
