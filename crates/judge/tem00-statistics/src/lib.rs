#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Intensities of the closed forms are in units of their mean.
//! - Lengths of the closed forms are in units of the speckle size `h = λ d / D`, with the
//!   wavelength, the distance from pupil to image and the pupil diameter: the period of the finest
//!   fringes in the pattern. Its half width at half maximum is 0.514 h and its first zero 1.22 h.
//! - Estimates from images are in pixels. A lag or frequency `(x, y)` of a computed grid stands at
//!   `(x, y)`, negative ones at the far end, so that
//!   [`Grid::wrapped`](tem00_numerics::Grid::wrapped) takes them as they are.
//! - Every estimator says what it assumes and how it is biased. Input that determines no answer is
//!   a [`StatisticsError`]; no result is NaN.
//!
//! # Rooms
//!
//! - [`laws`]: the intensity at one point and two, the contrast that pixels and exposures leave,
//!   speckle in space, and the noise of laser lines and spots.
//! - [`estimate`]: moments, contrast, autocovariance, speckle size, singularities, uneven light.
//! - [`test`](mod@test): Kolmogorov–Smirnov, χ², t, also for images that are rounded to few grey
//!   levels.
//!
//! What is asked for most stands here, too.
//!
//! # Scope and non-goals
//!
//! First- and second-order statistics of the intensity. What has a speckle size is behind a
//! circular pupil, unless it says otherwise. No plotting, no general statistics: the distributions
//! behind the tests come from `statrs`.

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
