//! The contrast that pixels, exposures and broad light leave.

pub(crate) mod bandwidth;
pub(crate) mod exposure;
pub(crate) mod pixel;
pub(crate) mod rectangular_pixel;
