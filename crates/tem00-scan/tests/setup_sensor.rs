//! Artefacts as a set-up measures them.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::sync::atomic::AtomicBool;

use tem00_scan::SetupSensor;
use tem00_statistics::imaged_line_power_contrast;
use tem00_topography::{Artefact, DVec3, ProfileSensor, Shape, SurfacePoint};
use tem00_triangulation::{Budget, Setup, UncertaintySource, parse_setup};

fn setup(plane: &str) -> Setup {
    let text = format!(
        r#"
        laser = {{ wavelength = "650 nm", power = "5 mW", line_thickness = "0.3 mm", line_length = "50 mm"{plane} }}
        surface = {{ reflectance = 0.5 }}
        sensor = {{ quantum_efficiency = 0.6, exposure = "auto" }}
        detector = {{ window = 21 }}
        [camera]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [320, 300]
        distance = "200 mm"
        angle = "35 deg"
        "#
    );
    parse_setup(&text).expect("a set-up")
}

fn profiles(setup: &Setup, places: &[DVec3]) -> Vec<Vec<SurfacePoint>> {
    let flat = Artefact {
        name: "level flat",
        shape: Shape::Flat { slope: [0.0; 2] },
        size: [5e-3, 20e-3],
    };
    let cancel = AtomicBool::new(false);
    let mut sensor = SetupSensor::new(setup, 16, 3, &|_| (), &cancel);
    sensor.measure(&flat, places).expect("it is measured")
}

/// The mean of the points, and the standard deviation of their heights.
fn summary(points: &[SurfacePoint]) -> (DVec3, f64) {
    let count = points.len() as f64;
    let mean = points.iter().map(|point| point.position).sum::<DVec3>() / count;
    let squares = points
        .iter()
        .map(|point| (point.position.z - mean.z).powi(2));
    (mean, (squares.sum::<f64>() / count).sqrt())
}

#[test]
fn a_flat_is_measured_where_it_stands() {
    for plane in ["", r#", offset = "2 mm", tilt = "-3 deg""#] {
        let setup = setup(plane);
        let places = [DVec3::new(0.0, 3e-3, 1e-3), DVec3::new(0.0, -2e-3, -1e-3)];
        let field = SetupSensor::new(&setup, 1, 0, &|_| (), &AtomicBool::new(false)).field();
        for (points, place) in profiles(&setup, &places).iter().zip(places) {
            let (mean, deviation) = summary(points);
            let columns = 5e-3 / field.column;
            // Perspective changes the width by 1 %, and its ends are cut.
            let part = points.len() as f64 / columns;
            assert!((part - 1.0).abs() < 0.03, "{plane}, {place}: {part}");
            // Speckle of some three pixels correlates as many neighbours.
            let error = deviation / (columns / 4.0).sqrt();
            assert!(mean.z.abs() < 4.0 * error, "{plane}, {place}: {mean}");
            let along = mean.y + place.y;
            assert!(along.abs() < 4.0 * error, "{plane}, {place}: {mean}");
            // Diffraction spreads either end over some speckles, of which the last lit column is one.
            assert!(
                mean.x.abs() < 2.0 * field.column,
                "{plane}, {place}: {mean}"
            );
        }
    }
}

#[test]
fn a_repetition_changes_the_noise_of_the_sensor_alone() {
    let setup = setup("");
    // A few dim columns decide: many are looked at.
    let places: Vec<DVec3> = (0..12_u32)
        .map(|i| f64::from(i / 2) * 1e-3 * DVec3::Y)
        .collect();
    let found = profiles(&setup, &places);
    let heights = |points: &[SurfacePoint]| -> Vec<f64> {
        points.iter().map(|point| point.position.z).collect()
    };
    let every_second = |first: usize| {
        let profiles = found.iter().skip(first).step_by(2);
        profiles
            .flat_map(|points| heights(points))
            .collect::<Vec<_>>()
    };
    let [first, again] = [0, 1].map(every_second);
    let aside = heights(&found[2]);
    let rms = |a: &[f64], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        (0.5 * squares.sum::<f64>() / a.len() as f64).sqrt()
    };
    let budget = Budget::new(&setup).expect("it measures");
    // Noise goes with the inverse of a column's power, as shot noise, or of its square. The power is a sum of 1/K² equal
    // grains.
    let (line, speckle) = (setup.line(), setup.line().speckle_size[1]);
    let radius = 0.5 * line.projected_thickness / speckle;
    let grains = imaged_line_power_contrast(radius, 1.0 / speckle).powi(-2);
    let shot = grains / (grains - 1.0);
    let dark = shot * grains / (grains - 2.0);
    let squares = [
        (UncertaintySource::ShotNoise, shot),
        (UncertaintySource::DarkNoise, dark),
        (UncertaintySource::Quantisation, dark),
    ]
    .map(|(source, more)| more * budget.contribution(source).powi(2));
    let expected = squares.iter().sum::<f64>().sqrt();
    let found = rms(&first, &again);
    assert!(
        (found / expected - 1.0).abs() < 0.2,
        "{found:e}, {expected:e}"
    );
    assert!(rms(&first, &aside) > 5.0 * found);
}

#[test]
fn what_stands_beside_the_line_has_no_points() {
    let far = profiles(&setup(""), &[0.1 * DVec3::Y]);
    assert_eq!(far, [Vec::new()]);
}
