#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - SI units and radians. Wave numbers are vacuum wave numbers, in rad/m; κ is the difference of
//!   two.
//! - Directions lead *away from the surface*: to the source, to the pupil.
//! - Displacements across the pupil are in pupil diameters, lags on the object in units of the
//!   speckle size `λ / (2 sin u)`. The first component is along the tilt of the resolution cell,
//!   the second across it.
//! - Paths are *group* paths: in glass every length counts with the group index.
//!
//! # Main types
//!
//! | question | answer |
//! |---|---|
//! | Which light? | [`Spectrum`], [`PeakShape`]; as files state it, [`LaserLight`] |
//! | Which paths does one point of the image see? | [`ResolutionCell`], [`Relief`] |
//! | What happens to the speckle? | [`PolychromaticSpeckle`] |
//! | With which patterns is it drawn? | [`PatternSum`] |
//! | What if the source is not one point? | [`SourceExtent`] |
//! | How coherent is light that met several rough surfaces? | [`PathPairs`], of [`DelayedLight`] |
//! | What is left of the contrast with such light? | [`MixedLight`], [`cascade_variance`] |
//!
//! # Scope and non-goals
//!
//! The colour of the surface does not change the shape of the line, and light scatters once within
//! one relief. The caller supplies the paths over several surfaces. Surfaces are rough: below
//! `σ_L = λ/2` there is a specular part, which these laws do not include.

mod blur;
mod cell;
mod chebyshev;
mod eigenvalues;
mod excess;
mod extent;
mod heights;
mod kernel;
mod law;
mod lens;
mod light;
mod mixed;
mod paths;
mod patterns;
mod recombination;
mod spectrum;

pub use cell::{CellGeometry, Relief, ResolutionCell};
pub use extent::SourceExtent;
pub use glam::DVec3;
pub use law::{PolychromaticSpeckle, Rows};
pub use light::{LaserLight, SpectrumForm};
pub use mixed::{MixedLight, cascade_variance};
pub use paths::{DelayedLight, PathPairs, mode_ratio};
pub use patterns::PatternSum;
pub use recombination::Recombination;
pub use spectrum::{PeakShape, Spectrum};
pub use tem00_numerics::Refusal;
