//! A stack of speckle patterns shows the correlations that the law of motion states.

use tem00::{
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, DVec3, Illumination, ImagingGeometry,
        LensData, RigidMotion, RigidMotions, SpeckleMotion,
    },
    numerics::{Grid, cast::to_f32},
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::pearson_correlation,
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

/// The standard error of the correlation of two independent patterns: the variance is 0.585 h²/A,
/// with A = Q² and h = Q/C.
fn standard_error() -> f64 {
    0.585_f64.sqrt() / DIAMETER as f64
}

/// The correlations that the law states after motions of one point across the line of sight.
fn correlations_of_motions<const N: usize>(motions: [f64; N]) -> [f64; N] {
    let pupil = DVec3::new(0.0, 0.0, 0.3);
    let geometry = ImagingGeometry::from_lens(LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    })
    .expect("a valid lens");
    let before = Configuration::new(ConfigurationData {
        wavelength: 650e-9,
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::collimated(DVec3::Z).expect("a direction"),
        camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y).expect("a valid view"),
        pupil,
    })
    .expect("a visible point");
    motions.map(|x| {
        let after = before.moved(&RigidMotions {
            surface: RigidMotion::along(DVec3::X * x).expect("a translation"),
            ..RigidMotions::default()
        });
        SpeckleMotion::between(&geometry, &before, &after.expect("a visible point")).correlation
    })
}

#[test]
fn a_stack_shows_the_correlations_that_the_law_states() {
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
            // Correlated patterns spread up to 1.5 times as much as independent ones; centres are
            // rounded to the lattice, which moves the law by 1/C.
            let tolerance =
                4.0 * 1.5 * standard_error() / (PATTERNS as f64).sqrt() + 1.0 / DIAMETER as f64;
            assert!(
                (seen - gamma).abs() < tolerance,
                "{path:?}: {seen} seen, {gamma} stated"
            );
        }
    }
}
