//! Bindings of `tem00-coherence`, the module `tem00.coherence`.

mod cell;
mod mixed;
mod spectrum;

use pyo3::prelude::*;

pub(crate) use self::spectrum::Spectrum;

/// Speckle in light that is not of one wavelength.
///
/// Directions are arrays of shape (3,) and lead away from the surface. Displacements across the
/// pupil are in pupil diameters, lags on the object in speckle sizes; both along the tilt of the
/// resolution cell, then across it.
#[pymodule(submodule)]
pub(crate) mod coherence {
    #[pymodule_export]
    use super::{
        cell::ResolutionCell,
        mixed::{cascade_variance, mixed_contrast},
        spectrum::Spectrum,
    };
}
