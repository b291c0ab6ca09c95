//! Law, mean and contrast of the intensity.

use proptest::prelude::*;
use tem00::{
    speckle::PupilField,
    statistics::{
        Moments,
        estimate::decorrelated_samples,
        exponential_cumulative, kolmogorov_smirnov,
        laws::{contrast_squared_spread, moment_of_phasor_sum},
        t_test_mean,
    },
};

use super::lattice::{Lattice, Shape, cases, covariance_spread};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn intensity_is_negative_exponential(case in cases(260..420, 3.5)) {
        let field = case.field();
        let stride = Lattice::of(&field, case.offset).stride([0, 0]);
        let pattern = field.pattern_at(case.offset, case.defocus);
        let samples = decorrelated_samples(pattern.values(), stride).expect("a finite pattern");
        let test = kolmogorov_smirnov(&samples, exponential_cumulative).expect("samples");
        // Some 0.8 N samples of N unit phasors: the law is off by 0.12/N, the test sees 1.4/√(0.8
        // N).
        prop_assert!(samples.len() > 900, "{} samples", samples.len());
        // 40 cases: a correct generator fails one of them with a probability of 4e−5.
        prop_assert!(test.p_value > 1e-6, "p = {:e}", test.p_value);
    }
}

fn moment(field: &PupilField, order: i32) -> f64 {
    let pattern = field.pattern();
    let values = pattern.values().values();
    let sum: f64 = values.iter().map(|&i| f64::from(i).powi(order)).sum();
    sum / values.len() as f64
}

fn field(size: [usize; 2], speckle_size: f64, shape: Shape) -> PupilField {
    PupilField::from_speckle_size(size, speckle_size, 0)
        .and_then(|field| field.with_pupil(shape.pupil()))
        .expect("a valid field")
}

/// So few phasors and so many patterns that the 1/N is seen.
#[test]
fn few_phasors_lack_one_over_their_number() {
    const TILES: u64 = 4_000;
    for (size, speckle_size, shape) in [
        ([16, 16], 2.0, Shape::Circle),
        ([19, 17], 2.1, Shape::Circle),
        ([22, 19], 2.0, Shape::Annulus(0.5)),
        ([17, 20], 2.0, Shape::Rectangle(0.7)),
        ([22, 25], 2.0, Shape::Gaussian(0.45)),
        ([17, 20], 2.1, Shape::Aberrated(0.3)),
    ] {
        let field = field(size, speckle_size, shape);
        let count = Lattice::of(&field, [0.0; 2]).phasors();
        assert!(
            (field.effective_phasor_count() / count - 1.0).abs() < 1e-6,
            "{count} phasors"
        );
        let tiles = || (0..TILES).map(|seed| field.clone().with_seed(seed));
        let squared: Vec<_> = tiles().map(|tile| moment(&tile, 2) - 1.0).collect();
        // The mean of 4000 patterns is normal; six shapes with two moments: α = 6e−5.
        let test = t_test_mean(&squared, 1.0 - 1.0 / count).expect("contrasts");
        assert!(test.p_value > 5e-6, "{shape:?}, N = {count}: {test:?}");
        let error = Moments::from_samples(&squared)
            .expect("contrasts")
            .standard_error();
        assert!(1.0 / count > 3.0 * error, "1/N is not seen: {error}");
        if (count - field.phasor_count() as f64).abs() < 1e-9 {
            let cubes: Vec<_> = tiles().map(|tile| moment(&tile, 3)).collect();
            let expected = moment_of_phasor_sum(field.phasor_count(), 3);
            let test = t_test_mean(&cubes, expected).expect("moments");
            assert!(test.p_value > 5e-6, "{shape:?}, N = {count}: {test:?}");
        }
    }
}

#[test]
fn the_contrast_of_a_pattern_spreads_as_derived() {
    const TILES: u64 = 600;
    for shape in [
        Shape::Circle,
        Shape::Annulus(0.5),
        Shape::Rectangle(0.5),
        Shape::Gaussian(0.5),
        Shape::Aberrated(0.2),
    ] {
        let field = field([64, 60], 2.0, shape);
        let squared: Vec<_> = (0..TILES)
            .map(|seed| moment(&field.clone().with_seed(seed), 2))
            .collect();
        let measured = Moments::from_samples(&squared)
            .expect("contrasts")
            .standard_deviation();
        let correlations = Lattice::of(&field, [0.0; 2]).correlations();
        let derived = covariance_spread(&correlations, [0, 0], None);
        // A spread from n tiles is known to 1/√(2n), four of them; what the derivation leaves out
        // is of the order of 1/√N = 3 %.
        let tolerance = 4.0 / (2.0 * TILES as f64).sqrt() + 0.03;
        assert!(
            (measured / derived - 1.0).abs() < tolerance,
            "{shape:?}: {measured} | {derived}"
        );
        if let Shape::Circle = shape {
            let airy = contrast_squared_spread(field.effective_diameter());
            assert!(
                (derived / airy - 1.0).abs() < 0.02,
                "1.53/C = {airy}, {derived}"
            );
        }
    }
}
