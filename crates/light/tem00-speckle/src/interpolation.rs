//! Interpolation of the amplitude between the samples of a slice: a prefiltered cubic B-spline.

pub(crate) mod covariance;
pub(crate) mod spline;
pub(crate) mod taps;
