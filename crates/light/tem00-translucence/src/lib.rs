//! Subsurface scattering of a laser line: the line-spread function of a half space that lets light
//! in, with the path lengths behind it.
//!
//! Light that enters plastic, ceramic, marble or skin is scattered below the surface and leaves it
//! elsewhere. A triangulation sensor then reports a height that is too low, and the speckle of the
//! line has less contrast, because its paths differ in length. A renderer draws the place where the
//! light of a point entered with [`Medium::entry`].
//!
//! ```
//! use tem00_translucence::{LineSpread, Medium, Walk};
//!
//! let marble = Medium::new(1.5, 2.19e3, 2.1)?; // red light: 1/µs′ = 0.46 mm
//! let view = Walk { incidence: 0.0, exits: vec![0.5], photons: 20_000, seed: 1 };
//! let [seen] = &LineSpread::simulate(&marble, &view)?[..] else { panic!("one camera") };
//! let law = marble.shift_without_absorption(0.0, 0.5);
//! assert!((seen.centroid() / law - 1.0).abs() < 0.1);
//! # Ok::<(), tem00_translucence::Refusal>(())
//! ```
//!
//! # Validity
//!
//! The body is homogeneous, its surface plane, and it is thick against the transport length. Light
//! that the boundary itself reflects is not part of the results, except for a [`SpreadLine`] that
//! is given its fraction. The wavelength is one at a time, and polarisation is averaged.

mod bins;
mod entry;
mod line;
mod material;
mod medium;
mod photon;
mod reservoir;
mod spread;
mod walk;

pub use bins::Bin;
pub use entry::Entry;
pub use line::SpreadLine;
pub use material::{Material, MediumDescription};
pub use medium::Medium;
pub use spread::{LineSpread, PathSample};
pub use tem00_coherence::{PeakShape, Spectrum};
pub use tem00_numerics::Refusal;
pub use walk::{MAX_ANGLE, Walk};
