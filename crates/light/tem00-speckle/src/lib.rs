#![doc = include_str!("../README.md")]
//!
//! # On a graphics card
//!
//! [`closed_form`] has phasors and look-ups as text for kernels, [`Aperture`] and [`StackSource`]
//! what a transform there takes. The crate `tem00-gpu` does it on `wgpu`.
//!
//! # Conventions
//!
//! - **Intensity** is dimensionless with mean 1.
//! - **Displacements** of the pupil are in its diameters, `a_P / D`, along the axes of the pattern.
//! - **Lengths** are in samples in the plane (period Q) and in lattice points in the pupil
//!   (diameter C). A speckle is `h_p = Q/C` samples wide: look up at `h_p / h` times a length on
//!   the sensor, where `h = λ d / D` is the speckle size there.
//! - **The slice coordinate** u follows from a correlation by [`SpeckleStack::coordinate_of`].
//! - **Correlation** γ is that of the intensity, the square of the amplitude's.
//! - **Sign**: a field is the *forward* transform, `exp(−2πi k·r/Q)`, of its pupil.
//!
//! # Reproducibility
//!
//! The phasors depend on the seed alone and are the same bits on every platform. Patterns and
//! stacks are the same bits for any number of threads (feature `parallel`); between processors they
//! agree to the rounding of an `f32` Fourier transform, some 1e−6 of the mean.
//!
//! # Scope and non-goals
//!
//! Speckle behind pupils of any shape that may be out of focus, or of a field measured in the
//! pupil: fully developed, polarised and monochromatic by itself, and in sums, on backgrounds and
//! over pixels what light and sensor make of that. The geometry that moves and decorrelates it
//! belongs to the crate above; so does the light that it modulates. A stack has the speckle of one
//! wave: its look-ups are summed in [`incoherent_fractions`].

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
