//! Parameters of a beam from measured data, with their standard errors.

mod caustic;
mod error;
mod knife_edge;
mod positions;
#[cfg(test)]
mod synthetic;

pub use caustic::{CausticFit, RadiusErrors};
pub use error::FitError;
pub use knife_edge::KnifeEdgeFit;
pub use positions::Estimate;
