//! Centroids of laser lines and spots under speckle, and the spectra of rows and columns of pixels.

pub(crate) mod imaged;
pub(crate) mod line;
pub(crate) mod pixel_autocovariance;
pub(crate) mod row_spectrum;
pub(crate) mod spot;
