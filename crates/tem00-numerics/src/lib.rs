//! The ground floor of tem00: grids, a pruned two-dimensional Fourier transform, quadrature, least
//! squares, and the special functions of circular pupils.
//!
//! # Conventions
//!
//! - A [`Grid`] is row-major: `(x, y)` lies at `y · width + x`.
//! - Coordinates on a periodic grid are reduced in `f64` before anything is stored as `f32`.
//! - Functions of a pupil take lengths in units of the pupil *diameter*.
//!
//! # Scope and non-goals
//!
//! Only what more than one crate above needs and no library has. This is no array library: there is
//! no slicing, no broadcasting and no linear algebra beyond the few equations of least squares.
//!
//! # Example
//!
//! ```
//! use tem00_numerics::{disc_overlap, disc_overlap_inverse};
//!
//! // Two discs whose centres are half a diameter apart share 39.1 % of their area.
//! let overlap = disc_overlap(0.5);
//! assert!((overlap - 0.391_002_218_955_771).abs() < 1e-14);
//! assert!((disc_overlap_inverse(overlap) - 0.5).abs() < 1e-12);
//! ```

pub mod cast;
mod circle;
#[cfg(feature = "fft")]
mod fft;
mod grid;
mod least_squares;
mod memory;
mod pupil;
pub mod quadrature;
mod shown;
mod vectorised;

pub use circle::{circle_point_at_eighth, circle_point_at_turn};
#[cfg(feature = "fft")]
pub use fft::{Fft2, Fft2Error, Fft2Scratch};
pub use grid::{Grid, GridError, wrap_coordinate};
pub use least_squares::{LeastSquaresError, Minimum, NormalEquations, minimise};
pub use memory::{MemoryError, available_memory, check_memory};
pub use pupil::{
    circular_path_overlap, circular_path_overlap_inverse, disc_overlap, disc_overlap_inverse, jinc,
    sinc, sinc_inverse, sinc_pi_squared,
};
pub use shown::Shown;
pub use vectorised::vectorised;
