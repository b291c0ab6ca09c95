use std::f64::consts::PI;

use num_complex::Complex;
use proptest::prelude::*;
use tem00_numerics::{Grid, cast::to_f32};
use tem00_testkit::assert_absolute;

use super::*;
use crate::{
    PupilField, SlicePath,
    pupil::lattice::unit_phasor,
    stack::tests::{circle, mean},
};

const PATHS: [SlicePath; 3] = [
    SlicePath::Still,
    SlicePath::Circle { half_period: 3 },
    SlicePath::Straight {
        half_period: 2,
        length: 3,
    },
];

fn stack(field: &PupilField, path: SlicePath) -> SpeckleStack {
    SpeckleStack::generate(field, path).unwrap()
}

/// An external field: phasors under an envelope that falls to one side, so that no two pupils
/// contain the same field.
fn measured(size: [usize; 2], speckle_size: f64) -> PupilField {
    let samples = Grid::from_fn(48, 48, |x, y| {
        let word = u32::try_from(x * 48 + y)
            .unwrap()
            .wrapping_mul(2_654_435_769);
        let envelope = (x + 4) as f32 / 52.0;
        unit_phasor(word.rotate_left(13).wrapping_mul(0x9E37_79B1)) * envelope
    });
    PupilField::from_samples(samples, size, speckle_size).unwrap()
}

#[test]
fn an_external_field_has_the_mean_of_one_between_samples() {
    let stack = stack(&measured([48, 40], 2.5), circle(2));
    for fractions in [[0.0, 0.0], [0.5, 0.5], [0.3, 0.8]] {
        for u in [0.0, 1.0, 2.0, 0.5, 1.5, 3.25] {
            let mean = mean(&stack, fractions, u);
            // By Parseval's theorem, except for the rounding of f32.
            assert!((mean - 1.0).abs() < 3e-6, "{fractions:?}, {u}: {mean}");
        }
    }
}

#[test]
fn where_no_light_falls_the_look_up_is_dark() {
    let dark = Grid::filled(8, 8, Complex::new(0.0, 0.0));
    let field = PupilField::from_samples(dark, [32, 32], 4.0).unwrap();
    let stack = stack(&field, circle(2));
    for (x, u) in [(0.0, 0.0), (3.3, 0.5), (-7.7, 2.9)] {
        let dark = stack.intensity_at(x, x, u);
        assert!(dark.abs() <= 0.0, "{dark}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Runs of points at one u, between the same slices and all over the stack.
    #[test]
    fn batches_are_the_bits_of_single_look_ups(
        points in prop::collection::vec((-1e3_f64..1e3, -1e9_f64..1e9, -50.0_f64..50.0), 0..70),
        spread in prop::sample::select(vec![0.0, 1e-3, 1.0]), whole: bool,
        (width, height) in (16_usize..40, 16_usize..40), path in 0_usize..3,
    ) {
        let field = PupilField::from_speckle_size([width, height], 2.0, 9).unwrap();
        let stack = stack(&field, PATHS[path]);
        let x: Vec<_> = points.iter().map(|p| p.0).collect();
        let y: Vec<_> = points.iter().map(|p| p.1).collect();
        let u = |p: &(f64, f64, f64)| spread * p.2 + if whole { 1.0 } else { 0.7 };
        let u: Vec<_> = points.iter().map(u).collect();
        let mut batch = vec![f64::NAN; points.len()];
        stack.intensity_batch(&x, &y, &u, &mut batch);
        for (i, got) in batch.iter().enumerate() {
            prop_assert_eq!(got.to_bits(), stack.intensity_at(x[i], y[i], u[i]).to_bits());
        }
    }

    /// Coordinates are whole numbers of 2⁻²⁰, so that those whole periods away are numbers of f64
    /// too.
    #[test]
    fn look_ups_whole_periods_apart_are_the_same_bits(
        x in -(1_i64 << 33)..1 << 33, y in -(1_i64 << 33)..1 << 33, u in -(1_i64 << 33)..1 << 33,
        turns in prop::array::uniform3(-(1_i64 << 23)..1 << 23),
        (width, height) in (16_usize..260, 16_usize..260),
        path in 0_usize..3,
    ) {
        let field = PupilField::from_speckle_size([width, height], 2.0, 9).unwrap();
        let stack = stack(&field, PATHS[path]);
        let periods = [width, height, stack.slice_count()];
        let [x, y, u] = [x, y, u].map(|n| n as f64 / 1_048_576.0);
        let [nx, ny, nu] = [0, 1, 2].map(|i| turns[i] as f64 * periods[i] as f64);
        let here = stack.intensity_at(x, y, u);
        let there = stack.intensity_at(x + nx, y + ny, u + nu);
        prop_assert_eq!(here.to_bits(), there.to_bits(), "{} and {}", here, there);
    }

    #[test]
    fn look_ups_of_any_finite_coordinate_are_finite(
        x in prop::num::f64::NORMAL, y in -1e15_f64..1e15, u in prop::num::f64::NORMAL,
        near in -1e15_f64..1e15, width in prop::num::f64::NORMAL,
        (columns, rows) in (16_usize..50, 16_usize..50), path in 0_usize..3,
    ) {
        let field = PupilField::from_speckle_size([columns, rows], 2.0, 9).unwrap();
        let stack = stack(&field, PATHS[path]);
        for (x, y, u) in [(x, y, u), (y, x, near)] {
            let intensity = stack.intensity_at(x, y, u);
            prop_assert!(intensity.is_finite() && intensity >= 0.0, "{intensity}");
            let average = stack.average_over([x, y], [width.abs(), 1.0], u);
            prop_assert!(average.is_finite() && average >= 0.0, "{average}");
        }
    }

    #[test]
    fn averages_are_those_of_many_points(
        x in -100.0_f64..100.0, y in -100.0_f64..100.0, u in 0.0_f64..4.0,
        speckles in [0.0_f64..28.0, 0.0_f64..4.0],
        (size, speckle_size) in prop::sample::select(vec![([32, 48], 2.5), ([104, 152], 8.0)]),
    ) {
        let [width, height] = speckles.map(|count| count * speckle_size);
        let field = PupilField::from_speckle_size(size, speckle_size, 11).unwrap();
        let stack = stack(&field, circle(2));
        // The oracle is the midpoint rule: over n points its error is at most π q / (6 n²) for a
        // wave of q periods, 1e-4. Between two slices there are up to two waves in a speckle.
        let midpoints = |centre: f64, size: f64| {
            let min = (PI * (2.0 * size / speckle_size) / 6e-4).sqrt();
            let count = (1_u32..).find(|count| f64::from(*count) >= min).unwrap();
            let at = move |i| centre + size * ((f64::from(i) + 0.5) / f64::from(count) - 0.5);
            (0..count).map(at).collect::<Vec<_>>()
        };
        let (across, along) = (midpoints(x, width), midpoints(y, height));
        let points = across.iter().flat_map(|&x| along.iter().map(move |&y| [x, y]));
        let sum: f64 = points.map(|[x, y]| stack.intensity_at(x, y, u)).sum();
        let mean = sum / (across.len() * along.len()) as f64;
        let got = stack.average_over([x, y], [width, height], u);
        // The stated images of a cubic spline, of which all waves together have a quarter.
        let tolerance = 1e-4 + 0.25 * (2.0 * speckle_size - 1.0).powi(-4);
        prop_assert!((got - mean).abs() < tolerance, "{got} | {mean}");
    }
}

/// Among positions in the pattern, which keep their bits.
#[test]
#[expect(clippy::float_cmp, reason = "exact by definition")]
fn a_place_that_is_none_has_the_mean_and_correlates_with_nothing() {
    let field = PupilField::from_speckle_size([20, 24], 2.0, 9).unwrap();
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for (path, bad, axis) in PATHS.iter().flat_map(|path| {
        bad.into_iter()
            .flat_map(move |bad| (0..3).map(move |axis| (path, bad, axis)))
    }) {
        let stack = stack(&field, *path);
        let mut none = [3.5, 4.25, 0.5];
        none[axis] = bad;
        let [x, y, u] = none;
        let case = format!("{path:?}: {none:?}");
        assert_eq!(stack.intensity_at(x, y, u), 1.0, "{case}");
        assert_eq!(stack.amplitude_at(x, y, u).norm_sqr(), 1.0, "{case}");
        assert_eq!(stack.average_over([x, y], [2.0, 1.0], u), 1.0, "{case}");
        let sides = [[bad.abs(), 1.0], [1.0, bad.abs()]];
        assert_eq!(
            stack.average_over([3.0, 4.0], sides[axis % 2], 0.5),
            1.0,
            "{case}"
        );
        assert_eq!(stack.correlation_at(bad), 0.0, "{case}");
        assert_eq!(stack.correlation_between(bad, 0.0), 0.0, "{case}");
        assert_eq!(stack.correlation_between(0.5, bad), 0.0, "{case}");

        let places = [0, 1, 2].map(|i| {
            let mut places = [[3.5, 4.25, 0.5][i]; LANES + 3];
            places[7] = none[i];
            places
        });
        let there = stack.intensity_at(3.5, 4.25, 0.5);
        let mut batch = [f64::NAN; LANES + 3];
        let [x, y, u] = &places;
        stack.intensity_batch(x, y, u, &mut batch);
        let single = places.map(|places| places.map(to_f32));
        let mut rounded = [f32::NAN; LANES + 3];
        let [x, y, u] = &single;
        stack.intensity_batch_f32(x, y, u, &mut rounded);
        for (i, (found, rounded)) in batch.into_iter().zip(rounded).enumerate() {
            let expected = if i == 7 { 1.0 } else { there };
            assert_eq!(found.to_bits(), expected.to_bits(), "{case}, {i}");
            assert_eq!(rounded.to_bits(), to_f32(expected).to_bits(), "{case}, {i}");
        }
    }
}

#[test]
#[should_panic(expected = "a box of the size")]
fn boxes_of_negative_size_are_refused() {
    let stack = stack(&PupilField::new(16, 8, 0).unwrap(), SlicePath::Still);
    stack.average_over([0.0; 2], [-1.0, 1.0], 0.0);
}

#[test]
#[should_panic(expected = "coordinates of lengths")]
fn batches_of_unlike_lengths_are_refused() {
    let stack = stack(&PupilField::new(16, 8, 0).unwrap(), SlicePath::Still);
    stack.intensity_batch(&[0.0], &[0.0, 1.0], &[0.0], &mut [0.0]);
}

/// The look-up between two slices of an external field against fields from single transforms, and
/// their mean square over the whole tile.
#[test]
fn slices_of_unlike_light_are_blended_in_one_frame() {
    let stack = stack(&measured([128, 144], 16.0), circle(2));
    let size = stack.size();
    let (index, f) = (1, 0.375_f64);
    let [a, b] = [index, index + 1].map(|i| stack.field().speckle(stack.offset(i), 0.0));
    let step = stack.slices[index].join.step;
    let blend = |x: usize, y: usize| {
        let turns = step[0] * x as f64 / size[0] as f64 + step[1] * y as f64 / size[1] as f64;
        let [a, b] = [&a, &b].map(|field| {
            let z = field.values()[(x, y)];
            Complex::new(f64::from(z.re), f64::from(z.im))
        });
        (a * (1.0 - f) + b * Complex::cis(-2.0 * PI * turns) * f).norm_sqr()
    };
    let cells = || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let mean_square = cells().map(|(x, y)| blend(x, y)).sum::<f64>() / (size[0] * size[1]) as f64;
    for (x, y) in cells().step_by(7) {
        let expected = blend(x, y) / mean_square;
        let got = stack.intensity_at(x as f64, y as f64, index as f64 + f);
        // The error of the spline falls with the fourth power of the speckle size: 2e-4 at 4, 8e-7
        // here. And the rounding of f32 in some ten operations.
        let error = (got - expected).abs() / (1.0 + expected);
        assert!(error < 1e-5, "({x}, {y}): {got} | {expected}");
    }
}

#[test]
fn fringes_between_slices_are_those_of_both_pupils_together() {
    let field = PupilField::new(64, 16, 1).unwrap();
    // Four slices, three diameters: the pupil moves by 12 samples of its lattice from one to the
    // next.
    let path = SlicePath::Straight {
        half_period: 2,
        length: 3,
    };
    let stack = stack(&field, path);
    for (between, expected) in [(false, [4.0, 4.0]), (true, [64.0 / (16.0 + 12.0), 4.0])] {
        let layer = stack.layer(0, between);
        for (axis, expected) in expected.into_iter().enumerate() {
            let finest: f64 = layer.finest(axis, 64.0, 4.0);
            assert_absolute(finest, expected, 1e-12);
        }
    }
}

#[test]
fn fields_of_two_stacks_add_to_speckle_of_the_same_law() {
    let field = |seed| PupilField::new(128, 64, seed).unwrap();
    let stacks = [1, 2].map(|seed| stack(&field(seed), PATHS[2]));
    let (mut mean, mut square) = (0.0, 0.0);
    let count = 40_000;
    for i in 0..count {
        let (x, y) = (f64::from(i) * 0.377, f64::from(i) * 1.913);
        let u = f64::from(i % 7) * 0.25;
        let amplitudes = [0, 1].map(|part: usize| stacks[part].amplitude_at(x, y, u));
        let alone = stacks[0].intensity_at(x, y, u);
        assert_absolute(amplitudes[0].norm_sqr(), alone, 1e-6 * (1.0 + alone));
        let sum = 0.6 * amplitudes[0] + Complex::new(0.0, 0.8) * amplitudes[1];
        mean += sum.norm_sqr() / f64::from(count);
        square += sum.norm_sqr().powi(2) / f64::from(count);
    }
    assert!((mean - 1.0).abs() < 0.02, "{mean}");
    assert!((square / (mean * mean) - 2.0).abs() < 0.08, "{square}");
}
