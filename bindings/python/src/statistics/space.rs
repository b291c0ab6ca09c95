use super::physics;

use crate::arrays::length;

functions! {
    /// Return the normalised autocovariance of speckle behind a circular pupil.
    ///
    /// Parameters
    /// ----------
    /// lag : float or array_like
    ///     Lag in units of the speckle size.
    map airy_autocovariance(lag);

    /// Return the power spectrum of speckle behind a circular pupil, per unit variance.
    ///
    /// Parameters
    /// ----------
    /// frequency : float or array_like
    ///     Cycles per speckle size.
    map airy_power_spectrum(frequency);

    /// Return how often the intensity rises through a level, per speckle size of a straight line.
    ///
    /// Parameters
    /// ----------
    /// level : float or array_like
    ///     Level in units of the mean intensity.
    map level_crossings(level);

    /// Return the fraction of the area of fully developed speckle that is brighter than a level.
    ///
    /// Parameters
    /// ----------
    /// level : float or array_like
    ///     Level in units of the mean intensity.
    map area_fraction_above(level);

    /// Return the speckle size before square pixels widened it to ``measured``, both in pixels.
    ///
    /// ``None`` if it was below 0.95 pixels, where the pixels hide it.
    try size_before_pixels(measured: f64) -> Option<f64> =
        length("measured", measured).map(physics::size_before_pixels);
}
