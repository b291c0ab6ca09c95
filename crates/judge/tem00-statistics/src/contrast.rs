//! The contrast that pixels and exposures leave.

pub(crate) mod exposure;
pub(crate) mod pixel;
pub(crate) mod rectangular_pixel;
