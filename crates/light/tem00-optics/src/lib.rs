#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! Those of `tem00-beam`: SI units, radii to 1/e², light along +z of its own frame.
//!
//! - Systems: [`AbcdMatrix`] and [`ComplexBeamParameter`] hold for one axis; an elliptic beam takes
//!   a matrix for each of its two, by [`through_axes`].
//! - Widths and apertures: [`CrossSection`] holds for a beam that is known.
//! - Measurements: [`CausticFit`] and [`KnifeEdgeFit`] find a beam from measured data.
//!
//! # Scope and non-goals
//!
//! Paraxial systems without aberrations.

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
