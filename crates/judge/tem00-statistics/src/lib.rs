#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Intensities of the closed forms are in units of their mean.
//! - Lengths of the closed forms are in units of the speckle size `h = λ d / D`, with the
//!   wavelength, the distance from pupil to image and the pupil diameter: the period of the finest
//!   fringes in the pattern. Its half width at half maximum is 0.514 h and its first zero 1.22 h.
//! - Estimates from images are in pixels. A lag or frequency `(x, y)` of a computed grid is stored
//!   at `(x, y)`, and negative ones at the far end, so that
//!   [`Grid::wrapped`](tem00_numerics::Grid::wrapped) accepts their coordinates directly.
//! - Every estimator documents its assumptions and its bias. Input that determines no result gives
//!   a [`StatisticsError`]; no result is NaN.
//!
//! # Rooms
//!
//! - [`laws`]: the intensity at one point and two, the contrast of pixels and exposures, speckle in
//!   space, and the noise of laser lines and spots.
//! - [`estimate`]: moments, contrast, autocovariance, speckle size, singularities, uneven light.
//! - [`test`](mod@test): Kolmogorov–Smirnov, χ², t, also for images that are rounded to few grey
//!   levels.
//!
//! The most frequently used items are also available at the top level.
//!
//! # Scope and non-goals
//!
//! The crate covers first- and second-order statistics of the intensity. Laws with a speckle size
//! hold for a circular pupil unless their documentation states otherwise. There is no plotting and
//! no general statistics: the distributions behind the tests come from `statrs`.

mod axis;
mod centroid;
mod contrast;
mod error;
pub mod estimate;
mod hypothesis;
mod intensity;
pub mod laws;
mod space;
#[cfg(test)]
mod synthetic;
pub mod test;

pub use error::StatisticsError;
pub use estimate::{Boundary, Contrast, Moments, SpeckleSize, autocovariance, pearson_correlation};
pub use laws::{
    CoherentBackground, GammaIntensity, IncoherentSum, PartiallyPolarised, airy_autocovariance,
    exponential_cumulative, exponential_density, pixel_contrast, rectangular_pixel_contrast,
};
pub use test::{TestOutcome, chi_squared, kolmogorov_smirnov, t_test_mean};
