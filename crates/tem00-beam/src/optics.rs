//! Lenses, mirrors, interfaces and paths between them, and beams behind them.
//!
//! [`AbcdMatrix`] and [`ComplexBeamParameter`] hold for one axis, [`AstigmaticSystem`] for two.

mod abcd;
pub(crate) mod astigmatic_system;
mod complex_parameter;
mod focus;

pub use abcd::{AbcdMatrix, elements::ThickLens};
pub use astigmatic_system::AstigmaticSystem;
pub use complex_parameter::ComplexBeamParameter;
