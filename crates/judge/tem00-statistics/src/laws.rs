//! Closed forms: the distributions of the intensity, and the laws of contrast, of speckle in space,
//! and of lines and spots under speckle.

pub use crate::{
    centroid::{
        imaged::{
            defocused_line_centroid_deviation, imaged_line_centroid_deviation,
            imaged_line_power_contrast,
        },
        line::{SpeckledLine, line_centroid_deviation},
        pixel_autocovariance::{PixelAutocovariance, PixelColumn},
        row_spectrum::speckle_length,
        spot::{disc_spot_centroid_deviation, gaussian_spot_centroid_deviation},
    },
    contrast::{
        exposure::{boiling_contrast, contrast_of_exposure, translation_contrast},
        pixel::pixel_contrast,
        rectangular_pixel::{gaussian_filter_contrast, rectangular_pixel_contrast},
    },
    intensity::{
        background::CoherentBackground,
        first_order::{
            GammaIntensity, contrast_of_phasor_sum, exponential_cumulative, exponential_density,
        },
        joint::JointIntensity,
        phasor_sum::{PhasorSum, moment_of_phasor_sum},
        polarisation::PartiallyPolarised,
        sums::IncoherentSum,
    },
    space::{
        objective::{LitArea, ObjectiveSpeckle},
        second_order::{
            AIRY_FIRST_ZERO, AIRY_HALF_WIDTH, COHERENCE_AREA, airy_autocovariance,
            airy_power_spectrum, contrast_squared_spread,
        },
        spatial::{
            MEAN_SQUARE_SLOPE, SPECKLE_DENSITY, VORTEX_DENSITY, area_fraction_above,
            level_crossings,
        },
    },
};
