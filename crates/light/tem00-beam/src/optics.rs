//! Lenses, mirrors, interfaces and paths between them, and beams behind them.
//!
//! [`AbcdMatrix`] and [`ComplexBeamParameter`] hold for one axis. An elliptic beam takes a matrix for
//! each of its two: [`AstigmaticBeam::through_axes`](crate::AstigmaticBeam::through_axes).

mod abcd;
mod complex_parameter;
mod focus;

pub use abcd::{AbcdMatrix, elements::ThickLens};
pub use complex_parameter::ComplexBeamParameter;
