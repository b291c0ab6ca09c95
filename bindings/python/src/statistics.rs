//! Bindings of `tem00-statistics`, the module `tem00.statistics`.

mod contrasts;
mod estimators;
mod hypotheses;
mod images;
mod laws;
mod lines;
mod objective;
mod space;

use pyo3::prelude::*;

/// Modules of the statistics crate in one.
mod physics {
    pub(super) use tem00_statistics::{estimate::*, laws::*, test::*};
}

/// Closed forms of speckle theory, estimators and hypothesis tests.
///
/// Intensities of the closed forms are in units of their mean, lengths in units of the speckle size
/// h = λ d / D. Estimates from images are in pixels; images are arrays [row, column], taken in
/// single precision. Samples are arrays of any shape.
#[pymodule(submodule)]
pub(crate) mod statistics {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        contrasts::{
            boiling_contrast, contrast_of_exposure, contrast_squared_spread,
            gaussian_filter_contrast, pixel_contrast, rectangular_pixel_contrast,
            translation_contrast,
        },
        estimators::{Contrast, GammaFit, VortexDensity, pearson_correlation, phase_singularities},
        hypotheses::{GoodnessOfFit, GreyLevels, t_test_mean},
        images::{
            SpeckleSize, autocovariance, decorrelated_samples, local_contrast, power_spectrum,
            radial_average,
        },
        laws::{
            CoherentBackground, GammaIntensity, IncoherentSum, JointIntensity, PartiallyPolarised,
            PhasorSum, exponential_cumulative, exponential_density, moment_of_phasor_sum,
        },
        lines::{
            disc_spot_centroid_deviation, gaussian_spot_centroid_deviation,
            imaged_line_centroid_deviation, line_centroid_deviation, speckle_length,
        },
        objective::ObjectiveSpeckle,
        space::{
            airy_autocovariance, airy_power_spectrum, area_fraction_above, level_crossings,
            size_before_pixels,
        },
    };

    #[pymodule_export]
    const AIRY_FIRST_ZERO: f64 = tem00_statistics::laws::AIRY_FIRST_ZERO;
    #[pymodule_export]
    const AIRY_HALF_WIDTH: f64 = tem00_statistics::laws::AIRY_HALF_WIDTH;
    #[pymodule_export]
    const COHERENCE_AREA: f64 = tem00_statistics::laws::COHERENCE_AREA;
    #[pymodule_export]
    const MEAN_SQUARE_SLOPE: f64 = tem00_statistics::laws::MEAN_SQUARE_SLOPE;
    #[pymodule_export]
    const SPECKLE_DENSITY: f64 = tem00_statistics::laws::SPECKLE_DENSITY;
    #[pymodule_export]
    const VORTEX_DENSITY: f64 = tem00_statistics::laws::VORTEX_DENSITY;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::arrays::add_named(module, &["Ring", "Singularity", "TestOutcome"])
    }
}
