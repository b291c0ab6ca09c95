use super::physics::{self, LitArea};
use pyo3::prelude::*;

use crate::{
    arrays::{LIMIT, length},
    error::OrRaise,
};

kept_class! {
    /// Speckle without a lens: the pattern that a lit area of a rough surface makes in a distant
    /// plane.
    ///
    /// Lengths are in metres; the distance is that of the plane from the surface.
    "tem00.statistics" ObjectiveSpeckle(physics::ObjectiveSpeckle)
}

/// The speckle of an area of these lengths, checked.
fn speckle(
    [wavelength, distance]: [f64; 2],
    area: LitArea,
    lengths: &[(&'static str, f64)],
) -> PyResult<physics::ObjectiveSpeckle> {
    for &(name, value) in lengths {
        length(name, value)?;
    }
    physics::ObjectiveSpeckle::new(wavelength, distance, area).or_raise()
}

methods! {
    impl ObjectiveSpeckle as this: this.inner;

    unmade "disc, rectangle or gaussian_spot";

    /// Return the speckle of a uniformly lit disc of a diameter.
    keep disc(wavelength, distance, diameter) =
        speckle([wavelength, distance], LitArea::Disc { diameter }, &[("diameter", diameter)]);

    /// Return the speckle of a uniformly lit rectangle of a width along x and a height along y.
    keep rectangle(wavelength, distance, width, height) = speckle(
        [wavelength, distance],
        LitArea::Rectangle { width, height },
        &[("width", width), ("height", height)],
    );

    /// Return the speckle of a Gaussian spot of a 1/e² radius.
    keep gaussian_spot(wavelength, distance, radius) =
        speckle([wavelength, distance], LitArea::GaussianSpot { radius }, &[("radius", radius)]);

    /// Return the normalised autocovariance of the intensity.
    ///
    /// Parameters
    /// ----------
    /// x, y : float or array_like
    ///     Lag along x and y in metres, broadcast together.
    map autocovariance(x, y) = this.inner.autocovariance([x, y]);

    /// Speckle size along x and y, in metres.
    get size -> (f64, f64);

    /// Coherence area in m².
    get coherence_area -> f64;
}
