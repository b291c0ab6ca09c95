#![expect(clippy::float_cmp, reason = "what is stored comes back as it was")]

use core::sync::atomic::AtomicBool;

use glam::DVec3;
use tem00_testkit::{assert_absolute, assert_relative, refuses, rows};
use tem00_tracer::{Environment, Light, RigidMotion, Rotation, Trajectory};
use tem00_triangulation::{SensorDescription, Validity};

use crate::{motion::ScanMotion, testing::point, *};

mod maps;
mod scenes;

use scenes::{SCENE, measured, scene_of};

#[test]
fn an_even_radiance_frees_the_electrons_that_the_aperture_tells() {
    let mut measured = measured(SCENE);
    measured.scene.surfaces.truncate(1);
    measured.scene.lasers.truncate(1);
    let away = RigidMotion::along(DVec3::new(1.0, 1.0, -1.0)).unwrap();
    measured.scene.surfaces[0].shape = measured.scene.surfaces[0].shape.moved(&away);
    let radiance = 2.5;
    let sky = Environment::constant(radiance).unwrap();
    measured.scene.lights = vec![Light::Environment(sky)];
    let camera = measured.scene.camera;
    let frame = first_frame(measured);
    // On the axis E = π L / (4 F²) with the working f-number, at 550 nm for white light.
    let f_number = 8.0 * camera.image_distance() / 25e-3;
    let irradiance = core::f64::consts::PI * radiance / (4.0 * f_number * f_number);
    let energy = irradiance * 3.45e-6 * 3.45e-6 * 1e-4;
    let photons = energy * 550e-9 / (6.626_070_15e-34 * 299_792_458.0);
    let found = f64::from(frame.exposure.electrons[(16, 12)]);
    // The middle of the image is half a pixel off the axis: cos⁴θ differs by 1e-8; f32 by 6e-8.
    assert_relative(found, 0.6 * photons, 1e-6);
    assert_eq!(
        frame.exposure.coherent[(16, 12)],
        0.0,
        "lights have no speckle"
    );
}

#[test]
fn the_part_is_brought_back_along_its_motion() {
    let mut measured = measured(SCENE);
    let turn = Rotation {
        axis: DVec3::Z,
        angle: 0.1,
    };
    let moving = Trajectory::turning(DVec3::X, turn, DVec3::new(0.0, 1e-3, 2e-4)).unwrap();
    for surface in &mut measured.scene.surfaces {
        surface.trajectory = moving.clone();
    }
    measured.scene.frames = 8;
    let motion = ScanMotion::of_scene(&measured.scene, None).unwrap();
    assert_eq!(motion.surfaces(), [0, 1]);
    let on_part = DVec3::new(0.01, -0.02, 0.03);
    for frame in 0..8 {
        let seen = moving.pose_at(frame).point(on_part);
        let back = motion.to_part(frame).point(seen);
        assert!(back.distance(on_part) < 1e-15, "{frame}: {back}");
    }
}

#[test]
fn a_head_that_moves_sees_what_a_part_that_moves_the_other_way_shows() {
    let by = DVec3::new(0.0, 1e-3, 0.0);
    let mut head = measured(SCENE).scene;
    head.camera_trajectory = Trajectory::steady(-by).unwrap();
    head.lasers[0] = head.lasers[0]
        .clone()
        .with_trajectory(head.camera_trajectory.clone());
    let mut part = measured(SCENE).scene;
    for surface in &mut part.surfaces {
        surface.trajectory = Trajectory::steady(by).unwrap();
    }
    let [head, part] = [head, part].map(|mut scene| {
        scene.frames = 4;
        ScanMotion::of_scene(&scene, None).unwrap()
    });
    let seen = DVec3::new(1e-3, 2e-3, 3e-3);
    let [a, b] = [&head, &part].map(|motion| motion.to_part(3).point(seen));
    assert!(a.distance(b) < 1e-17, "{a} and {b}");
    assert!(a.distance(seen) > 2e-3, "{a}: both move");
}

#[test]
fn scenes_that_cannot_be_measured_say_why() {
    let told = |scene| Measurement::new(scene).unwrap_err().to_string();
    for [from, to, why] in rows(
        r#"
        line = { fan_angle = "20 deg", thickness = "0.3 mm" } => spot.waist_radius = "1 mm" => must draw a line
        line_direction = [1, 0, 0] => line_direction = [0, 1, 0] => from left to right
        [render] => [render]\nfilter = "gaussian" => `filter`
        [render] => [render]\ncrop = [0, 0, 8, 8] => `crop`
        [render] => [render]\nmethod = "light" => `method`
        "#,
    ) {
        let error = told(measured(&SCENE.replace(&from, &to)));
        assert!(error.contains(&why), "{error}");
    }
    let mut apart = measured(SCENE);
    apart.scene.frames = 2;
    apart.scene.surfaces[0].trajectory = Trajectory::steady(DVec3::X).unwrap();
    apart.scene.surfaces[1].trajectory = Trajectory::steady(DVec3::Y).unwrap();
    let error = told(apart.clone());
    assert!(
        error.contains("\"low\" and \"high\" move differently"),
        "{error}"
    );
    apart.scan.surface = Some("high".to_owned());
    Measurement::new(apart.clone()).expect("one of them is named");
    apart.scene.camera_trajectory = Trajectory::steady(DVec3::X).unwrap();
    assert!(told(apart).contains("one head"), "the laser stands");
}

#[test]
fn files_with_mistakes_in_the_scan_are_placed() {
    let table = r#"
        surfaec = "low" => did you mean `surface`?
        surface = "lid" => "low", "high"
        pitch = "-1 mm" => `pitch` must be
        average = { frames = 2 } => from 1 to 1
        average = { columns = 0 } => from 1 to 65536
        raw = "gif" => one of "png", "tiff"
        height = [0, 0, 0] => not all zero
    "#;
    for [bad, message] in rows(table) {
        let error = scene_of(&format!("{SCENE}\n[scan]\n{bad}")).unwrap_err();
        assert!(error.line_column().is_some(), "{error}");
        assert!(error.message().contains(&message), "{error}");
    }
    let whole = "[scan]\nsurface = \"low\"\npitch = \"0.1 mm\"\nraw = \"tiff\"\n\
                 height = [0, 2, 0]\naverage = { columns = 3 }";
    let scan = measured(&format!("{SCENE}\n{whole}")).scan;
    let expected = ScanSettings {
        surface: Some("low".to_owned()),
        pitch: Some(1e-4),
        raw: RawFormat::Tiff,
        height: DVec3::Y,
        average: Averaging {
            frames: 1,
            columns: 3,
        },
    };
    assert_eq!(scan, expected);
}

/// Measures the first frame of a scene without speckle.
fn first_frame(scene: MeasurementScene) -> MeasuredFrame {
    let measurement = Measurement::new(scene).unwrap();
    let frame = measurement.measure(None, 0, &|_| (), &AtomicBool::new(false));
    frame.unwrap()
}

#[test]
fn a_further_uncertainty_of_heights_is_one_along_them() {
    let mut measured = measured(SCENE);
    measured.calibration.uncertainty = 7e-6;
    measured.scan.height = DVec3::new(2.0, 3.0, 6.0) / 7.0;
    let point = first_frame(measured).points[0];
    // 7 µm times the cosine to the heights, since the calibration is exact apart from the heights.
    for (direction, expected) in [
        (DVec3::X, 2e-6),
        (DVec3::Y, 3e-6),
        (DVec3::Z, 6e-6),
        (DVec3::new(0.6, 0.8, 0.0), 3.6e-6),
        (DVec3::new(-0.6, 0.0, 0.8), 3.6e-6),
        (DVec3::new(6.0, 2.0, -3.0) / 7.0, 0.0),
    ] {
        assert_absolute(
            point.calibration_uncertainty_along(direction),
            expected,
            1e-12,
        );
    }
}

#[test]
fn pixels_are_saturated_from_four_deviations_of_noise_below_a_full_well() {
    // 4 √(3² + 4²) = 20 electrons of noise, four to a grey value.
    for (full_well, black_level, expected) in [
        (10_000.0, 100.0, 2595.0),
        (10_000.0, 0.0, 2495.0),
        (1e6, 100.0, 4095.0),
        (10.0, 0.0, 1.0),
    ] {
        let mut measured = measured(SCENE);
        measured.sensor = SensorDescription {
            full_well,
            black_level,
            gain: 0.25,
            dark_noise: 3.0,
            dsnu: 4.0,
            bit_depth: 12,
            ..measured.sensor
        };
        let measurement = Measurement::new(measured).unwrap();
        assert_eq!(measurement.detector().settings().saturation, expected);
    }
}

#[test]
fn speckle_has_the_variance_of_the_surface_where_it_is_greatest() {
    // (1 + P²) / 2 divided by the number of patterns.
    for (others, expected) in [((0.0, 2), 0.25), ((0.0, 4), 0.17)] {
        let mut measured = measured(SCENE);
        let kinds = [(0.6, 4), others];
        for (surface, (polarisation, patterns)) in measured.scene.surfaces.iter_mut().zip(kinds) {
            (surface.speckle.polarisation, surface.speckle.patterns) = (polarisation, patterns);
        }
        let found = Measurement::new(measured).unwrap().speckle().variance;
        assert_absolute(found, expected, 1e-15);
    }
}

#[test]
fn light_without_speckle_correlates_no_columns() {
    let scene = SCENE.replace("[32, 24]", "[32, 64]");
    let measurement = Measurement::new(measured(&scene)).unwrap();
    let speckled = first_frame(measured(&scene)).exposure;
    let smooth = Exposure {
        coherent: speckled.coherent.map(|_| 0.0),
        ..speckled.clone()
    };
    let correlation = |exposure| {
        let frame = measurement.measure_light(exposure, 0, true);
        frame.unwrap().correlation
    };
    assert_eq!(correlation(smooth), [1.0]);
    let falling = correlation(speckled);
    assert!(falling.len() > 10 && falling[0] == 1.0, "{falling:?}");
    assert!((0.1..0.9).contains(&falling[1]), "{falling:?}");
}

#[test]
fn light_that_met_a_second_wall_moves_a_line_by_what_is_stated() {
    let (before, _) = SCENE.split_once("[[surface]]").unwrap();
    let (_, after) = SCENE.split_once("[sensor]").unwrap();
    // A groove of 90° in milled aluminium, along the scan, whose height at x is |x|.
    let wall = |x: i32| {
        format!(
            "[[surface]]\nconductor = {{ metal = \"aluminium\", roughness = 0.35 }}\n\
             rectangle = {{ centre = [\"{x} mm\", 0, \"8 mm\"], normal = [{}, 0, 1], \
             size = [\"22.627 mm\", \"40 mm\"] }}\n",
            -x / 8
        )
    };
    let scene = |walls: &[i32]| {
        let walls: String = walls.iter().map(|&x| wall(x)).collect();
        let text = format!("{before}{walls}[sensor]{after}")
            .replace(
                "resolution = [32, 24]",
                "resolution = [160, 160]\nlook_at = [0, 0, \"1 mm\"]",
            )
            .replace("samples_per_pixel = 4", "samples_per_pixel = 32")
            .replace("\"0.1 ms\"", "\"0.2 ms\"");
        first_frame(measured(&text))
    };
    let frame = scene(&[-8, 8]);
    let points = frame.points.iter().filter(|point| point.is_valid());
    let (mut count, mut held, mut by_noise, mut left) = (0.0, 0.0, 0.0, 0.0);
    for point in points {
        let error = point.position.z - point.position.x.abs();
        let noise = point.noise.total().sqrt() * point.per_pixel.z.abs();
        count += 1.0;
        let within = |uncertainty: f64| f64::from(error.abs() < 1.96 * uncertainty);
        held += within(point.uncertainty_along(DVec3::Z));
        by_noise += within(noise);
        // The error that remains after the shift is noise of the sensor and of 32 samples of a
        // pixel.
        left += ((error - point.indirect.shift * point.per_pixel.z) / noise).powi(2);
        let fraction = point.indirect.fraction;
        let is_near = point.position.x.abs() < 1e-3;
        assert!(!is_near || (0.6..0.95).contains(&fraction), "{fraction}");
    }
    let ratios = [held, by_noise, left].map(|sum| sum / count);
    assert!(count > 150.0 && ratios[0] > 0.95, "{ratios:?}");
    assert!(ratios[1] < 0.5, "by noise alone far too few: {ratios:?}");
    assert!(ratios[2] < 4.0, "the shift is the error: {ratios:?}");
    let alone = scene(&[-8]);
    assert!(!alone.points.is_empty(), "one wall is seen");
    for point in &alone.points {
        assert_eq!(point.indirect, IndirectLight::default(), "one wall alone");
    }
}

#[test]
fn a_mean_is_as_uncertain_as_its_correlations_say() {
    let mut points = [point(0, DVec3::ZERO), point(1, 2e-3 * DVec3::Z)];
    for (point, shift) in points.iter_mut().zip([0.2, 0.4]) {
        point.indirect.shift = shift;
    }
    let members: Vec<_> = [0, 1]
        .iter()
        .flat_map(|&f| points.iter().map(move |p| (f, p)))
        .collect();
    // It falls to a half from column to column, and to a quarter from frame to frame.
    let halving = |columns: i64, later| 0.5_f64.powf(columns.abs() as f64 + 2.0 * f64::from(later));
    let mean = mean_point(&members, halving).unwrap();
    assert!((mean.position - 1e-3 * DVec3::Z).length() < 1e-18);
    // Sum of ρ: (2 + 2 · 1/2) within a frame, twice, and the same times 1/4 between them, twice.
    assert_absolute(mean.noise.speckle, 0.04 * 7.5 / 16.0, 1e-15);
    assert_absolute(mean.noise.shot, 0.0025 / 4.0, 1e-15);
    // The response of a pixel stays over frames: two columns average.
    assert_absolute(mean.noise.prnu, 0.01 / 2.0, 1e-15);
    // Indirect light moves all points alike.
    let up = 1e-5 * mean.noise.total().sqrt().hypot(0.3);
    assert_absolute(mean.uncertainty_along(DVec3::Z), up, 1e-18);
}

#[test]
fn a_mean_is_not_better_than_one_over_independent_frames() {
    let points = point(0, DVec3::ZERO);
    // Frames whose errors are opposite.
    let opposite = |_, later| if later == 0 { 1.0 } else { -0.9 };
    let mean = mean_point(&[(0, &points), (1, &points)], opposite).unwrap();
    assert_absolute(mean.noise.speckle, 0.04 / 2.0, 1e-15);
    let law = FrameCorrelation::new(vec![vec![1.0], vec![-0.9], vec![0.5]]);
    // Three frames, of which the first and the last are correlated: 9 / (3 + 2 · 1/2).
    assert_absolute(law.effective_frames(3), 9.0 / 4.0, 1e-15);
    assert_eq!(law.effective_frames(2), 2.0, "both count");
    assert_eq!(law.between(0, 1), -0.9, "the law is told as it is");
}

#[test]
fn settings_that_no_scan_has_are_refused() {
    refuses!(scene = measured(SCENE) => Measurement::new(scene);
        scene.scan.average.frames: [0],
        scene.scan.average.columns: [0],
        scene.scan.pitch: [Some(0.0), Some(-1e-3), Some(f64::NAN), Some(f64::INFINITY)],
        scene.scan.height: [DVec3::ZERO, DVec3::splat(f64::NAN), 2.0 * DVec3::Z],
        scene.sensor.gain: [-1.0],
    );
}

#[test]
fn slivers_of_a_line_are_no_places_of_the_line() {
    // A plate that the whole line falls on, and next to it a strip of 50 µm, a pixel in the image.
    let changes = [
        ("[32, 24]", "[32, 64]"),
        ("[\"-10 mm\", 0, 0]", "[\"-9.8 mm\", 0, 0]"),
        (
            "[\"10 mm\", 0, \"0.1 mm\"], size = [\"20 mm\", \"20 mm\"]",
            "[\"10.2 mm\", 0, 0], size = [\"20 mm\", \"50 um\"]",
        ),
    ];
    let text = changes
        .iter()
        .fold(SCENE.to_owned(), |text, (from, to)| text.replace(from, to));
    let mut measured = measured(&text);
    measured.scene.render.samples_per_pixel = 64;
    let points = first_frame(measured).points;
    // The image is 1.2 mm wide, and the strip begins 0.2 mm right of its middle.
    for MeasuredPoint { seen, .. } in &points {
        let expected = match seen.column {
            0..=19 => Validity::Valid,
            23.. => Validity::Sliver,
            _ => continue,
        };
        assert_eq!(seen.validity, expected, "{seen:?}");
    }
    assert!(points.len() > 28, "a line in {} columns", points.len());
}
