//! Autocovariance of the intensity.

use proptest::prelude::*;
use tem00::numerics::Grid;

use super::lattice::{Lattice, cases, covariance_spread, signed};

/// The mean of (I(x) − 1)(I(x + lag) − 1) over a tile.
fn covariance(pattern: &Grid<f32>, [x, y]: [i64; 2]) -> f64 {
    let mut sum = 0.0;
    for (row, values) in pattern.rows().enumerate() {
        for (column, &value) in values.iter().enumerate() {
            let there = *pattern.wrapped(signed(column) + x, signed(row) + y);
            sum += (f64::from(value) - 1.0) * (f64::from(there) - 1.0);
        }
    }
    sum / pattern.values().len() as f64
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn autocovariance_is_the_squared_transform_of_the_pupil(
        case in cases(28..56, 3.0),
        lags in prop::collection::vec([-9_i64..9, -9_i64..9], 4),
    ) {
        const TILES: u64 = 60;
        let field = case.field();
        let patterns: Vec<_> = (0..TILES)
            .map(|tile| field.clone().with_seed(case.seed.wrapping_add(tile)))
            .map(|field| field.pattern_at(case.offset, case.defocus))
            .collect();
        let lattice = Lattice::of(&field, case.offset);
        let (correlations, count) = (lattice.correlations(), lattice.phasors());
        let (fixed_mean, fluctuating) =
            if case.is_unit() { (1.0 / count, None) } else { (0.0, Some(count)) };
        for lag in lags.into_iter().chain([[0, 0], [1, 0], [0, 1]]) {
            let sum: f64 = patterns.iter().map(|p| covariance(p.values(), lag)).sum();
            let expected = lattice.correlation(lag).norm_sqr() - fixed_mean;
            let difference = sum / TILES as f64 - expected;
            let spread = covariance_spread(&correlations, lag, fluctuating) / (TILES as f64).sqrt();
            // 140 lags at 5.5 standard deviations: α = 5e−6 for a normal law. That of so many
            // speckles is skewed by 10/√(0.85 · 60 N), 0.2 at most, which makes it some 5e−5.
            prop_assert!(
                difference.abs() < 5.5 * spread,
                "lag {lag:?}: {difference} of {expected}, spread {spread}"
            );
        }
    }
}
