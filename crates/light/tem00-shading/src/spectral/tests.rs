use tem00_coherence::{PeakShape, PolychromaticSpeckle, SourceExtent};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{Camera, CameraDescription, DVec3, Laser, Motion, Pose, Speckle, SpeckleFrame};

/// A plane z = 0 under a laser along its normal, seen under 30° about the axis y: other wavelengths
/// displace the pupil along x.
fn camera() -> Camera {
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    Camera::new(CameraDescription {
        position: 0.3 * DVec3::new(sin, 0.0, cos),
        resolution: [480, 360],
        ..CameraDescription::default()
    })
    .unwrap()
}

fn laser(spectrum: Spectrum, half_angle: f64) -> Laser {
    Laser::spot(650e-9, 50e-3)
        .spectrum(spectrum)
        .source_extent(SourceExtent::disc(half_angle).unwrap())
        .placed(3.0 * DVec3::Z, DVec3::ZERO, DVec3::X)
        .unwrap()
}

fn gaussian(linewidth: f64) -> Spectrum {
    Spectrum::new(650e-9, linewidth, PeakShape::Gaussian).unwrap()
}

const fn relief(rms_height: f64) -> Relief {
    Relief {
        rms_height,
        correlation_length: 0.0,
    }
}

/// Points of the plane, seen wider than a speckle apart.
fn points() -> Vec<DVec3> {
    let camera = camera();
    let place =
        |i: u32| DVec2::new(40.0, 40.0) + 4.3 * DVec2::new(f64::from(i % 64), f64::from(i / 64));
    let hit = |pixel| {
        let ray = camera.ray(pixel);
        ray.origin - ray.direction * (ray.origin.z / ray.direction.z)
    };
    (0..64 * 56).map(|i| hit(place(i))).collect()
}

fn prepared(laser: &Laser, relief: Relief) -> Speckle {
    Speckle::new(&camera(), laser, 11)
        .relief(relief)
        .at_points([(DVec3::ZERO, DVec3::Z)])
}

fn cell(laser: &Laser, relief: Relief) -> ResolutionCell {
    let camera = camera();
    let law = SpectralLaw {
        laser,
        perspective: &Perspective::new(camera),
        geometry: &camera.imaging_geometry(650e-9).unwrap(),
    };
    let middle = SeenPoint {
        pixel: DVec2::new(240.0, 180.0),
        position: DVec3::ZERO,
        normal: DVec3::Z,
    };
    let cell = law.resolution_cell(&middle).unwrap();
    let cell = cell.with_relief(relief).unwrap();
    cell.with_source_extent(laser.source_extent().clone())
}

/// The covariance of two images divided by the product of their means.
fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let products: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    products / a.len() as f64 / (mean(a) * mean(b)) - 1.0
}

fn picture(frame: &SpeckleFrame, step: DVec3) -> Vec<f64> {
    let points: Vec<_> = points().into_iter().map(|point| point + step).collect();
    let mut factors = vec![0.0; points.len()];
    frame.factors(&points, &vec![DVec3::Z; points.len()], &mut factors);
    factors
}

#[test]
fn contrasts_are_those_of_the_law() {
    let comb = Spectrum::comb(650e-9, 8e-9, 5).unwrap();
    let single = Spectrum::monochromatic(650e-9).unwrap();
    // The aperture has sin u = 0.0052.
    for (spectrum, height, half_angle) in [
        (gaussian(5e-9), 0.0, 0.0),
        (gaussian(10e-9), 8e-6, 0.0),
        (comb, 2e-6, 0.0),
        (gaussian(30e-9), 20e-6, 0.0),
        (single.clone(), 0.0, 0.004),
        (single, 8e-6, 0.01),
        (gaussian(5e-9), 2e-6, 0.004),
    ] {
        let laser = laser(spectrum, half_angle);
        let speckle = prepared(&laser, relief(height)).prepare().unwrap();
        let values = picture(&speckle.frame(&Motion::default()).unwrap(), DVec3::ZERO);
        let (spectrum, cell) = (laser.spectrum(), cell(&laser, relief(height)));
        let law = PolychromaticSpeckle {
            spectrum,
            cell: &cell,
        }
        .contrast();
        // Three standard errors of a contrast from 3584 points.
        assert_relative(covariance(&values, &values).sqrt(), law, 0.045);
    }
}

/// The contrast of pairs of wave numbers on slices.
fn contrast_on(path: SlicePath, bandwidth: &Bandwidth, spectrum: &Spectrum) -> f64 {
    let scale = path.slices_per_diameter() * bandwidth.tilt * bandwidth.stretch;
    let waves = medians(spectrum, 300);
    let pairs = waves.iter().flat_map(|a| waves.iter().map(move |b| (a, b)));
    let sum: f64 = pairs
        .map(|(a, b)| path.correlation_between(scale * a, scale * b))
        .sum();
    sum.sqrt() / waves.len() as f64
}

#[test]
fn contrasts_are_those_of_the_law_on_any_number_of_slices() {
    for linewidth in [1e-9, 5e-9, 20e-9] {
        let laser = laser(gaussian(linewidth), 0.0);
        let spectrum = laser.spectrum();
        let speckle = prepared(&laser, Relief::default()).planned().unwrap().0;
        let bandwidth = speckle.bandwidth.unwrap();
        let law = bandwidth
            .covariance(spectrum, DVec2::ZERO, bandwidth.axis)
            .sqrt();
        for slices in [4, 8, 16, 32] {
            let path = SlicePath::Straight {
                half_period: 2 * slices,
                length: 4,
            };
            let bandwidth = bandwidth.clone().on_slices(spectrum, path);
            // 64 waves stand for 300.
            assert_relative(contrast_on(path, &bandwidth, spectrum), law, 0.006);
            let plain = Bandwidth {
                stretch: 1.0,
                ..bandwidth
            };
            if slices == 8 {
                let found = contrast_on(path, &plain, spectrum);
                assert!(found > 1.02 * law, "{found} tells nothing: {law}");
            }
        }
    }
}

#[test]
fn patterns_in_little_memory_have_the_contrast_of_the_law() {
    const SEEDS: u64 = 6;
    let laser = laser(gaussian(10e-9), 0.0);
    let (spectrum, cell) = (laser.spectrum(), cell(&laser, Relief::default()));
    let law = PolychromaticSpeckle {
        spectrum,
        cell: &cell,
    }
    .contrast();
    let of_seed = |seed: u64| {
        let speckle = Speckle::new(&camera(), &laser, seed).at_points([(DVec3::ZERO, DVec3::Z)]);
        let speckle = speckle.within(100 << 20).prepare().unwrap();
        let path = speckle.0.plan.path();
        assert!(path.slices_per_diameter() < 9.0, "{path:?} tells nothing");
        let values = picture(&speckle.frame(&Motion::default()).unwrap(), DVec3::ZERO);
        covariance(&values, &values)
    };
    let found = ((0..SEEDS).map(of_seed).sum::<f64>() / SEEDS as f64).sqrt();
    // Three standard errors from 3584 points of each seed.
    assert_relative(found, law, 0.045 / (SEEDS as f64).sqrt());
}

#[test]
fn pixels_have_the_contrast_of_the_law_of_a_linewidth() {
    let laser = laser(gaussian(5e-9), 0.0);
    let speckle = prepared(&laser, Relief::default()).prepare().unwrap();
    let frame = speckle.frame(&Motion::default()).unwrap();
    let values: Vec<_> = points()
        .iter()
        .map(|&point| frame.average(point, DVec3::Z))
        .collect();
    let (spectrum, cell) = (laser.spectrum(), cell(&laser, Relief::default()));
    let law = PolychromaticSpeckle {
        spectrum,
        cell: &cell,
    };
    let pixel = speckle.geometry().speckle_size_in_pixels().recip();
    // The mean of the autocovariance over pairs of points of a pixel, by the midpoint rule.
    let steps = 24;
    let parts = (0..steps * steps).map(|i| {
        let lag = [i % steps, i / steps].map(|part| (f64::from(part) + 0.5) / f64::from(steps));
        let weight = lag.map(|lag| 2.0 * (1.0 - lag)).iter().product::<f64>();
        weight * law.autocovariance(lag.map(|lag| lag * pixel))
    });
    let expected = (parts.sum::<f64>() / f64::from(steps * steps)).sqrt();
    assert!(expected < 0.95 * law.contrast(), "{expected} tells nothing");
    assert_relative(covariance(&values, &values).sqrt(), expected, 0.045);
}

#[test]
fn frames_along_the_tilt_correlate_by_the_law_and_others_are_refused() {
    let spectrum = gaussian(5e-9);
    let laser = laser(spectrum.clone(), 0.0);
    // By a quarter of the pupil, seen from 0.3 m under 30°.
    let diameter = camera().imaging_geometry(650e-9).unwrap().pupil_diameter();
    let along = 0.25 * diameter / 30_f64.to_radians().cos() * DVec3::X;
    let poses = [-along, along].map(|step| Pose::along(step).unwrap());
    let speckle = prepared(&laser, Relief::default()).for_poses(&poses);
    let speckle = speckle.prepare().unwrap();
    let here = picture(&speckle.frame(&Motion::default()).unwrap(), DVec3::ZERO);
    let cell = cell(&laser, Relief::default());
    let law = PolychromaticSpeckle {
        spectrum: &spectrum,
        cell: &cell,
    };
    for (pose, step) in poses.iter().zip([-along, along]) {
        let there = picture(&speckle.frame(&(*pose).into()).unwrap(), step);
        let found = covariance(&here, &there);
        let shift = 0.25_f64.copysign(step.x);
        assert_absolute(found, law.covariance([shift, 0.0]), 0.04);
    }
    let across = Pose::along(0.5 * diameter * DVec3::Y).unwrap();
    let refused = prepared(&laser, Relief::default())
        .for_poses(&[across])
        .prepare();
    let refused = refused.unwrap_err();
    assert_eq!(refused.parameter(), Some("motion"), "{refused}");
}

#[test]
fn light_with_a_linewidth_asks_for_points() {
    let speckle = Speckle::new(&camera(), &laser(gaussian(1e-9), 0.0), 1);
    assert!(speckle.prepare().is_err(), "the normals are not known");
}
