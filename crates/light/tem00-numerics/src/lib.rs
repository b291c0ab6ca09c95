#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - A [`Grid`] is row-major: `(x, y)` lies at `y · width + x`.
//! - Coordinates on a periodic grid are reduced in `f64` before anything is stored as `f32`.
//! - Functions of a pupil take lengths in units of the pupil *diameter*.
//!
//! # Scope and non-goals
//!
//! The crate holds only functions that several other crates need and no library has. It is not an
//! array library: there is no slicing, no broadcasting and no linear algebra beyond a Cholesky
//! factor.

pub mod cast;
pub mod check;
mod circle;
mod crop;
#[cfg(feature = "fft")]
mod fft;
mod fractions;
mod grid;
mod least_squares;
mod lower_factor;
mod memory;
mod normal;
pub mod parallel;
mod pupil;
pub mod quadrature;
mod refusal;
pub mod seed;
mod shown;
mod vectorised;

pub use circle::{circle_point_at_eighth, circle_point_at_turn};
pub use crop::Crop;
#[cfg(feature = "fft")]
pub use fft::{Fft2, Fft2Error, Fft2Scratch, is_fast_side};
pub use fractions::fractions;
pub use grid::{Grid, GridError, wrap_coordinate};
pub use least_squares::{
    LeastSquaresError, Minimum, NormalEquations, Residual, minimise, minimise_residuals,
};
pub use lower_factor::lower_factor;
pub use memory::{MemoryError, available_memory, check_memory};
pub use normal::normal_quantile;
pub use pupil::{
    circular_path_overlap, circular_path_overlap_inverse, disc_overlap, disc_overlap_inverse, jinc,
    sinc, sinc_inverse, sinc_pi_squared,
};
pub use refusal::{Refusal, RefusedValue};
pub use shown::Shown;
pub use vectorised::vectorised;
