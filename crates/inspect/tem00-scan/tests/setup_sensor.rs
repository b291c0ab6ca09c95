//! Artefacts as a set-up measures them.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::sync::atomic::AtomicBool;

use tem00_scan::SetupSensor;
use tem00_statistics::laws::imaged_line_power_contrast;
use tem00_testkit::assert_relative;
use tem00_topography::{Artefact, Axis, DVec3, Groove, ProfileSensor, Shape, SurfacePoint};
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
    profiles_of(&flat, setup, places)
}

fn profiles_of(artefact: &Artefact, setup: &Setup, places: &[DVec3]) -> Vec<Vec<SurfacePoint>> {
    let cancel = AtomicBool::new(false);
    let mut sensor = SetupSensor::new(setup, 16, 3, &|_| (), &cancel);
    sensor.measure(artefact, places).expect("it is measured")
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
            assert_relative(points.len() as f64, columns, 0.03);
            // Speckle of some three pixels correlates as many neighbours.
            let error = deviation / (columns / 4.0).sqrt();
            // Diffraction spreads either end over some speckles, of which the last lit column is
            // one.
            let off = DVec3::new(mean.x, mean.y + place.y, mean.z).abs();
            let bounds = DVec3::new(2.0 * field.column, 4.0 * error, 4.0 * error);
            assert!(off.cmplt(bounds).all(), "{plane}, {place}: {off}");
        }
    }
}

#[test]
fn artefacts_are_measured_as_they_are_shaped() {
    let setup = setup("");
    let grooves = |across, centre| Shape::Grooves {
        across,
        depth: 1e-3,
        grooves: vec![Groove {
            centre,
            width: 3e-3,
        }],
    };
    for shape in [
        Shape::Flat { slope: [0.1, 0.0] },
        Shape::Flat { slope: [0.0, -0.2] },
        Shape::Sphere { radius: 8e-3 },
        grooves(Axis::X, -0.6e-3),
        grooves(Axis::Y, 1.6e-3),
    ] {
        let artefact = Artefact {
            name: "artefact",
            shape,
            size: [5e-3, 8e-3],
        };
        // Both on one side: the rows beside a line do not reach the heights on the other.
        let places = [DVec3::new(0.0, -1.6e-3, 3e-3), DVec3::new(0.0, 2e-3, 2e-3)];
        for points in profiles_of(&artefact, &setup, &places) {
            // Walls, ends and grains of speckle take some columns; the shapes differ by 0.2 mm and
            // more.
            let is_there = |point: &&SurfacePoint| {
                let DVec3 { x, y, z } = point.position;
                let height = artefact.height(x, y);
                height.is_some_and(|height| (z - height).abs() < 0.1e-3)
            };
            let there = points.iter().filter(is_there).count() as f64;
            let [found, expected] = [points.len() as f64, 5e-3 / (7.728e-3 / 320.0)];
            assert!(there > 0.9 * found, "{artefact:?}: {there} of {found}");
            assert!(there > 0.85 * expected, "{artefact:?}: {there}");
        }
    }
}

#[test]
fn a_field_is_that_of_lens_line_and_means() {
    for (line_length, columns, width) in [(50e-3, 1, 7.728e-3), (6e-3, 4, 6e-3)] {
        let mut description = setup("").description().clone();
        description.laser.line_length = line_length;
        description.average.columns = columns;
        let setup = Setup::new(description).expect("a set-up");
        let field = SetupSensor::new(&setup, 1, 0, &|_| (), &AtomicBool::new(false)).field();
        // 320 pixels of 3.45 µm by the magnification f / (L − f) = 1/7; the line of 0.3 mm moves by
        // itself over 0.3 mm / tan 35°.
        let column = 7.728e-3 / 320.0 * f64::from(columns);
        let found = [
            field.width,
            field.column,
            field.thickness,
            field.groove_depth,
        ];
        let expected = [width, column, 0.3e-3, 0.15e-3 / 35_f64.to_radians().tan()];
        for (found, expected) in found.into_iter().zip(expected) {
            assert_relative(found, expected, 1e-12);
        }
        let points = &profiles(&setup, &[DVec3::ZERO])[0];
        // Dark grains take single columns at the ends.
        let [first, last] = [0, points.len() - 1].map(|i| &points[i]);
        let columns = (last.column - first.column) as f64;
        let apart = last.position.x - first.position.x;
        assert_relative(apart, columns * column, 0.02);
        assert_relative(apart, 5e-3, 0.05);
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
    let heights = |first: usize| -> Vec<f64> {
        let profiles = found.iter().skip(first).step_by(2).flatten();
        profiles.map(|point| point.position.z).collect()
    };
    let [first, again, aside] = [0, 1, 2].map(heights);
    let rms = |a: &[f64], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
        (0.5 * squares.sum::<f64>() / a.len() as f64).sqrt()
    };
    let budget = Budget::new(&setup).expect("it measures");
    // Noise goes with the inverse of a column's power, as shot noise, or of its square. The power
    // is a sum of 1/K² equal grains.
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
    assert_relative(found, expected, 0.2);
    assert!(rms(&first, &aside) > 5.0 * found);
}

#[test]
fn what_stands_beside_the_line_has_no_points() {
    let far = profiles(&setup(""), &[0.1 * DVec3::Y]);
    assert_eq!(far, [Vec::new()]);
}
