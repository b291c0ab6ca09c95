//! Speckle patterns, correlated stacks of them, and look-ups that keep the statistics exact.
//!
//! Coherent light on a rough surface reaches every camera pixel as a sum of many contributions of
//! random phase. This crate generates the intensity that results, with mean 1, for a renderer to
//! multiply onto what it would show without interference.
//!
//! ```text
//! PupilField ──▶ SpecklePattern      one pattern, I = |U|²
//!            ├─▶ SpeckleField        its complex amplitude U
//!            └─▶ SpeckleStack        patterns that move and decorrelate: I(x, y, u)
//! ```
//!
//! Light that is more than one wave, and the sensor that sees it, work on these:
//!
//! ```text
//! IncoherentSum          several lasers, partial polarisation, a broad spectrum
//! CoherentBackground     a mirror reflection, a reference wave
//! Exposure               a pattern that moves or boils while it is exposed
//! PixelArray             boxes of any size at any pitch
//! ObjectiveSpeckle       a lit area instead of a pupil: speckle without a lens
//! PupilField::from_scatterers    a few point sources: partially developed speckle
//! ```
//!
//! Files: [`SpeckleStack::write_to`] keeps a stack with its bits, to be read again or mapped into
//! memory; [`NpyReader`], [`write_npy`] and the methods of that name exchange fields and patterns
//! with NumPy.
//!
//! Formulas and their derivation: `docs/theory/speckle.md` in the repository; what judges them:
//! `docs/validation/speckle.md`.
//!
//! # Conventions
//!
//! - **Intensity** is dimensionless with mean 1.
//! - **Displacements** of the pupil are in its diameters, `a_P / D`, along the axes of the pattern.
//! - **Lengths** are in samples in the plane (period Q) and in lattice points in the pupil (diameter
//!   C). A speckle is `h_p = Q/C` samples wide: look up at `h_p / h` times a length on the sensor,
//!   where `h = λ d / D` is the speckle size there.
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
//! Speckle behind pupils of any shape that may be out of focus, or of a field measured in the pupil:
//! fully developed, polarised and monochromatic by itself, and in sums, on backgrounds and over
//! pixels what light and sensor make of that. The geometry that moves and decorrelates it belongs to
//! the crate above; so does the light that it modulates. A stack has the speckle of one wave: its
//! look-ups are summed as [`IncoherentSum`] says.
//!
//! # Example
//!
//! ```
//! use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
//!
//! // 256 × 256 samples, speckles of 4 samples, 16 slices.
//! let field = PupilField::new(256, 64, 42)?;
//! let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 8 })?;
//!
//! // A surface whose motion leaves a correlation of 0.8 shows the same speckle, changed.
//! let u = stack.coordinate_of(0.8);
//! let (before, after) = (stack.intensity_at(10.3, 7.9, 0.0), stack.intensity_at(10.3, 7.9, u));
//! assert!(before >= 0.0 && after >= 0.0);
//! # Ok::<(), tem00_speckle::SpeckleError>(())
//! ```

mod error;
mod interpolation;
mod light;
mod npy;
mod pupil;
mod stack;

pub use error::SpeckleError;
pub use interpolation::Interpolation;
pub use light::{
    Bandwidth, CoherentBackground, Exposure, IncoherentSum, LitArea, ObjectiveSpeckle, PixelArray,
};
pub use npy::{NpyError, NpyReader, write_npy, write_real_npy};
/// The complex number of [`SpeckleField`], from `num-complex`.
pub use num_complex::Complex;
pub use pupil::{
    Phasors, Pupil, PupilField, SpeckleField, SpecklePattern, SpeckleScratch, Transmission,
};
pub use stack::{
    SliceLaw, SlicePath, SpeckleStack, StackFileError, StackNeeds, StackOptions, StackPlan,
};
