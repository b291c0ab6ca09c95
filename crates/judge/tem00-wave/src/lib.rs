#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - SI units and radians; amplitudes vary in time as `exp(−iωt)`, so that a diverging wave is
//!   `exp(+ikr)/r`.
//! - Lengths lie between 1 pm and 10 km and wavelengths between 0.1 nm and 1 m, so that every phase
//!   is meaningful in `f64`.
//! - Image coordinates refer to the upright picture: to the right and upwards, in metres on the
//!   sensor. Columns and rows of a [`Grid`] increase in the same directions.
//!
//! # Main types
//!
//! | what | type |
//! |---|---|
//! | scatterers with random phases or random heights | [`RoughSurface`] |
//! | plane wave, point source, Gaussian beam, laser line | [`Illumination`] |
//! | both together, ready to be summed | [`LitSurface`] |
//! | points at which the field is computed | [`SamplePlane`] |
//! | pupil, lens and picture | [`Camera`], [`ImageWindow`] |
//! | a field, and its intensity | [`Field`] |
//! | motion of surface, light or camera | [`RigidMotion`] |
//! | displacement of a pattern, remaining correlation | [`displacement_between`], [`FieldCorrelation`] |
//!
//! # Scope and non-goals
//!
//! The crate models one scattering per light path and one polarisation, without shadowing,
//! diffraction by the edges of the scene, or aberrations. The brightness of a surface is relative:
//! there is no reflectance model.
//!
//! # References
//!
//! - J. W. Goodman, *Introduction to Fourier Optics*, 1968, ch. 3 and 5.
//! - A. E. Siegman, *Lasers*, 1986, ch. 16 and 17.

mod camera;
mod correlation;
mod field;
mod heights;
mod illumination;
mod image;
mod length;
mod lit;
mod motion;
mod patch;
mod phasor;
mod plane;
mod random;
mod shift;
mod sum;
mod surface;

pub use camera::{Camera, Lens};
pub use correlation::{Estimate, FieldCorrelation};
pub use field::Field;
pub use glam::{DMat3, DVec2, DVec3};
pub use illumination::{BeamDescription, FanDescription, Illumination};
pub use image::{ImageSampling, ImageWindow};
pub use lit::LitSurface;
pub use motion::RigidMotion;
pub use num_complex::Complex;
pub use patch::{Amplitudes, Arrangement, PatchDescription, Roughness, Scatterer};
pub use plane::SamplePlane;
pub use shift::{Shift, displacement_between};
pub use surface::RoughSurface;
pub use tem00_numerics::{Grid, Refusal};
