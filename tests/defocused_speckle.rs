//! The correlation of generated patterns against the overlap integrals of a displaced and defocused
//! pupil.
//!
//! The tests are statistical but not flaky: all seeds are fixed. At other seeds a correct library
//! fails with a probability below 1e-4.

use tem00::{
    decorrelation::{CorrelationLaw, axial_correlation},
    numerics::Grid,
    speckle::PupilField,
    statistics::pearson_correlation,
};

const SIZE: usize = 384;
const SPECKLE_SIZE: usize = 2;
const SEEDS: u64 = 16;

/// Displacements in pupil diameters and defocus in axial decorrelation lengths, such that the peak
/// lies at a whole number of pixels: 4 s x speckles of 2 pixels.
const CASES: [(f64, f64, usize); 4] = [
    (0.2, 0.625, 1),
    (0.125, 1.0, 1),
    (0.25, 1.0, 2),
    (0.1, 1.25, 1),
];

/// The grid with each row turned to the left by `shift` pixels.
fn turned(pattern: &Grid<f32>, shift: usize) -> Grid<f32> {
    Grid::from_fn(SIZE, SIZE, |x, y| pattern[((x + shift) % SIZE, y)])
}

/// The mean correlation of patterns before and after, with the latter turned by `shift`, and its
/// standard error by the scatter of the seeds.
fn measured(offset: f64, defocus: f64, shift: usize) -> [f64; 2] {
    let gamma = |seed| {
        let field = PupilField::new(SIZE, SIZE / SPECKLE_SIZE, seed).expect("a valid size");
        let moved = field.pattern_at([offset, 0.0], defocus);
        let moved = turned(moved.values(), shift);
        pearson_correlation(field.pattern().values(), &moved).expect("patterns of equal size")
    };
    let gammas: Vec<_> = (0..SEEDS).map(gamma).collect();
    let mean = gammas.iter().sum::<f64>() / SEEDS as f64;
    let squares: f64 = gammas.iter().map(|gamma| (gamma - mean).powi(2)).sum();
    [mean, (squares / (SEEDS * (SEEDS - 1)) as f64).sqrt()]
}

/// The two-sided 1e-5 point of Student's t with fifteen degrees of freedom.
const T_LIMIT: f64 = 6.5;

#[track_caller]
fn assert_law(offset: f64, defocus: f64, shift: usize, expected: f64) {
    let [gamma, error] = measured(offset, defocus, shift);
    // Unit phasors lower a covariance by up to 1/N without a displacement.
    let phasors = if offset == 0.0 { 1.0 / 28_000.0 } else { 0.0 };
    assert!(
        (gamma - expected).abs() < T_LIMIT * error + phasors,
        "s = {offset}, x = {defocus}: {gamma} ± {error} instead of {expected}"
    );
    assert!(error < 0.002, "the test would see nothing: ±{error}");
}

#[test]
fn patterns_correlate_by_the_integral_at_the_image_displacement_and_at_the_peak() {
    for (offset, defocus, shift) in CASES {
        let [at_image, at_peak] = [CorrelationLaw::AtImageDisplacement, CorrelationLaw::AtPeak]
            .map(|law| law.correlation(offset, defocus));
        assert_law(offset, defocus, 0, at_image);
        assert_law(offset, defocus, SIZE - shift, at_peak);
    }
}

#[test]
fn patterns_out_of_focus_follow_the_law_of_motion_along_the_axis() {
    for defocus in [0.25, 0.5, 1.0, 1.43] {
        assert_law(0.0, defocus, 0, axial_correlation(defocus));
    }
}
