#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! The conventions of `tem00-beam` apply: SI units, radii to 1/e², light along +z of its own frame.
//!
//! - Systems: [`AbcdMatrix`] and [`ComplexBeamParameter`] describe one axis; an elliptic beam takes
//!   a matrix for each of its two axes, by [`through_axes`].
//! - Widths and apertures: [`CrossSection`] describes a known beam.
//! - Measurements: [`CausticFit`] and [`KnifeEdgeFit`] fit a beam to measured data.
//!
//! # Scope and non-goals
//!
//! The crate covers paraxial systems without aberrations.

mod abcd;
mod complex_parameter;
mod cross_section;
mod fit;
mod through;

pub use abcd::{AbcdMatrix, elements::ThickLens};
pub use complex_parameter::ComplexBeamParameter;
pub use cross_section::CrossSection;
pub use fit::{CausticFit, Estimate, FitError, KnifeEdgeFit, RadiusErrors};
pub use num_complex::Complex64;
pub use through::{through_axes, through_lens};
