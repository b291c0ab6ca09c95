use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::*;
use crate::interpolation::covariance::tests::spline;

#[test]
#[expect(clippy::cast_possible_truncation, reason = "exact fractions")]
fn weights_are_the_kernel_at_the_four_samples() {
    for f in [0.0, 0.125, 0.25, 0.5, 0.75, 0.999_023_437_5] {
        let weights = cubic_weights(f as f32);
        for (t, weight) in [-1.0, 0.0, 1.0, 2.0].iter().zip(weights) {
            assert_absolute(f64::from(weight), spline(t - f), 1e-7);
        }
    }
}

/// The remainder of x in [0, period), in whole numbers of 2⁻⁶⁰, by the bits of x.
fn remainder(x: f64, period: i128) -> Option<i128> {
    let bits = x.to_bits();
    let exponent = i32::try_from(bits >> 52 & 0x7ff).unwrap() - 1_075;
    let mantissa = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
    let units = match exponent + 60 {
        shift @ 0..=70 => mantissa << shift,
        shift @ -60..0 if mantissa.trailing_zeros() >= shift.unsigned_abs() => mantissa >> -shift,
        _ => return None,
    };
    let units = if x < 0.0 { -units } else { units };
    Some(units.rem_euclid(period << 60))
}

fn place(x: f64, cells: usize) -> (f64, Option<f64>) {
    let ([cell], [f]) = Period::new(cells).split(&[x]);
    assert!(cell < cells && (0.0..=1.0).contains(&f), "{cell} + {f}");
    let units = (1_i128 << 60) as f64;
    let expected = remainder(x, i128::try_from(cells).unwrap());
    (cell as f64 + f, expected.map(|n| n as f64 / units))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    /// Multiplication by 1/Q removes whole periods as exactly as integers do, and so does the
    /// remainder operation that takes over at 2⁵⁰.
    #[test]
    fn whole_periods_are_taken_off_exactly(
        mantissa in -(1_i64 << 53)..1 << 53, exponent in -52_i32..17, cells in 1_usize..40_000,
    ) {
        let x = mantissa as f64 * 2.0_f64.powi(exponent);
        let (got, expected) = place(x, cells);
        if let Some(expected) = expected {
            // Sums of a negative x and the period are rounded to a number of f64, and only these.
            let rounding = if x < 0.0 { 0.5 * f64::EPSILON * cells as f64 } else { 0.0 };
            prop_assert!((got - expected).abs() <= rounding, "{x}: {got} | {expected}");
        }
    }
}

#[test]
fn the_ends_of_the_period_are_met_exactly() {
    for cells in [1, 16, 1_000, 32_768] {
        let q = cells as f64;
        for n in [-1e12, -3.0, -1.0, 0.0, 1.0, 7.0, 1e12] {
            let ([cell], [f]) = Period::new(cells).split(&[n * q]);
            assert!(cell == 0 && f.abs() <= 0.0, "{n} · {cells}: {cell} + {f}");
        }
        let ([cell], [f]) = Period::new(cells).split(&[-1e-300]);
        assert!(cell == cells - 1 && (f - 1.0).abs() <= 0.0, "{cell} + {f}");
    }
}

#[test]
fn coordinates_that_are_not_finite_leave_their_neighbours_as_they_are() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (cells, fractions) = Period::new(16).split(&[17.5, bad]);
        assert_eq!((cells, fractions[0]), ([1, 15], 0.5));
        assert!(fractions[1].is_nan(), "{bad}");
    }
}
