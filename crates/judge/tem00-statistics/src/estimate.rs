//! Estimators of what samples and images show.

pub(crate) mod autocovariance;
pub(crate) mod gamma_fit;
pub(crate) mod local_contrast;
pub(crate) mod moments;
pub(crate) mod pixel_widening;
pub(crate) mod singularities;
pub(crate) mod speckle_size;
pub(crate) mod uneven_light;
