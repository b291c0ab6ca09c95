use pyo3::prelude::*;
use tem00_coherence as physics;

use crate::error::OrRaise;

/// Return the contrast of light that met one rough surface, single, mixed with light that met
/// several, multiple.
///
/// By default all light is polarised alike and coherent, as behind a laser of one wavelength: the
/// contrast is 1.
///
/// Parameters
/// ----------
/// multiple : float
///     The fraction of the multiple light, from 0 to 1.
/// within_single : float
///     The squared contrast of the polarised single light alone, from 0 to 1.
/// with_single : float
///     What multiple light shares with single light, from 0 to 1: the mean of
///     ``Spectrum.squared_coherence`` over the delays of the multiple light, by its energy.
/// within_multiple : float
///     What multiple light shares with itself, from 0 to 1: the mean of
///     ``Spectrum.squared_coherence`` over the differences of two delays.
/// polarisation : (float, float)
///     Degrees of polarisation of the single and of the multiple light, from 0 to 1.
#[pyfunction]
#[pyo3(signature = (
    multiple, *, within_single=1.0, with_single=1.0, within_multiple=1.0, polarisation=[1.0, 1.0]
))]
pub(super) fn mixed_contrast(
    multiple: f64,
    within_single: f64,
    with_single: f64,
    within_multiple: f64,
    polarisation: [f64; 2],
) -> PyResult<f64> {
    let light = physics::MixedLight {
        multiple,
        within_single,
        with_single,
        within_multiple,
        polarisation,
    };
    light.contrast().or_raise()
}

functions! {
    /// Return the relative variance, over a resolution cell, of light from a small lit part of
    /// another rough surface.
    ///
    /// Its own speckle makes it: of multiple light alone the squared contrast is 1 plus twice this.
    ///
    /// Parameters
    /// ----------
    /// relative_aperture : float
    ///     The sine of the half-angle of the lit part, seen from the cell, over that of the lens.
    try cascade_variance(relative_aperture: f64) -> f64 =
        physics::cascade_variance(relative_aperture);
}
