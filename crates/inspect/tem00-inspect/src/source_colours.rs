//! The colours of sources of uncertainty.

use tem00_report::plot::{
    Colour,
    colours::{
        CALIBRATION, DARK_NOISE, DETECTOR_BIAS, DSNU, OTHER, PRNU, QUANTISATION, SHOT_NOISE,
        SPECKLE,
    },
};
use tem00_triangulation::UncertaintySource;

/// Returns the colour of a source of uncertainty.
pub(crate) const fn of_source(source: UncertaintySource) -> Colour {
    match source {
        UncertaintySource::Speckle => SPECKLE,
        UncertaintySource::ShotNoise => SHOT_NOISE,
        UncertaintySource::DarkNoise => DARK_NOISE,
        UncertaintySource::Quantisation => QUANTISATION,
        UncertaintySource::Prnu => PRNU,
        UncertaintySource::Dsnu => DSNU,
        UncertaintySource::DetectorBias => DETECTOR_BIAS,
        UncertaintySource::Calibration => CALIBRATION,
        _ => OTHER,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_source_has_a_colour_of_its_own() {
        let sources = UncertaintySource::ALL.map(of_source);
        for (index, a) in sources.iter().enumerate() {
            assert!(*a != OTHER && !sources[..index].contains(a), "{a:?}");
        }
    }
}
