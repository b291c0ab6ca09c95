//! Contrast of speckle averaged over pixels and exposures.

pub(crate) mod exposure;
pub(crate) mod pixel;
pub(crate) mod rectangular_pixel;
