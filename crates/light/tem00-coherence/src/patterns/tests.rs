use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{
    PeakShape, Rows, Spectrum,
    law::tests::{cell, gaussian, of},
};

fn squares(fractions: &[f64]) -> f64 {
    assert_relative(fractions.iter().sum::<f64>(), 1.0, 1e-12);
    fractions.iter().map(|part| part * part).sum()
}

#[test]
fn squares_of_modes_sum_to_the_squared_contrast() {
    let lorentzian = Spectrum::new(450e-9, 4e-9, PeakShape::Lorentzian).unwrap();
    let comb = Spectrum::comb(450e-9, 10e-9, 5).unwrap();
    let tilted = cell(450e-9, 0.0, 30.0, 0.0);
    for (spectrum, cell) in [
        (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 30.0, 1.6e-6)),
        (gaussian(450e-9, 20e-9), tilted.clone()),
        (
            gaussian(450e-9, 20e-9),
            tilted.with_defocus(0.5e-3).unwrap(),
        ),
        (lorentzian, cell(450e-9, 0.0, 30.0, 1.6e-6)),
        (comb, cell(450e-9, 0.0, 30.0, 1.6e-6)),
        (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 30.0, 20e-6)),
        (gaussian(450e-9, 20e-9), cell(450e-9, 0.0, 30.0, 90e-6)),
    ] {
        let speckle = of(&spectrum, &cell);
        let modes = speckle.modes();
        assert_absolute(squares(&modes).sqrt(), speckle.contrast(), 1.2e-3);
    }
}

#[test]
fn modes_of_heights_alone_fall_by_one_ratio() {
    let (spectrum, cell) = (gaussian(450e-9, 10e-9), cell(450e-9, -30.0, 30.0, 1.6e-6));
    let speckle = of(&spectrum, &cell);
    let squared = speckle.contrast().powi(2);
    let ratio = (1.0 - squared) / (1.0 + squared);
    for (n, mode) in (0..5).zip(speckle.modes()) {
        assert_absolute(mode, (1.0 - ratio) * ratio.powi(n), 1e-4);
    }
}

#[test]
fn fractions_keep_any_variance_down_to_that_of_the_most_patterns() {
    for variance in [1.0, 0.5, 0.1, 0.01, 0.0045, 0.003, 0.0015] {
        let fractions = geometric_fractions(variance);
        assert!(fractions.len() <= MAX_PATTERNS as usize);
        assert_relative(squares(&fractions), variance, 3e-4);
    }
    let min = geometric_fractions(0.0);
    assert_relative(squares(&min), 1.0 / f64::from(MAX_PATTERNS), 1e-6);
}

#[test]
fn the_extent_of_a_source_adds_patterns_to_those_of_its_line() {
    let contrast = |speckle: &PolychromaticSpeckle<'_>| speckle.contrast().powi(2);
    let noise = |speckle: &PolychromaticSpeckle<'_>| speckle.line_noise_ratio(Rows::Thin).powi(2);
    let extent = SourceExtent::disc(0.03).unwrap();
    for (linewidth, rms_height, few_heights) in
        [(0.0, 0.0, true), (5e-9, 1e-6, true), (20e-9, 9e-6, false)]
    {
        let spectrum = &gaussian(450e-9, linewidth);
        let point = &cell(450e-9, 0.0, 30.0, rms_height);
        let disc = &point.clone().with_source_extent(extent.clone());
        let [of_point, of_disc] = [point, disc].map(|cell| of(spectrum, cell));
        for variance in [contrast, noise] {
            let patterns = of_disc.patterns(variance);
            assert_eq!(!patterns.heights.is_empty(), few_heights);
            assert_eq!(patterns.heights, of_point.patterns(variance).heights);
            // For heights the fields are still to be added.
            let left = if few_heights {
                variance(&of_point)
            } else {
                1.0
            };
            assert_relative(
                squares(&patterns.fractions) * left,
                variance(&of_disc),
                1e-3,
            );
            assert!(variance(&of_disc) < 0.6 * variance(&of_point));
        }
        assert_eq!(
            of_point.patterns(contrast).fractions.len() > 1,
            !few_heights
        );
    }
}

#[test]
fn a_dense_relief_can_stand_for_a_correlated_one() {
    let relief = Relief {
        rms_height: 1.6e-6,
        correlation_length: 9e-6,
    };
    let cell = cell(450e-9, 0.0, 30.0, 0.0).with_relief(relief).unwrap();
    let spectrum = gaussian(450e-9, 20e-9);
    let speckle = of(&spectrum, &cell);
    let contrast = |cell: &ResolutionCell| {
        let spectrum = &spectrum;
        of(spectrum, cell).contrast()
    };
    let dense = dense_equivalent(cell.clone(), speckle.contrast(), contrast);
    assert_absolute(contrast(&dense), speckle.contrast(), 2e-4);
    assert!(
        dense.relief().rms_height < 0.8 * relief.rms_height,
        "{dense:?}"
    );
}
