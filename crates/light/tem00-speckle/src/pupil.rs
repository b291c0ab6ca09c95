//! The pupil, the field in the pupil, and the patterns behind it.

mod aperture;
mod field;
pub(crate) mod lattice;
pub(crate) mod mask;
mod pattern;
mod shape;
mod transmission;
mod view;

pub use aperture::Aperture;
pub use field::PupilField;
pub(crate) use field::not_a_side;
pub use pattern::{SpeckleField, SpecklePattern};
pub use shape::{Phasors, Pupil};
pub use transmission::Transmission;
pub use view::SpeckleScratch;
