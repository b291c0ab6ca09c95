//! Widths of beams, their power behind apertures, and beams from measured widths and powers.
//!
//! [`CrossSection`] holds for a beam that is known; [`CausticFit`] and [`KnifeEdgeFit`] find one from
//! measured data.

mod cross_section;
mod fit;

pub use cross_section::CrossSection;
pub use fit::{CausticFit, Estimate, FitError, KnifeEdgeFit, RadiusErrors};
