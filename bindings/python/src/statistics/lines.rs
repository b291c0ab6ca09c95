use super::physics;

functions! {
    /// Return the speckle length of rows.
    ///
    /// The integral, over all distances across the rows, of the autocovariance of speckle that is
    /// averaged over a row's height along the line, in units of the speckle size.
    ///
    /// Parameters
    /// ----------
    /// row_height : float or array_like
    ///     Extent of a pixel along the line in units of the speckle size, 0 or more.
    map speckle_length(row_height: not_negative);

    /// Return the standard deviation of the centroid of a wide laser line under speckle.
    ///
    /// It is √(radius · ``speckle_length(row_height)`` / (8 √π)) of one polarised pattern, to first
    /// order in the fluctuations: within 1 % from a radius of one speckle on for a line that a lens
    /// images on a rough surface, and within 5 % from 4.2 speckles on for a pattern times the
    /// irradiance, as in renderers, which scatters less.
    ///
    /// Parameters
    /// ----------
    /// radius, row_height : float or array_like
    ///     1/e² half-width of the line and extent of a pixel along it, in units of the speckle size
    ///     as the result, 0 or more. They are broadcast together.
    map line_centroid_deviation(radius: not_negative, row_height: not_negative);

    /// Return the standard deviation of the centroid of a laser line on a rough surface that a lens
    /// images.
    ///
    /// First order in the fluctuations, for lines of any width.
    ///
    /// Parameters
    /// ----------
    /// radius, row_height : float or array_like
    ///     1/e² half-width of the line and extent of a pixel along it, in units of the speckle size
    ///     as the result, 0 or more. They are broadcast together.
    map imaged_line_centroid_deviation(radius: not_negative, row_height: not_negative);

    /// Return the standard deviation of the centroid of a round Gaussian spot under speckle, along
    /// one axis.
    ///
    /// Parameters
    /// ----------
    /// radius : float or array_like
    ///     1/e² radius in units of the speckle size, as the result, 0 or more.
    map gaussian_spot_centroid_deviation(radius: not_negative);

    /// Return the standard deviation of the centroid of a uniform round spot under speckle, along
    /// one axis.
    ///
    /// Parameters
    /// ----------
    /// radius : float or array_like
    ///     Radius in units of the speckle size, as the result, 0 or more.
    map disc_spot_centroid_deviation(radius: not_negative);
}
