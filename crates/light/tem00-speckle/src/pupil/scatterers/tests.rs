use tem00_statistics::{
    PhasorSum, chi_squared, contrast_of_phasor_sum, kolmogorov_smirnov, t_test_mean,
};

use super::*;
use crate::error::assert_refused;

const SIZE: [usize; 2] = [20, 20];
const SPECKLE_SIZE: f64 = 2.5;

fn field(count: usize, seed: u64) -> PupilField {
    PupilField::from_scatterers(count, SIZE, SPECKLE_SIZE, seed).unwrap()
}

/// Mean of Iᵏ over the pattern.
fn moment(field: &PupilField, order: i32) -> f64 {
    let pattern = field.pattern();
    let values = pattern.values().values();
    let powers = values.iter().map(|&i| f64::from(i).powi(order));
    powers.sum::<f64>() / values.len() as f64
}

#[test]
fn so_many_points_of_the_pupil_shine_and_no_others() {
    for count in [1, 2, 8, 30, 49] {
        let field = field(count, 3);
        let samples = field.samples().unwrap();
        let origin = [samples.width() / 2, samples.height() / 2].map(to_signed);
        let mut lit = 0;
        for (index, sample) in samples.values().iter().enumerate() {
            if sample.norm_sqr() <= 0.0 {
                continue;
            }
            lit += 1;
            assert!((sample.norm() - 1.0).abs() < 1e-6, "{sample}");
            let (x, y) = (index % samples.width(), index / samples.width());
            let [x, y] = [to_signed(x) - origin[0], to_signed(y) - origin[1]];
            // The pupil has a diameter of 8 points.
            assert!(x * x + y * y <= 16, "({x}, {y})");
        }
        assert_eq!(lit, count, "sources");
    }
}

#[test]
fn means_are_one_and_no_point_is_brighter_than_all_in_step() {
    for count in [1, 2, 5, 20] {
        for seed in 0..4 {
            let field = field(count, seed);
            // Parseval; rounding to f32.
            let mean = moment(&field, 1);
            assert!((mean - 1.0).abs() < 1e-6, "mean {mean} of {count}");
            let pattern = field.pattern();
            let limit = count as f64 * (1.0 + 1e-6);
            let brightest = pattern
                .values()
                .values()
                .iter()
                .fold(0.0_f32, |a, &b| a.max(b));
            assert!(f64::from(brightest) <= limit, "{brightest} of {count}");
        }
    }
}

#[test]
fn one_source_is_uniform_and_two_make_fringes() {
    for seed in 0..8 {
        for count in [1, 2] {
            let squared = moment(&field(count, seed), 2) - 1.0;
            let expected = contrast_of_phasor_sum(count).powi(2);
            // Exact for one pair of waves, whose fringes the samples resolve.
            assert!((squared - expected).abs() < 1e-5, "{squared} of {count}");
        }
    }
}

#[test]
fn the_contrast_of_the_ensemble_is_that_of_a_phasor_sum() {
    for count in [3, 5, 12] {
        let squares: Vec<f64> = (0..200)
            .map(|seed| moment(&field(count, seed), 2) - 1.0)
            .collect();
        let expected = contrast_of_phasor_sum(count).powi(2);
        // α = 1e−4 each; the seeds are independent.
        let outcome = t_test_mean(&squares, expected).unwrap();
        assert!(
            outcome.p_value > 1e-4,
            "{outcome:?} for {expected} of {count}"
        );
    }
}

#[test]
fn the_intensity_in_a_point_has_the_law_of_a_phasor_sum() {
    let law = PhasorSum::new(8).unwrap();
    let sample = |seed| f64::from(field(8, seed).pattern().values()[(3, 11)]);
    let samples: Vec<f64> = (1000..1600).map(sample).collect();
    // One point of each seed: independent. α = 1e−4.
    let outcome = kolmogorov_smirnov(&samples, |i| law.cumulative(i)).unwrap();
    assert!(outcome.p_value > 1e-4, "{outcome:?}");
}

#[test]
fn all_points_of_the_pupil_are_equally_probable() {
    let mask = Mask::new(&Pupil::Circle, [8.0; 2], [0.0; 2]);
    let points = points_of(&mask);
    let mut counts = vec![0; points.len()];
    for seed in 0..4900 {
        let samples = scatter(&mask, 1, &mut generator(seed));
        let [x, y] = [samples.width() / 2, samples.height() / 2].map(to_signed);
        let lit = |&[kx, ky]: &[i64; 2]| samples.wrapped(x + kx, y + ky).norm_sqr() > 0.5;
        counts[points.iter().position(lit).unwrap()] += 1;
    }
    let expected = vec![4900.0 / points.len() as f64; points.len()];
    // The total is given. α = 1e−4.
    let outcome = chi_squared(&counts, &expected, 1).unwrap();
    assert!(outcome.p_value > 1e-4, "{outcome:?}");
}

#[test]
fn as_many_sources_as_points_are_the_most() {
    for count in [0, 50, usize::MAX] {
        let field = PupilField::from_scatterers(count, SIZE, SPECKLE_SIZE, 1);
        let rule = "count must be 1 to 49 scatterers, the lattice points in the pupil";
        assert_refused(field, rule, count as f64);
    }
    let field = PupilField::from_scatterers(5, SIZE, 1.0, 1);
    assert_eq!(field.unwrap_err().parameter(), "speckle_size");
}
