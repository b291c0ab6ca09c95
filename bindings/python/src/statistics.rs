mod contrasts;
mod estimators;
mod hypotheses;
mod images;
mod joint;
mod laws;
mod lines;
mod objective;
mod phasors;
mod rounded;
mod singularities;
mod space;

use pyo3::prelude::*;

/// Closed forms of speckle theory, estimators and hypothesis tests.
///
/// Intensities of the closed forms are in units of their mean, lengths in units of the speckle size
/// h = λ d / D. Estimates from images are in pixels; images are arrays [row, column].
#[pymodule(submodule)]
pub(crate) mod statistics {
    #[pymodule_export]
    use super::{
        contrasts::{
            boiling_contrast, contrast_of_exposure, contrast_squared_spread,
            gaussian_filter_contrast, pixel_contrast, rectangular_pixel_contrast,
            translation_contrast,
        },
        estimators::{Contrast, GammaFit, Moments, pearson_correlation},
        hypotheses::{TestOutcome, chi_squared, kolmogorov_smirnov, t_test_mean},
        images::{
            Ring, SpeckleSize, autocovariance, decorrelated_samples, local_contrast,
            power_spectrum, radial_average,
        },
        joint::JointIntensity,
        laws::{
            CoherentBackground, GammaIntensity, IncoherentSum, PartiallyPolarised,
            exponential_cumulative, exponential_density,
        },
        lines::{
            disc_spot_centroid_deviation, gaussian_spot_centroid_deviation,
            imaged_line_centroid_deviation, line_centroid_deviation, speckle_length,
        },
        objective::{LitArea, ObjectiveSpeckle},
        phasors::{PhasorSum, contrast_of_phasor_sum, moment_of_phasor_sum},
        rounded::{GoodnessOfFit, GreyLevels},
        singularities::{Singularity, VortexDensity, phase_singularities},
        space::{
            airy_autocovariance, airy_power_spectrum, area_fraction_above, level_crossings,
            size_before_pixels,
        },
    };

    #[pymodule_export]
    const AIRY_FIRST_ZERO: f64 = tem00_statistics::AIRY_FIRST_ZERO;
    #[pymodule_export]
    const AIRY_HALF_WIDTH: f64 = tem00_statistics::AIRY_HALF_WIDTH;
    #[pymodule_export]
    const COHERENCE_AREA: f64 = tem00_statistics::COHERENCE_AREA;
    #[pymodule_export]
    const MEAN_SQUARE_SLOPE: f64 = tem00_statistics::MEAN_SQUARE_SLOPE;
    #[pymodule_export]
    const SPECKLE_DENSITY: f64 = tem00_statistics::SPECKLE_DENSITY;
    #[pymodule_export]
    const VORTEX_DENSITY: f64 = tem00_statistics::VORTEX_DENSITY;
}
