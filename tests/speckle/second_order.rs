//! The joint law of two intensities.

use proptest::prelude::*;
use tem00::{
    numerics::Grid,
    speckle::PupilField,
    statistics::{chi_squared, laws::JointIntensity, t_test_mean},
};

use super::lattice::{Case, Lattice, cases, signed};

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
    let student = |bright: bool, excess: &dyn Fn(&[f64; 2]) -> f64| {
        let excess: Vec<_> = given(bright).map(excess).collect();
        t_test_mean(&excess, 0.0).expect("pairs").p_value
    };
    let mean = |&[a, b]: &[f64; 2]| b - law.conditional_mean(a);
    let variance = |pair: &[f64; 2]| mean(pair).powi(2) - law.conditional_variance(pair[0]);
    [
        density.p_value,
        student(false, &mean),
        student(true, &mean),
        student(false, &variance),
        student(true, &variance),
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

/// Holds pairs of intensities of ten tiles against the joint law of their correlation.
fn check_pairs(
    case: &Case,
    correlation: f64,
    pairs: impl Fn(&PupilField) -> Vec<[f64; 2]>,
) -> Result<(), TestCaseError> {
    prop_assume!(correlation > 0.1 && correlation < 0.97);
    let field = case.field();
    let tiles = (0..TILES).map(|tile| field.clone().with_seed(case.seed.wrapping_add(tile)));
    let pairs: Vec<_> = tiles.flat_map(|tile| pairs(&tile)).collect();
    let law = JointIntensity::new(correlation).expect("a correlation below 1");
    // 80 p-values: α = 8e−6, some ten times that for the skewness of squares.
    for (p, of) in p_values(&pairs, &law).into_iter().zip(TESTED) {
        prop_assert!(
            p > 1e-7,
            "{of}: p = {p:e} of {} pairs, μ = {correlation}",
            pairs.len()
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn two_points_of_a_pattern_have_the_joint_law(
        case in cases(200..300, 3.0), lag in [0_i64..4, -3_i64..4],
    ) {
        let lattice = Lattice::of(&case.field(), case.offset);
        let stride = lattice.stride(lag);
        check_pairs(&case, lattice.correlation(lag).norm(), |tile| {
            let pattern = tile.pattern_at(case.offset, case.defocus);
            pairs_of(pattern.values(), pattern.values(), stride, lag)
        })?;
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
        let offset = [0, 1].map(|axis| points[axis] / diameter[axis]);
        let stride = lattice.stride([0, 0]);
        check_pairs(&case, correlation, |tile| {
            let (here, there) = (tile.pattern(), tile.pattern_at(offset, 0.0));
            pairs_of(here.values(), there.values(), stride, [0, 0])
        })?;
    }
}
