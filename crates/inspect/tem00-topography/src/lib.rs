#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Lengths in metres. x runs along the profile, y along the scan, z upwards. Points are in the
//!   coordinates of the artefact.
//! - Uncertainties are standard uncertainties of the measured quantities, from the spread between
//!   repetitions (delete-a-group jackknife; J. W. Tukey, Ann. Math. Stat. 29, 614, 1958); the
//!   artefacts are known exactly.
//!
//! # Main items
//!
//! - [`characterise`] lets a [`ProfileSensor`] measure each [`Artefact`] and returns
//!   [`Characteristics`].
//! - [`Response`], [`FlatResult`], [`SphereResult`] and [`GrooveResult`] are the results of each
//!   artefact, with the definitions.
//!
//! # Scope and non-goals
//!
//! Profile sensors that are moved along y with an exact stage: the errors of a stage do not belong
//! to the sensor. Where the text of a standard leaves a choice, the definition of this crate is
//! stated at the result.

mod artefact;
mod characteristics;
mod estimate;
mod fit;
mod flat;
mod grooves;
mod response;
mod sensor;
mod sphere;

pub use artefact::{Artefact, Axis, Groove, Shape};
pub use characteristics::{Characteristics, Options, characterise};
pub use estimate::{Estimate, Extreme};
pub use flat::FlatResult;
pub use glam::DVec3;
pub use grooves::{GrooveResponse, GrooveResult};
pub use response::Response;
pub use sensor::{Field, ProfileSensor, SurfacePoint};
pub use sphere::SphereResult;
