//! Estimators for samples and images.

pub(crate) mod autocovariance;
pub(crate) mod gamma_fit;
pub(crate) mod local_contrast;
pub(crate) mod moments;
pub(crate) mod pixel_widening;
pub(crate) mod singularities;
pub(crate) mod speckle_size;
pub(crate) mod uneven_light;

pub use autocovariance::{
    Boundary, Ring, autocovariance, autocovariance_from_spectrum, decorrelated_samples,
    power_spectrum, radial_average,
};
pub use gamma_fit::GammaFit;
pub use local_contrast::local_contrast;
pub use moments::{Contrast, Moments, pearson_correlation};
pub use pixel_widening::size_before_pixels;
pub use singularities::{Singularity, VortexDensity, phase_singularities};
pub use speckle_size::SpeckleSize;
pub use uneven_light::{Evenness, FlatImage, UnevenLight};

pub use crate::axis::Axis;
