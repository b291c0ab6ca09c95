//! Distributions of the intensity at one point and at two points.

pub(crate) mod background;
pub(crate) mod bessel;
pub(crate) mod descent;
pub(crate) mod first_order;
pub(crate) mod joint;
pub(crate) mod phasor_sum;
pub(crate) mod polarisation;
pub(crate) mod sums;
