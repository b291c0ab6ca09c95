//! The joint law of two intensities, and what follows of slopes, level crossings and areas.

use core::f64::consts::PI;

use proptest::prelude::*;
use tem00::{
    numerics::Grid,
    speckle::{Phasors, PupilField},
    statistics::{
        Moments, chi_squared,
        laws::{JointIntensity, MEAN_SQUARE_SLOPE, area_fraction_above, level_crossings},
        t_test_mean,
    },
};

use super::lattice::{Lattice, Shape, cases, signed};

/// The bins along each axis, equally probable under the exponential law.
const BINS: usize = 8;

fn bin(intensity: f64) -> usize {
    let edges = (1..BINS).map(edge);
    edges.filter(|&edge| intensity > edge).count()
}

fn edge(index: usize) -> f64 {
    -(1.0 - index as f64 / BINS as f64).ln()
}

/// The probability of every pair of bins, by the midpoint rule over the quantiles of one intensity.
fn probabilities(law: &JointIntensity) -> Vec<f64> {
    const POINTS: usize = 48;
    let mut shares = vec![0.0; BINS * BINS];
    for point in 0..BINS * POINTS {
        let quantile = (point as f64 + 0.5) / (BINS * POINTS) as f64;
        let given = -(1.0 - quantile).ln();
        let mut below = 0.0;
        for second in 0..BINS {
            let to_here = if second + 1 == BINS {
                1.0
            } else {
                law.conditional_cumulative(edge(second + 1), given)
            };
            let share = (to_here - below) / (BINS * POINTS) as f64;
            shares[point / POINTS * BINS + second] += share;
            below = to_here;
        }
    }
    shares
}

/// What [`p_values`] are of.
const TESTED: [&str; 5] = [
    "density",
    "mean next to dark",
    "mean next to bright",
    "variance next to dark",
    "variance next to bright",
];

/// Says how far the pairs are from the joint law: p-values of its density, of the mean of one
/// intensity given the other, and of its variance; the last two for dark and for bright ones.
fn p_values(pairs: &[[f64; 2]], law: &JointIntensity) -> [f64; 5] {
    let mut observed = vec![0; BINS * BINS];
    for &[a, b] in pairs {
        observed[bin(a) * BINS + bin(b)] += 1;
    }
    let expected: Vec<_> = probabilities(law)
        .iter()
        .map(|share| share * pairs.len() as f64)
        .collect();
    let density = chi_squared(&observed, &expected, 1).expect("full bins");
    let given = |bright: bool| pairs.iter().filter(move |pair| (pair[0] > 0.7) == bright);
    let means = [false, true].map(|bright| {
        let excess: Vec<_> = given(bright)
            .map(|&[a, b]| b - law.conditional_mean(a))
            .collect();
        t_test_mean(&excess, 0.0).expect("pairs").p_value
    });
    let variances = [false, true].map(|bright| {
        let excess: Vec<_> = given(bright)
            .map(|&[a, b]| (b - law.conditional_mean(a)).powi(2) - law.conditional_variance(a))
            .collect();
        t_test_mean(&excess, 0.0).expect("pairs").p_value
    });
    [
        density.p_value,
        means[0],
        means[1],
        variances[0],
        variances[1],
    ]
}

/// Pairs of two grids at the stride, the second `lag` away.
fn pairs_of(
    first: &Grid<f32>,
    second: &Grid<f32>,
    stride: usize,
    [x, y]: [i64; 2],
) -> Vec<[f64; 2]> {
    let mut pairs = Vec::new();
    for row in 0..first.height() / stride {
        for column in 0..first.width() / stride {
            let at = [column * stride, row * stride];
            let there = second.wrapped(signed(at[0]) + x, signed(at[1]) + y);
            pairs.push([first[(at[0], at[1])].into(), (*there).into()]);
        }
    }
    pairs
}

const TILES: u64 = 10;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn two_points_of_a_pattern_have_the_joint_law(
        case in cases(200..300, 3.0), lag in [0_i64..4, -3_i64..4],
    ) {
        let field = case.field();
        let lattice = Lattice::of(&field, case.offset);
        let correlation = lattice.correlation(lag).norm();
        prop_assume!(correlation > 0.1 && correlation < 0.97);
        let stride = lattice.stride(lag);
        let mut pairs = Vec::new();
        for tile in 0..TILES {
            let field = field.clone().with_seed(case.seed.wrapping_add(tile));
            let pattern = field.pattern_at(case.offset, case.defocus);
            pairs.extend(pairs_of(pattern.values(), pattern.values(), stride, lag));
        }
        let law = JointIntensity::new(correlation).expect("a correlation below 1");
        // 80 p-values: α = 8e−6, some ten times that for the skewness of squares.
        for (p, of) in p_values(&pairs, &law).into_iter().zip(TESTED) {
            prop_assert!(p > 1e-7, "{of}: p = {p:e} of {} pairs, μ = {correlation}", pairs.len());
        }
    }

    #[test]
    fn two_patterns_of_overlapping_pupils_have_the_joint_law(
        case in cases(200..300, 3.0), step in [-0.5_f64..0.5, -0.5_f64..0.5],
    ) {
        let field = case.field();
        let diameter = field.diameter();
        let lattice = Lattice::of(&field, [0.0; 2]);
        let points = [0, 1].map(|axis| (step[axis] * diameter[axis]).round());
        #[expect(clippy::cast_possible_truncation, reason = "a few lattice points")]
        let correlation = lattice.overlap(points.map(|point| point as i64)).norm();
        prop_assume!(correlation > 0.1 && correlation < 0.97);
        let offset = [0, 1].map(|axis| points[axis] / diameter[axis]);
        let stride = lattice.stride([0, 0]);
        let mut pairs = Vec::new();
        for tile in 0..TILES {
            let field = field.clone().with_seed(case.seed.wrapping_add(tile));
            let (here, there) = (field.pattern(), field.pattern_at(offset, 0.0));
            pairs.extend(pairs_of(here.values(), there.values(), stride, [0, 0]));
        }
        let law = JointIntensity::new(correlation).expect("a correlation below 1");
        // As above.
        for (p, of) in p_values(&pairs, &law).into_iter().zip(TESTED) {
            prop_assert!(p > 1e-7, "{of}: p = {p:e} of {} pairs, μ = {correlation}", pairs.len());
        }
    }
}

/// A field of fine samples: differences are slopes, and levels are not crossed twice between two.
fn fine_field(shape: Shape, speckle_size: f64) -> PupilField {
    PupilField::from_speckle_size([408, 384], speckle_size, 0)
        .and_then(|field| field.with_pupil(shape.pupil()))
        .expect("a valid field")
}

const SHAPES: [Shape; 4] = [
    Shape::Circle,
    Shape::Annulus(0.5),
    Shape::Rectangle(0.6),
    Shape::Gaussian(0.4),
];

/// What a tile measures, against what is expected of it: the mean over tiles by Student's test, which
/// is right at 1e−6, and the standard error below `resolution` of the expectation. `bias` is what the
/// sampling may leave, relative.
fn check(of: &str, measured: &[f64], expected: f64, [resolution, bias]: [f64; 2]) {
    let moments = Moments::from_samples(measured).expect("tiles");
    let error = moments.standard_error() / expected;
    assert!(
        error < resolution,
        "{of}: nothing is seen with an error of {error}"
    );
    let nearest = moments
        .mean()
        .clamp(expected * (1.0 - bias), expected * (1.0 + bias));
    let test = t_test_mean(measured, nearest).expect("tiles");
    assert!(
        test.p_value > 1e-6,
        "{of}: {} | {expected}, {test:?}",
        moments.mean()
    );
}

/// Twenty tiles, other ones for every shape.
fn tiles(field: &PupilField, shape: usize) -> Vec<Grid<f32>> {
    (0..20_u64)
        .map(|tile| field.clone().with_seed(1_000 * shape as u64 + tile))
        .map(|field| field.pattern().into_values())
        .collect()
}

/// The mean over a tile of `f` of the intensity at a sample and `ahead` samples after it along x or y.
fn mean_of_pairs(tile: &Grid<f32>, axis: usize, ahead: usize, f: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    let (width, height) = (tile.width(), tile.height());
    let [across, down] = [[ahead, 0], [0, ahead]][axis];
    for y in 0..height {
        let (row, other) = (tile.row(y), tile.row((y + down) % height));
        for x in 0..width {
            sum += f(row[x].into(), other[(x + across) % width].into());
        }
    }
    sum / (width * height) as f64
}

/// The mean square slope along an axis, from the squared differences over three small r: divided by r²,
/// they deviate from it by terms in r² and r⁴, which cancel, and r⁶.
fn mean_square_slope(tile: &Grid<f32>, axis: usize) -> f64 {
    let over_square = |ahead: u32| {
        let square = |a: f64, b: f64| (b - a).powi(2);
        mean_of_pairs(tile, axis, ahead as usize, square) / f64::from(ahead).powi(2)
    };
    1.5 * over_square(1) - 0.6 * over_square(2) + 0.1 * over_square(3)
}

#[test]
fn mean_square_slopes_are_twice_the_variance_of_the_wave_numbers() {
    for (index, shape) in SHAPES.into_iter().enumerate() {
        let field = fine_field(shape, 12.0);
        let tiles = tiles(&field, index);
        let [xx, _, yy] = Lattice::of(&field, [0.0; 2]).wave_numbers();
        for (axis, variance) in [(0, xx), (1, yy)] {
            let slopes = tiles.iter().map(|tile| mean_square_slope(tile, axis));
            // The finest fringes turn by 0.52 per sample: 0.52⁶/560 of their slope is missed.
            check(
                "slope",
                &slopes.collect::<Vec<_>>(),
                2.0 * variance,
                [0.015, 4e-5],
            );
        }
        if let Shape::Circle = shape {
            let airy = MEAN_SQUARE_SLOPE / 12.0_f64.powi(2);
            // The lattice disc of C = 32 has a second moment 1 % off.
            assert!(
                (2.0 * xx / airy - 1.0).abs() < 0.015,
                "{} | {airy}",
                2.0 * xx
            );
        }
    }
}

#[test]
fn level_crossings_and_bright_areas_are_those_of_the_pupil() {
    const LEVELS: [f64; 3] = [0.5, 1.0, 2.0];
    for (index, shape) in SHAPES.into_iter().enumerate() {
        // The ensemble of Gaussian phasors is exact however few they are.
        let field = fine_field(shape, 24.0).with_phasors(Phasors::Gaussian);
        let tiles = tiles(&field, index);
        let [xx, _, yy] = Lattice::of(&field, [0.0; 2]).wave_numbers();
        for level in LEVELS {
            for (axis, variance) in [(0, xx), (1, yy)] {
                let rise = |a: f64, b: f64| f64::from(u8::from(a < level && b >= level));
                let rises = tiles.iter().map(|tile| mean_of_pairs(tile, axis, 1, rise));
                // σ_k √(x/π) exp(−x); what rises and falls again within h/24 is missed.
                let expected = (variance * level / PI).sqrt() * (-level).exp();
                check("rises", &rises.collect::<Vec<_>>(), expected, [0.06, 0.002]);
                if let Shape::Circle = shape {
                    let airy = level_crossings(level) / 24.0;
                    // The lattice disc of C = 16 has the root of a second moment 2 % off.
                    assert!((expected / airy - 1.0).abs() < 0.02, "{expected} | {airy}");
                }
            }
            let bright = |a: f64, _| f64::from(u8::from(a > level));
            let shares = tiles.iter().map(|tile| mean_of_pairs(tile, 0, 0, bright));
            let expected = area_fraction_above(level);
            check("area", &shares.collect::<Vec<_>>(), expected, [0.06, 0.0]);
        }
    }
}
