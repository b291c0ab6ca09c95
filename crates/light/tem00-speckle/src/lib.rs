#![doc = include_str!("../README.md")]
//!
//! # On a graphics card
//!
//! [`closed_form`] has phasors and look-ups as text for kernels; [`Aperture`] and [`StackSource`]
//! provide the input of a transform on the card. The crate `tem00-gpu` runs it on `wgpu`.
//!
//! # Conventions
//!
//! - **Intensity** is dimensionless with mean 1.
//! - **Displacements** of the pupil are in pupil diameters, `a_P / D`, along the axes of the
//!   pattern.
//! - **Lengths** are in samples in the plane (period Q) and in lattice points in the pupil
//!   (diameter C). A speckle is `h_p = Q/C` samples wide: look up at `h_p / h` times a length on
//!   the sensor, where `h = λ d / D` is the speckle size on the sensor.
//! - **The slice coordinate** u follows from a correlation by [`SpeckleStack::coordinate_of`].
//! - **Correlation** γ is the correlation of the intensity, the square of the amplitude
//!   correlation.
//! - **Sign**: a field is the *forward* transform, `exp(−2πi k·r/Q)`, of its pupil.
//!
//! # Reproducibility
//!
//! The phasors depend on the seed alone and have the same bits on every platform. Patterns and
//! stacks have the same bits for any number of threads (feature `parallel`); between processors
//! they agree to the rounding of an `f32` Fourier transform, some 1e−6 of the mean.
//!
//! # Scope and non-goals
//!
//! The crate generates speckle behind pupils of any shape, in or out of focus, or from a field
//! measured in the pupil. A single pattern is fully developed, polarised and monochromatic; sums,
//! backgrounds and means over pixels describe other light and sensors. The geometry that moves and
//! decorrelates the speckle belongs to the crate above, as does the light that the speckle
//! modulates. A stack holds the speckle of one wave; look-ups are summed with
//! [`incoherent_fractions`].

pub mod closed_form;
mod error;
mod interpolation;
mod light;
mod pupil;
mod stack;

pub use error::SpeckleError;
pub use light::{Exposure, incoherent_fractions};
/// The complex number of [`SpeckleField`], from `num-complex`.
pub use num_complex::Complex;
pub use pupil::{
    Aperture, Phasors, Pupil, PupilField, SpeckleField, SpecklePattern, SpeckleScratch,
    Transmission,
};
pub use stack::{
    SliceLaw, SlicePath, SpeckleStack, StackNeeds, StackOptions, StackPlan, StackSource,
};
