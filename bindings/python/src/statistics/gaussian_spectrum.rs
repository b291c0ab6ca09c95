use core::f64::consts::FRAC_PI_2;

use pyo3::prelude::*;
use tem00_statistics as physics;

use crate::arrays::{Numbers, Values, map};

/// Light of a narrow Gaussian spectrum, and the contrast of the speckle it makes.
///
/// Parameters
/// ----------
/// wavelength : float
///     Central wavelength in metres.
/// linewidth : float
///     Full width at half maximum in metres, at most a tenth of the wavelength.
#[pyclass(frozen, eq, module = "tem00.statistics")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GaussianSpectrum(physics::GaussianSpectrum);

methods! {
    impl GaussianSpectrum as this: this.0;

    make new(wavelength, linewidth);

    /// Central wavelength in metres.
    get wavelength -> f64;

    /// Linewidth, the full width at half maximum, in metres.
    get linewidth -> f64;

    /// Coherence length in metres.
    get coherence_length -> f64;

    /// Return the correlation of the patterns at the central and at a longer wavelength.
    ///
    /// Parameters
    /// ----------
    /// shift : float or array
    ///     By how much the other wavelength is longer, in metres.
    /// path_spread : float or array
    ///     Standard deviation of the optical path, in metres, 0 or more.
    map correlation(shift, path_spread: not_negative);

    /// Return the contrast of the speckle in this light.
    ///
    /// Parameters
    /// ----------
    /// path_spread : float or array
    ///     Standard deviation of the optical path, in metres, 0 or more.
    map contrast(path_spread: not_negative);

    made_by new(wavelength, linewidth);
}

/// Return the standard deviation of the optical path of light reflected by a rough surface.
///
/// Parameters
/// ----------
/// height_spread : float or array
///     Standard deviation of the height of the surface, in metres, 0 or more.
/// angles : pair of floats or arrays
///     Angles of incidence and of observation to the normal, in radians, from −π/2 to π/2.
///
/// Returns
/// -------
/// float or array
///     Standard deviation in metres, in the common shape.
#[pyfunction]
pub(super) fn path_spread_of_reflection<'py>(
    py: Python<'py>,
    height_spread: Numbers<'py>,
    angles: [Numbers<'py>; 2],
) -> PyResult<Values<'py>> {
    height_spread.not_negative("height_spread")?;
    let [incidence, observation] = &angles;
    for angle in &angles {
        let before_the_surface = |angle: f64| angle.abs() <= FRAC_PI_2;
        angle.check("angles", "between -π/2 and π/2", before_the_surface)?;
    }
    let named = [
        ("height_spread", &height_spread),
        ("angles", incidence),
        ("angles", observation),
    ];
    map(py, named, |[height, incidence, observation]| {
        physics::path_spread_of_reflection(height, [incidence, observation])
    })
}
