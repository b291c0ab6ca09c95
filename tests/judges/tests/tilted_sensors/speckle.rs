//! The speckle itself: its width, where it goes, and what is left of it.

use core::f64::consts::PI;

use tem00::{
    camera::{RadialDistortion, SensorTilt},
    decorrelation::equivalent_pupil_shift,
    engine::{FollowedPoint, SpeckleChange},
    numerics::{Grid, jinc},
    scan::SensorSpeckle,
    triangulation::{DVec2, DVec3},
    wave::displacement_between,
};

use super::setting::{Prepared, Ratio, SIZE, Setting};

const SEEDS: u64 = 2;

fn settings() -> Vec<Setting> {
    let oblique = Setting {
        name: "tilted obliquely, behind a lens that distorts",
        tilt: SensorTilt {
            angle: 0.2,
            azimuth: 0.6,
        },
        distortion: RadialDistortion {
            k1: -0.4,
            ..RadialDistortion::default()
        },
        seen: DVec3::new(8e-3, 0.0, 6e-3),
        step: DVec3::new(40e-6, 30e-6, 20e-6),
    };
    vec![
        Setting::scheimpflug(20e-3, 70e-6),
        Setting::scheimpflug(0.0, 60e-6),
        Setting::scheimpflug(-25e-3, 60e-6),
        oblique,
    ]
}

/// The standard error of a displacement found by cross-correlation of two images, in pixels.
///
/// The noise of the correlation of patterns of N speckles is 0.765/√N high and as narrow as
/// speckle: it slopes by 0.765 π/√N per speckle. The peak is γ π²/2 times as curved, or less where
/// the pupils share a lens 1 − s as wide as they are: (1 − s)² times that.
fn displacement_error(change: &SpeckleChange, size: [f64; 2]) -> f64 {
    let shift = equivalent_pupil_shift(change.correlation).expect("a correlation");
    let slope = 0.765 * PI / speckles(size).sqrt();
    size[0].max(size[1]) * slope / (0.5 * PI * PI * change.correlation * (1.0 - shift).powi(2))
}

/// The number of speckles of a size in an image.
fn speckles(size: [f64; 2]) -> f64 {
    (SIZE[0] * SIZE[1]) as f64 / (size[0] * size[1])
}

/// Displacement and correlation of the speckle in frame 0 and later ones, as means over the seeds.
fn found(setting: &Setting, later: [u32; 2]) -> [(DVec2, f64); 2] {
    let mut sums = [(DVec2::ZERO, 0.0); 2];
    for seed in 1..=SEEDS {
        let prepared = Prepared::new(setting.scene(6, seed));
        let first = prepared.speckle(0);
        for (sum, frame) in sums.iter_mut().zip(later) {
            let shift = displacement_between(&first, &prepared.speckle(frame)).expect("a maximum");
            sum.0 += shift.offset / SEEDS as f64;
            sum.1 += shift.correlation / SEEDS as f64;
        }
    }
    sums
}

#[test]
fn speckle_goes_where_the_scan_says_and_keeps_what_it_says() {
    const LATER: [u32; 2] = [1, 5];
    for setting in settings() {
        let name = setting.name;
        let prepared = Prepared::new(setting.scene(6, 1));
        let (measurement, first) = (&prepared.measurement, prepared.measure(0));
        let size = measurement.speckle().size();
        for (later, (displacement, left)) in LATER.into_iter().zip(found(&setting, LATER)) {
            let said = measurement.speckle_change(&first, later).expect("a law");
            let one = displacement_error(&said, size) / (SEEDS as f64).sqrt();
            assert!(
                (displacement - said.displacement).length() < 4.0 * one,
                "{name}, {later} later: {displacement:.3} ± {one:.3} px, said to be {said:?}"
            );
            // The variance is 0.585/N for independent patterns of N speckles, at most 1.5² times
            // that for correlated ones. Off the slices the blend exceeds the law by up to 0.06.
            let one = 1.5 * (0.585 / speckles(size) / SEEDS as f64).sqrt();
            assert!(
                (left - said.correlation).abs() < 4.0 * one + 0.06,
                "{name}, {later} later: {left:.3} ± {one:.3} left, said to be {said:?}"
            );
        }
    }
}

#[test]
fn speckle_in_focus_goes_with_the_image_of_the_surface() {
    for (z, step) in [(20e-3, 70e-6), (0.0, 60e-6), (-25e-3, 60e-6)] {
        let setting = Setting::scheimpflug(z, step);
        let scene = setting.scene(2, 1).scene;
        let point = FollowedPoint {
            surface: 0,
            position: setting.seen,
            normal: DVec3::Z,
        };
        let change = SpeckleChange::between(&scene, 0, &point, [0, 1]).expect("a law");
        let [before, after] = [0.0, 1.0].map(|steps| {
            let image = scene.camera.project(setting.seen + steps * setting.step);
            image.expect("in sight")
        });
        // The surface leaves the plane in focus by 70 µm. On average over the way 1/Z is off by
        // 0.007/m, and speckle moves by 70 µm on the pupil: c W a_P is 1e-8 m, 0.003 pixels.
        let error = (change.displacement - (after - before)).length();
        assert!(error < 0.003, "z = {z} m: {change:?}, off by {error}");
    }
}

/// The autocovariance of speckle in pixels, by summing over pairs of points of two pixels.
fn autocovariance(speckle: &SensorSpeckle, lag: DVec2) -> f64 {
    const POINTS: u32 = 24;
    let along = |i: u32| (f64::from(i) + 0.5) / f64::from(POINTS) * 2.0 - 1.0;
    let mut sum = 0.0;
    for x in (0..POINTS).map(along) {
        for y in (0..POINTS).map(along) {
            let between = lag + speckle.sensitive_side * DVec2::new(x, y);
            let field = jinc(PI * (speckle.speckles_per_pixel * between).length());
            sum += (1.0 - x.abs()) * (1.0 - y.abs()) * field * field;
        }
    }
    sum * (2.0 / f64::from(POINTS)).powi(2)
}

/// Adds the autocovariance of an image with a mean of 1, block by block.
fn add(ratio: &mut Ratio, image: &Grid<f32>, [right, down]: [usize; 2]) {
    const BLOCK: usize = 32;
    let [width, height] = SIZE;
    for first in (0..width - right).step_by(BLOCK) {
        let mut sums = [0.0; 2];
        for x in first..(first + BLOCK).min(width - right) {
            for y in 0..height - down {
                let pair = [image[(x, y)], image[(x + right, y + down)]];
                let [a, b] = pair.map(|factor| f64::from(factor) - 1.0);
                sums[0] += a * b;
                sums[1] += 1.0;
            }
        }
        ratio.add(sums);
    }
}

#[test]
fn speckle_is_as_wide_as_the_scan_says() {
    for setting in settings() {
        let prepared = (1..=2 * SEEDS).map(|seed| Prepared::new(setting.scene(1, seed)));
        let prepared: Vec<_> = prepared.collect();
        let images: Vec<_> = prepared
            .iter()
            .map(|prepared| prepared.speckle(0))
            .collect();
        let speckle = prepared[0].measurement.speckle();
        for lag in [[1, 0], [0, 1], [1, 1], [2, 0], [0, 2]] {
            let mut found = Ratio::default();
            for image in &images {
                add(&mut found, image, lag);
            }
            let [found, error] = found.with_error();
            let [x, y] = lag.map(|lag| lag as f64);
            let expected = autocovariance(speckle, DVec2::new(x, y));
            assert!(
                (found - expected).abs() < 4.0 * error,
                "{}, {lag:?}: {found:.3} ± {error:.3}, said to be {expected:.3}",
                setting.name
            );
        }
    }
}

#[test]
fn speckle_in_the_plane_of_the_laser_is_as_wide_as_the_lens_equation_says() {
    let [focal_length, pitch, pupil, wavelength] = [16e-3, 3.45e-6, 2e-3, 660e-9];
    let tilt = (16.0_f64 / 84.0).atan();
    let image_distance = 1.0 / (1.0 / focal_length - 1.0 / 0.1);
    for z in [20e-3, 0.0, -25e-3] {
        let scene = Setting::scheimpflug(z, 0.0).scene(1, 1);
        let [across, down] = Prepared::new(scene).measurement.speckle().size();
        // All of the plane is in focus, behind the lens by the lens equation for its depth.
        let depth = 0.1 - z * 0.5_f64.sqrt();
        let behind = 1.0 / (1.0 / focal_length - 1.0 / depth);
        let size = wavelength * behind / pupil / pitch;
        let stretch = behind / (image_distance * tilt.cos());
        // Of the position of the camera six digits are written down.
        assert!((across / size - 1.0).abs() < 1e-6, "z = {z} m: {across}");
        assert!(
            (down / (size * stretch) - 1.0).abs() < 1e-6,
            "z = {z} m: {down}"
        );
    }
}
