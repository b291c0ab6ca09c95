//! Slices of stacks: their fields, their correlation, and the look-up between them.

use core::f64::consts::TAU;

use proptest::prelude::*;
use tem00::{
    numerics::Grid,
    speckle::{Complex, Phasors, PupilField, SlicePath, SpeckleField, SpeckleStack},
    statistics::{exponential_cumulative, kolmogorov_smirnov, pearson_correlation},
};

use super::lattice::{Case, Lattice, Shape, cases, covariance_spread, signed};

fn paths() -> impl Strategy<Value = SlicePath> {
    prop_oneof![
        (1_usize..6).prop_map(|half_period| SlicePath::Circle { half_period }),
        (1_usize..6, 2_usize..5).prop_map(|(half_period, length)| SlicePath::Straight {
            half_period,
            length
        }),
    ]
}

fn stack(field: &PupilField, path: SlicePath) -> SpeckleStack {
    SpeckleStack::generate(field, path).expect("a small stack")
}

/// The field that a slice shows, at its samples.
fn on_demand(stack: &SpeckleStack, index: usize) -> SpeckleField {
    stack.field().speckle(stack.offset(index), 0.0)
}

/// The centre of a slice's pupil, in lattice points.
#[expect(clippy::cast_possible_truncation, reason = "a few lattice points")]
fn centre(stack: &SpeckleStack, index: usize) -> [i64; 2] {
    let (offset, diameter) = (stack.offset(index), stack.field().diameter());
    [0, 1].map(|axis| (offset[axis] * diameter[axis]).round() as i64)
}

/// The points after which the lattice of a path closes along x, or so many that it never does.
#[expect(clippy::cast_possible_truncation, reason = "a few lattice points")]
fn period(stack: &SpeckleStack) -> i64 {
    match stack.path() {
        SlicePath::Straight { length, .. } => {
            (length as f64 * stack.field().diameter()[0]).round() as i64
        }
        SlicePath::Circle { .. } | SlicePath::Still => 1 << 32,
    }
}

fn shift(stack: &SpeckleStack, from: usize, to: usize) -> [i64; 2] {
    let (a, b, period) = (centre(stack, from), centre(stack, to), period(stack));
    let x = (b[0] - a[0]).rem_euclid(period);
    [if 2 * x < period { x } else { x - period }, b[1] - a[1]]
}

/// What two slices share by counting; on a lattice that has closed, from both sides: as one wave
/// where it closes with the pattern, else as waves that the tile averages apart.
fn counted_overlaps(
    lattice: &Lattice,
    [x, y]: [i64; 2],
    [period, width]: [i64; 2],
) -> [Complex<f64>; 3] {
    let sides = [x, x - period, x + period].map(|x| lattice.overlap([x, y]));
    if period % width == 0 {
        [sides.iter().sum(), Complex::ZERO, Complex::ZERO]
    } else {
        sides
    }
}

/// The mean over the tile of one amplitude times the conjugate of the other, in the frame of the
/// lattice. For unit phasors it holds no noise.
fn correlation_in_the_lattice(stack: &SpeckleStack, i: usize, j: usize) -> Complex<f64> {
    let step = shift(stack, i, j);
    let size = stack.size();
    let (a, b) = (on_demand(stack, i), on_demand(stack, j));
    let mut sum = Complex::new(0.0, 0.0);
    for (y, (row, other)) in a.values().rows().zip(b.values().rows()).enumerate() {
        for (x, (here, there)) in row.iter().zip(other).enumerate() {
            let turns = (step[0] * signed(x)) as f64 / size[0] as f64
                + (step[1] * signed(y)) as f64 / size[1] as f64;
            let product = here * there.conj();
            sum += Complex::new(f64::from(product.re), f64::from(product.im))
                * Complex::cis(TAU * turns);
        }
    }
    sum / (size[0] * size[1]) as f64
}

/// Whether no point of one pupil lies a period of the pattern away from where a point of the other
/// does: the two would have the same wave on the tile, and their product would add to the mean.
fn is_alone(stack: &SpeckleStack, step: [i64; 2]) -> bool {
    let (size, diameter) = (stack.size(), stack.field().diameter());
    let reach = |axis: usize| step[axis].unsigned_abs() as f64 + diameter[axis];
    [0, 1].iter().all(|&axis| reach(axis) < size[axis] as f64)
}

fn intensity(stack: &SpeckleStack, index: usize) -> Grid<f32> {
    on_demand(stack, index).values().map(Complex::norm_sqr)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_lattice_that_closes_shows_what_the_endless_one_has_about_the_origin(
        case in cases(20..90, 5.0), path in paths(),
    ) {
        let field = case.field();
        let stack = stack(&field, path);
        let reach = period(&stack) as f64 / stack.field().diameter()[0] / 2.0 - 0.51;
        for index in 0..stack.slice_count() {
            let offset = stack.offset(index);
            if offset[0] < reach {
                prop_assert_eq!(field.speckle(offset, 0.0), on_demand(&stack, index));
            }
        }
    }

    #[test]
    fn splines_pass_through_the_field_on_demand(case in cases(20..90, 9.0), path in paths()) {
        let stack = stack(&case.field(), path);
        for (index, u) in (0..stack.slice_count()).zip(0_u32..) {
            let pattern = stack.field().pattern_at(stack.offset(index), 0.0);
            let mut square = 0.0;
            for (y, row) in pattern.values().rows().enumerate() {
                for (x, &expected) in row.iter().enumerate() {
                    let got = stack.intensity_at(x as f64, y as f64, u.into());
                    square += (got - f64::from(expected)).powi(2);
                }
            }
            let rms = (square / pattern.values().values().len() as f64).sqrt();
            // The stated 4.3e−3 of the field at a speckle size of 2, twice that behind a square,
            // falls with its fourth power; |U|² doubles it.
            let cornered = matches!(case.shape, Shape::Rectangle(_) | Shape::Aberrated(_));
            let corners = if cornered { 2.0 } else { 1.0 };
            let stated = corners * 2.0 * 4.3e-3 * (2.0 / stack.speckle_size()).powi(4) + 1e-6;
            prop_assert!(rms < stated, "slice {index}: {rms:e}, stated {stated:e}");
        }
    }

    #[test]
    fn slices_correlate_as_their_pupils_overlap(
        case in cases(40..90, 3.0), path in paths(), first in 0_usize..12,
    ) {
        let case = Case { phasors: Phasors::Unit, ..case };
        let stack = stack(&case.field(), path);
        let lattice = Lattice::of(stack.field(), [0.0; 2]);
        let (count, correlations) = (lattice.phasors(), lattice.correlations());
        let first = first % stack.slice_count();
        for second in 0..stack.slice_count() {
            let step = shift(&stack, first, second);
            let closes = [period(&stack), signed(stack.size()[0])];
            let overlaps = counted_overlaps(&lattice, step, closes);
            if is_alone(&stack, step) {
                let measured = correlation_in_the_lattice(&stack, first, second);
                // By Parseval, but for the rounding of f32.
                prop_assert!((measured - overlaps[0]).norm() < 2e-6, "{measured} | {overlaps:?}");
            }
            let gamma = stack.correlation_between(first as f64, second as f64);
            let shared: f64 = overlaps.iter().map(Complex::norm_sqr).sum();
            prop_assert!((gamma - shared).abs() < 1e-6, "γ = {gamma} | {overlaps:?}");
            if first == second {
                continue;
            }
            let (a, b) = (intensity(&stack, first), intensity(&stack, second));
            let pearson = pearson_correlation(&a, &b).expect("bright patterns");
            // The spread of a covariance is at most that of a squared contrast, by Schwarz; over
            // that contrast, which spreads as much. Fixed means make a difference of 1/N. 200 pairs
            // at 5 standard deviations: α = 1e−4.
            let spread = covariance_spread(&correlations, [0, 0], None) * (1.0 + gamma);
            prop_assert!(
                (pearson - gamma).abs() < 5.0 * spread + 1.0 / count,
                "γ({first}, {second}) = {gamma}: {pearson}, spread {spread}"
            );
        }
    }

    #[test]
    fn slices_stand_on_their_path_within_half_a_lattice_point(
        case in cases(20..90, 5.0), path in paths(),
    ) {
        let stack = stack(&case.field(), path);
        let diameter = stack.field().diameter();
        for index in 0..stack.slice_count() {
            let offset = stack.offset(index);
            let turns = index as f64 / stack.slice_count() as f64;
            let place = match path {
                SlicePath::Straight { .. } => [turns * period(&stack) as f64 / diameter[0], 0.0],
                _ => [0.5 * (TAU * turns).cos(), 0.5 * (TAU * turns).sin()],
            };
            for axis in [0, 1] {
                let points = (offset[axis] - place[axis]) * diameter[axis];
                prop_assert!(points.abs() < 0.5 + 1e-9, "slice {index}: {points} points beside");
            }
            if let SlicePath::Straight { .. } = path {
                prop_assert!(offset[1].abs() <= 0.0, "slice {index}: {offset:?}");
            }
        }
    }

    #[test]
    fn look_ups_are_exponential_at_any_fraction(
        case in cases(70..110, 3.0), path in paths(),
        fractions in [0.0_f64..1.0, 0.0_f64..1.0], u in 0.0_f64..12.0,
    ) {
        const TILES: u64 = 4;
        let field = case.field();
        let stride = Lattice::of(&field, [0.0; 2]).stride([0, 0]);
        let mut samples = Vec::new();
        for tile in 0..TILES {
            let stack = stack(&field.clone().with_seed(case.seed ^ tile), path);
            let [columns, rows] = stack.size().map(|side| side / stride);
            for y in 0..rows {
                for x in 0..columns {
                    let at = |i: usize, f: f64| (i * stride) as f64 + f;
                    samples.push(stack.intensity_at(at(x, fractions[0]), at(y, fractions[1]), u));
                }
            }
        }
        let test = kolmogorov_smirnov(&samples, exponential_cumulative).expect("samples");
        // 24 cases: a correct look-up fails one of them with a probability of 2e−5. N phasors are
        // off by 0.12/N of the 1.4/√n that the test sees.
        prop_assert!(test.p_value > 1e-6, "p = {:e} of {}", test.p_value, samples.len());
    }
}
