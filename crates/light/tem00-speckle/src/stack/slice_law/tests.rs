use core::f64::consts::TAU;

use num_complex::Complex;
use tem00_numerics::cast::to_signed;

use crate::{PupilField, SlicePath, SpeckleStack};

/// The position of a coordinate: fraction, and taps with their weights.
struct Place {
    fraction: f64,
    place: f64,
    taps: Vec<(i64, f64)>,
}

fn place(x: f64) -> Place {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a sample of a small pattern"
    )]
    let (cell, f) = (x.floor() as i64, x - x.floor());
    // The four pieces of the B-spline as polynomials of f.
    let g = 1.0 - f;
    let taps = vec![
        (cell - 1, g * g * g / 6.0),
        (cell, (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0),
        (cell + 1, (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0),
        (cell + 2, f * f * f / 6.0),
    ];
    Place {
        fraction: f,
        place: x,
        taps,
    }
}

fn amplitude(stack: &SpeckleStack, index: usize, [x, y]: &[Place; 2]) -> Complex<f64> {
    let coefficients = stack.coefficients(index);
    let mut sum = Complex::new(0.0, 0.0);
    for (row, wy) in &y.taps {
        for (column, wx) in &x.taps {
            let value = coefficients.wrapped(*column, *row);
            sum += Complex::new(f64::from(value.re), f64::from(value.im)) * (wx * wy);
        }
    }
    sum
}

fn polynomial<const N: usize>(table: &[[f32; N]; N], places: &[Place; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| {
        let f = places[axis].fraction;
        let p = f * (1.0 - f);
        let o = p * (1.0 - 2.0 * f);
        [1.0, p, p * p, p * p * p, o, o * p]
    });
    let entry = |ny: usize, nx: usize| f64::from(table[ny][nx]) * y[ny] * x[nx];
    (0..N)
        .flat_map(|ny| (0..N).map(move |nx| (ny, nx)))
        .map(|(ny, nx)| entry(ny, nx))
        .sum()
}

/// The look-up as the documentation states it.
fn documented(stack: &SpeckleStack, [x, y]: [f64; 2], (index, f): (usize, f64)) -> f64 {
    let places = [x, y].map(place);
    let next = (index + 1) % stack.slice_count();
    let (here, there) = (stack.slice_law(index), stack.slice_law(next));
    let turns = here.turns[0] * places[0].place + here.turns[1] * places[1].place;
    let blend = (1.0 - f) * amplitude(stack, index, &places)
        + f * amplitude(stack, next, &places) * Complex::cis(TAU * turns);
    let square = (1.0 - f).powi(2) * polynomial(&here.mean_square, &places)
        + f * f * polynomial(&there.mean_square, &places)
        + 2.0 * f * (1.0 - f) * polynomial(&here.covariance, &places);
    blend.norm_sqr() / square
}

#[test]
fn look_ups_follow_from_coefficients_and_closed_forms_alone() {
    let field = PupilField::new(48, 20, 3).unwrap();
    for path in [
        SlicePath::Circle { half_period: 3 },
        SlicePath::Straight {
            half_period: 4,
            length: 3,
        },
    ] {
        let stack = SpeckleStack::generate(&field, path).unwrap();
        for step in 0..40 {
            let t = f64::from(step);
            let (x, y) = (1.0 + (7.37 * t) % 44.0, 1.0 + (11.71 * t) % 44.0);
            let f = (0.37 * t) % 1.0;
            let index = usize::try_from(step).unwrap() % stack.slice_count();
            let u = f + to_signed(index) as f64;
            let expected = stack.intensity_at(x, y, u);
            let got = documented(&stack, [x, y], (index, f));
            // Sums of 16 taps in f32: 1e-6 of the brightest samples, whose intensity is ~10.
            let error = (got - expected).abs();
            assert!(error < 2e-5, "{path:?}: {error:e}");
        }
    }
}
