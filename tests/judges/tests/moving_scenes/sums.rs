//! Surfaces whose light is a sum of patterns.

use tem00::{
    decorrelation::{DVec3, pupil_overlap_correlation},
    numerics::Grid,
    statistics::{
        GammaIntensity, PartiallyPolarised, estimate::decorrelated_samples, kolmogorov_smirnov,
    },
    tracer::{Scene, SurfaceSpeckle},
};

use crate::wave_judges_decorrelation::scene::Body;

use super::setting::{LENS, Setting, assert_correlation, speckle};

/// Pixels between samples that count as independent: the first zero of the covariance lies 1.22
/// speckles of 6.6 pixels away.
const STRIDE: usize = 9;

fn setting() -> Setting {
    Setting {
        lens: LENS,
        to_laser: DVec3::Z,
        distance: None,
    }
}

fn scene(patterns: u32, polarisation: f64) -> Scene {
    let mut scene = setting().scene();
    scene.surfaces[0].speckle = SurfaceSpeckle {
        patterns,
        polarisation,
    };
    scene
}

/// Tests the independent samples of an image against a law.
fn judge(image: &Grid<f32>, cumulative: impl Fn(f64) -> f64, contrast: f64) {
    let samples = decorrelated_samples(image, STRIDE).expect("a large image");
    let test = kolmogorov_smirnov(&samples, cumulative).expect("many samples");
    // A right renderer fails one seed in a thousand; this one is fixed.
    assert!(test.p_value > 1e-3, "{test:?}");
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let square = samples
        .iter()
        .map(|v| (v / mean - 1.0).powi(2))
        .sum::<f64>()
        / count;
    // The spread of a sample variance of kurtosis up to 9 is √(8/n), that of its root half as much;
    // four times that. Pixels of 0.15 speckles lose 1 % of it.
    let error = square.sqrt() / contrast - 1.0;
    let allowed = 4.0 * 0.5 * (8.0 / count).sqrt() + 0.01;
    assert!(error.abs() < allowed, "contrast off by {error}");
}

#[test]
fn sums_of_patterns_obey_the_gamma_law() {
    for (patterns, memory) in [(1, 1 << 30), (2, 1 << 30), (4, 1 << 30), (4, 300_000)] {
        let mut scene = scene(patterns, 1.0);
        // The least of these holds one stack of 80 × 80 samples and places in it.
        scene.speckle.memory = memory;
        let image = speckle(&scene, &[0], 21).remove(0);
        let law = GammaIntensity::new(f64::from(patterns)).expect("a law");
        judge(&image, |x| law.cumulative(x), law.contrast());
    }
}

#[test]
fn partly_polarised_light_obeys_the_law_of_two_exponentials() {
    for degree in [0.0, 0.3, 0.8] {
        let image = speckle(&scene(1, degree), &[0], 22).remove(0);
        let law = PartiallyPolarised::new(degree).expect("a law");
        judge(&image, |x| law.cumulative(x), law.contrast());
    }
}

#[test]
fn sums_of_patterns_decorrelate_as_each_of_them_does() {
    // 0.25 pupil diameters, 8 slices of 32, and 80 pixels.
    let surface = 80.0 * 11.0 * LENS.pixel_pitch;
    let mut setting = setting();
    setting.lens.f_number = LENS.focal_length * 0.25 / surface;
    let mut scene = setting.scene();
    scene.surfaces[0].trajectory = Body::along(surface * DVec3::X).trajectory();
    scene.surfaces[0].speckle = SurfaceSpeckle {
        patterns: 3,
        polarisation: 0.4,
    };
    let frames = speckle(&scene, &[0, 1], 23);
    let size = setting.geometry().speckle_size_in_pixels();
    let law = pupil_overlap_correlation(0.25);
    assert_correlation("sum", [&frames[0], &frames[1]], [80, 0], (law, size));
}
