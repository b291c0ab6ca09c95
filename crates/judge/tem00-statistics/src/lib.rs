#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Intensities of the closed forms are in units of their mean.
//! - Lengths of the closed forms are in units of the speckle size `h = λ d / D`, with the
//!   wavelength, the distance from pupil to image and the pupil diameter: the period of the finest
//!   fringes in the pattern. Its half width at half maximum is 0.514 h and its first zero 1.22 h.
//! - Estimates from images are in pixels. A lag or frequency `(x, y)` of a computed grid stands at
//!   `(x, y)`, negative ones at the far end, so that
//!   [`Grid::wrapped`](tem00_numerics::Grid::wrapped) takes them as they are.
//! - Every estimator says what it assumes and how it is biased. Input that determines no answer is
//!   a [`StatisticsError`]; no result is NaN.
//!
//! # Main items
//!
//! - Laws of the intensity: [`exponential_density`], [`exponential_cumulative`],
//!   [`GammaIntensity`], [`PartiallyPolarised`], [`IncoherentSum`], [`CoherentBackground`],
//!   [`PhasorSum`], [`JointIntensity`].
//! - Contrast: [`pixel_contrast`], [`rectangular_pixel_contrast`], [`gaussian_filter_contrast`],
//!   [`contrast_of_exposure`], [`boiling_contrast`], [`translation_contrast`],
//!   [`contrast_of_phasor_sum`], [`contrast_squared_spread`].
//! - In space: [`airy_autocovariance`], [`airy_power_spectrum`], [`ObjectiveSpeckle`],
//!   [`COHERENCE_AREA`], [`VORTEX_DENSITY`], [`level_crossings`], [`area_fraction_above`].
//! - Laser lines and spots under speckle: [`line_centroid_deviation`], [`SpeckledLine`],
//!   [`imaged_line_centroid_deviation`], [`defocused_line_centroid_deviation`], [`imaged_line_power_contrast`],
//!   [`gaussian_spot_centroid_deviation`], [`disc_spot_centroid_deviation`], [`speckle_length`],
//!   [`PixelAutocovariance`].
//! - Estimators: [`Moments`], [`Contrast`], [`local_contrast`], [`GammaFit`],
//!   [`pearson_correlation`], [`autocovariance`], [`power_spectrum`], [`radial_average`],
//!   [`SpeckleSize`], [`phase_singularities`], [`VortexDensity`], [`decorrelated_samples`].
//! - Uneven light: [`Evenness`] finds it, [`FlatImage`] divides by it.
//! - Hypothesis tests: [`kolmogorov_smirnov`], [`chi_squared`], [`t_test_mean`], and for images that
//!   are rounded to few [`GreyLevels`]: [`GoodnessOfFit`].
//!
//! # Scope and non-goals
//!
//! First- and second-order statistics of the intensity. What has a speckle size is behind a circular
//! pupil, unless it says otherwise. No plotting, no general statistics: the distributions behind the
//! tests come from `statrs`.

mod axis;
mod centroid;
mod contrast;
mod error;
mod estimate;
mod hypothesis;
mod intensity;
mod space;
#[cfg(test)]
mod synthetic;

pub use axis::Axis;
pub use centroid::{
    imaged::{
        defocused_line_centroid_deviation, imaged_line_centroid_deviation,
        imaged_line_power_contrast,
    },
    line::{SpeckledLine, line_centroid_deviation},
    pixel_autocovariance::{PixelAutocovariance, PixelColumn},
    row_spectrum::speckle_length,
    spot::{disc_spot_centroid_deviation, gaussian_spot_centroid_deviation},
};
pub use contrast::{
    exposure::{boiling_contrast, contrast_of_exposure, translation_contrast},
    pixel::pixel_contrast,
    rectangular_pixel::{gaussian_filter_contrast, rectangular_pixel_contrast},
};
pub use error::StatisticsError;
pub use estimate::{
    autocovariance::{
        Boundary, Ring, autocovariance, decorrelated_samples, power_spectrum, radial_average,
    },
    gamma_fit::GammaFit,
    local_contrast::local_contrast,
    moments::{Contrast, Moments, pearson_correlation},
    pixel_widening::size_before_pixels,
    singularities::{Singularity, VortexDensity, phase_singularities},
    speckle_size::SpeckleSize,
    uneven_light::{Evenness, FlatImage, UnevenLight},
};
pub use hypothesis::{
    goodness::GoodnessOfFit,
    grey_levels::GreyLevels,
    samples::{TestOutcome, chi_squared, kolmogorov_smirnov, t_test_mean},
};
pub use intensity::{
    background::CoherentBackground,
    first_order::{
        GammaIntensity, contrast_of_phasor_sum, exponential_cumulative, exponential_density,
    },
    joint::JointIntensity,
    phasor_sum::{PhasorSum, moment_of_phasor_sum},
    polarisation::PartiallyPolarised,
    sums::IncoherentSum,
};
pub use space::{
    objective::{LitArea, ObjectiveSpeckle},
    second_order::{
        AIRY_FIRST_ZERO, AIRY_HALF_WIDTH, COHERENCE_AREA, airy_autocovariance, airy_power_spectrum,
        contrast_squared_spread,
    },
    spatial::{
        MEAN_SQUARE_SLOPE, SPECKLE_DENSITY, VORTEX_DENSITY, area_fraction_above, level_crossings,
    },
};
