//! Stacks decorrelate by their closed-form law, and looked-up intensities are as exponential
//! between the samples as on them.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use tem00::{
    decorrelation::{
        CameraFrame, DVec3, FieldLight, FieldPoints, FieldSetup, FieldSlices, ImageOrientation,
        ImagingGeometry, LensData, MotionField,
    },
    numerics::{Grid, cast::to_f32},
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::{exponential_cumulative, kolmogorov_smirnov, pearson_correlation},
};

const SIZE: usize = 256;
const DIAMETER: usize = 128;
const HALF_PERIOD: usize = 4;

fn stack(seed: u64, path: SlicePath) -> SpeckleStack {
    let field = PupilField::new(SIZE, DIAMETER, seed).expect("a valid field");
    SpeckleStack::generate(&field, path).expect("a small stack")
}

fn slice(stack: &SpeckleStack, u: f64) -> Grid<f32> {
    Grid::from_fn(SIZE, SIZE, |x, y| {
        to_f32(stack.intensity_at(x as f64, y as f64, u))
    })
}

/// The standard error of the correlation of two independent patterns: the variance is 0.585 h²/A, with
/// A = Q² and h = Q/C.
fn standard_error() -> f64 {
    0.585_f64.sqrt() / DIAMETER as f64
}

#[test]
fn slices_decorrelate_by_the_closed_form() {
    const PATTERNS: u64 = 4;
    for path in [
        SlicePath::Circle {
            half_period: HALF_PERIOD,
        },
        SlicePath::Straight {
            half_period: HALF_PERIOD,
            length: 2,
        },
    ] {
        for distance in 1..=HALF_PERIOD {
            let mut sum = 0.0;
            for seed in 0..PATTERNS {
                let stack = stack(seed, path);
                let first = seed as f64;
                let a = slice(&stack, first);
                let b = slice(&stack, first + distance as f64);
                sum += pearson_correlation(&a, &b).expect("bright patterns");
            }
            let measured = sum / PATTERNS as f64;
            // Correlated patterns spread up to 1.5 times as much; centres are rounded to the lattice,
            // which moves the law by 1/C.
            let tolerance =
                4.0 * 1.5 * standard_error() / (PATTERNS as f64).sqrt() + 1.0 / DIAMETER as f64;
            let expected = stack(0, path).correlation_at(distance as f64);
            assert!(
                (measured - expected).abs() < tolerance,
                "{path:?}, {distance} slices apart: {measured} | {expected}"
            );
        }
    }
}

/// The correlations that a field states after motions of one point across the line of sight.
fn correlations_of_motions<const N: usize>(motions: [f64; N]) -> [f64; N] {
    let pupil_centre = DVec3::new(0.0, 0.0, 0.3);
    let field = MotionField::new(FieldSetup {
        geometry: ImagingGeometry::from_lens(LensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            surface_to_pupil: 0.3,
            pixel_pitch: 3.45e-6,
        })
        .expect("a valid lens"),
        camera: CameraFrame::look_at(pupil_centre, DVec3::ZERO, DVec3::Y).expect("a valid view"),
        pupil_centre,
        orientation: ImageOrientation::ScreenUpright,
        pattern_speckle_size: (SIZE / DIAMETER) as f64,
    })
    .expect("a valid field");
    let (zero, one) = ([0.0; N], [1.0; N]);
    let mut results = [[0.0; N]; 7];
    let [a, b, c, d, correlation, e, f] = &mut results;
    field.evaluate(
        &FieldPoints {
            position: [&zero; 3],
            normal: [&zero, &zero, &one],
            motion: [&motions, &zero, &zero],
            pixel: [&zero; 2],
            light: FieldLight::Collimated,
        },
        FieldSlices {
            speckle_displacement: [a, b],
            pupil_displacement: [c, d],
            correlation,
            pattern_coordinate: [e, f],
        },
    );
    results[4]
}

#[test]
fn a_stack_shows_the_correlations_that_a_field_states() {
    const PATTERNS: u64 = 4;
    // Up to two thirds of a pupil of 3.125 mm.
    let stated = correlations_of_motions([0.2e-3, 0.5e-3, 0.9e-3, 2.1e-3]);
    assert!(
        stated.is_sorted_by(|a, b| a > b) && stated[3] > 0.02,
        "{stated:?}"
    );
    for path in [
        SlicePath::Straight {
            half_period: HALF_PERIOD,
            length: 2,
        },
        SlicePath::Circle {
            half_period: HALF_PERIOD,
        },
    ] {
        let stacks: Vec<_> = (0..PATTERNS).map(|seed| stack(seed, path)).collect();
        for gamma in stated {
            let seen = stacks.iter().map(|stack| {
                let there = slice(stack, stack.coordinate_of(gamma));
                pearson_correlation(&slice(stack, 0.0), &there).expect("bright patterns")
            });
            let seen = seen.sum::<f64>() / PATTERNS as f64;
            // As above.
            let tolerance =
                4.0 * 1.5 * standard_error() / (PATTERNS as f64).sqrt() + 1.0 / DIAMETER as f64;
            assert!(
                (seen - gamma).abs() < tolerance,
                "{path:?}: {seen} seen, {gamma} stated"
            );
        }
    }
}

#[test]
fn opposite_slices_are_uncorrelated() {
    for path in [
        SlicePath::Circle {
            half_period: HALF_PERIOD,
        },
        SlicePath::Straight {
            half_period: HALF_PERIOD,
            length: 2,
        },
    ] {
        let stack = stack(7, path);
        for index in 0..HALF_PERIOD {
            let a = slice(&stack, index as f64);
            let b = slice(&stack, (index + HALF_PERIOD) as f64);
            let correlation = pearson_correlation(&a, &b).expect("bright patterns");
            assert!(
                correlation.abs() < 4.0 * standard_error(),
                "slice {index}: {correlation}"
            );
            let law = stack.correlation_between(index as f64, (index + HALF_PERIOD) as f64);
            // The rounding of the centres to the lattice leaves a sliver of a lens at most.
            assert!(law < 1e-3, "slice {index}: {law}");
        }
    }
}

#[test]
fn looked_up_intensity_is_exponential_at_any_fraction() {
    let path = SlicePath::Circle {
        half_period: HALF_PERIOD,
    };
    let fractions = [
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.25, 0.75, 0.5],
        [0.5, 0.5, 0.5],
        [0.1, 0.9, 0.3],
    ];
    for fraction in fractions {
        // One look-up every four samples, two speckles apart, in several stacks.
        let mut samples = Vec::new();
        for seed in 0..6 {
            let stack = stack(seed, path);
            for y in (0..SIZE).step_by(4) {
                for x in (0..SIZE).step_by(4) {
                    let at = |cell: usize, k: usize| cell as f64 + fraction[k];
                    samples.push(stack.intensity_at(at(x, 0), at(y, 1), at(1, 2)));
                }
            }
        }
        let test = kolmogorov_smirnov(&samples, exponential_cumulative).expect("enough samples");
        assert!(
            test.p_value > 1e-3,
            "at {fraction:?}: p = {:e}",
            test.p_value
        );
    }
}

#[test]
fn scattered_look_ups_have_mean_and_contrast_one() {
    const LOOK_UPS: u32 = 40_000;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let stack = stack(1, SlicePath::Circle { half_period: 8 });
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..LOOK_UPS {
        let [x, y, u]: [f64; 3] = random.random();
        let intensity = stack.intensity_at(1e4 * x, 1e4 * y, 1e3 * u);
        sum += intensity;
        squares += intensity * intensity;
    }
    let mean = sum / f64::from(LOOK_UPS);
    let second = squares / f64::from(LOOK_UPS);
    // Exponential: var I = 1, var I² = 24 − 4 = 20; four standard errors.
    let scale = 4.0 / f64::from(LOOK_UPS).sqrt();
    assert!((mean - 1.0).abs() < scale, "mean {mean}");
    assert!(
        (second - 2.0).abs() < scale * 20_f64.sqrt(),
        "second moment {second}"
    );
}
