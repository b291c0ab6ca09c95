#![expect(clippy::float_cmp, reason = "what is stored comes back as it was")]

use core::sync::atomic::AtomicBool;

use glam::DVec3;
use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};
use tem00_numerics::Grid;
use tem00_testkit::refuses;
use tem00_tracer::{Environment, Light, Rotation, Trajectory};
use tem00_triangulation::{Sensor, SensorDescription, Validity};

use crate::ScanError;
use crate::{
    average::{SpeckleCorrelation, mean_point},
    testing::{doubtful, point},
    *,
};

mod scenes;

use scenes::{SCENE, measured, scene_of};

#[test]
fn an_even_radiance_frees_the_electrons_that_the_aperture_tells() {
    let mut measured = measured(SCENE);
    measured.scene.surfaces.truncate(1);
    measured.scene.lasers.truncate(1);
    measured.scene.surfaces[0].shape = measured.scene.surfaces[0]
        .shape
        .translated(DVec3::new(1.0, 1.0, -1.0));
    let radiance = 2.5;
    let sky = Environment::constant(radiance).unwrap();
    measured.scene.lights = vec![Light::Environment(sky)];
    let camera = measured.scene.camera;
    let measurement = Measurement::new(measured).unwrap();
    let frame = measurement
        .measure(None, 0, |_| (), &AtomicBool::new(false))
        .unwrap();

    // On the axis E = π L / (4 F²) with the working f-number, at 550 nm for white light.
    let f_number = 8.0 * camera.image_distance() / 25e-3;
    let irradiance = core::f64::consts::PI * radiance / (4.0 * f_number * f_number);
    let energy = irradiance * 3.45e-6 * 3.45e-6 * 1e-4;
    let photons = energy * 550e-9 / (6.626_070_15e-34 * 299_792_458.0);
    let found = f64::from(frame.exposure.electrons[(16, 12)]);
    // The middle of the image is half a pixel off the axis: cos⁴θ differs by 1e-8; f32 by 6e-8.
    assert!((found / (0.6 * photons) - 1.0).abs() < 1e-6, "{found}");
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
        assert!(
            motion.to_part(frame).point(seen).distance(on_part) < 1e-15,
            "{frame}"
        );
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
    assert!(!head.is_still() && !part.is_still());
}

#[test]
fn scenes_that_cannot_be_measured_say_why() {
    let spot = SCENE.replace(
        "line = { fan_angle = \"20 deg\", thickness = \"0.3 mm\" }",
        "spot.waist_radius = \"1 mm\"",
    );
    let upright = SCENE.replace("line_direction = [1, 0, 0]", "line_direction = [0, 1, 0]");
    let filter = SCENE.replace("[render]", "[render]\nfilter = \"gaussian\"");
    let crop = SCENE.replace("[render]", "[render]\ncrop = [0, 0, 8, 8]");
    let light = SCENE.replace("[render]", "[render]\nmethod = \"light\"");
    for (text, why) in [
        (spot, "must draw a line"),
        (upright, "from left to right"),
        (filter, "`filter`"),
        (crop, "`crop`"),
        (light, "`method`"),
    ] {
        let error = Measurement::new(measured(&text)).unwrap_err();
        assert!(matches!(error, ScanError::Scene(_)), "{error}");
        assert!(error.to_string().contains(why), "{error}");
    }
    let mut apart = measured(SCENE);
    apart.scene.frames = 2;
    apart.scene.surfaces[0].trajectory = Trajectory::steady(DVec3::X).unwrap();
    apart.scene.surfaces[1].trajectory = Trajectory::steady(DVec3::Y).unwrap();
    let error = Measurement::new(apart.clone()).unwrap_err().to_string();
    assert!(
        error.contains("\"low\" and \"high\" move differently"),
        "{error}"
    );
    apart.scan.surface = Some("high".to_owned());
    assert!(
        Measurement::new(apart.clone()).is_ok(),
        "one of them is named"
    );
    apart.scene.camera_trajectory = Trajectory::steady(DVec3::X).unwrap();
    let error = Measurement::new(apart).unwrap_err().to_string();
    assert!(error.contains("one head"), "{error}");
}

#[test]
fn files_with_mistakes_in_the_scan_are_placed() {
    for (bad, message) in [
        ("[scan]\nsurfaec = \"low\"", "did you mean `surface`?"),
        ("[scan]\nsurface = \"lid\"", "\"low\", \"high\""),
        ("[scan]\npitch = \"-1 mm\"", "`pitch` must be"),
        ("[scan]\naverage = { frames = 2 }", "from 1 to 1"),
        ("[scan]\naverage = { columns = 0 }", "from 1 to 65536"),
        ("[scan]\nraw = \"gif\"", "one of \"png\", \"tiff\""),
        ("[scan]\nheight = [0, 0, 0]", "not all zero"),
    ] {
        let error = scene_of(&format!("{SCENE}\n{bad}")).unwrap_err();
        assert!(error.line_column().is_some(), "{error}");
        assert!(error.message().contains(message), "{error}");
    }
    let whole = "[scan]\nsurface = \"low\"\npitch = \"0.1 mm\"\nraw = \"tiff\"\n\
                 height = [0, 2, 0]\naverage = { columns = 3 }";
    let scan = measured(&format!("{SCENE}\n{whole}")).scan;
    assert_eq!(scan.surface.as_deref(), Some("low"));
    assert_eq!(
        (scan.pitch, scan.raw, scan.height),
        (Some(1e-4), RawFormat::Tiff, DVec3::Y)
    );
    assert_eq!(
        scan.average,
        Averaging {
            frames: 1,
            columns: 3
        }
    );
}

/// Measures the first frame of a scene without speckle.
fn without_speckle(text: &str) -> MeasuredFrame {
    let measurement = Measurement::new(measured(text)).unwrap();
    measurement
        .measure(None, 0, |_| (), &AtomicBool::new(false))
        .unwrap()
}

#[test]
fn a_further_uncertainty_of_heights_is_one_along_them() {
    let mut measured = measured(SCENE);
    measured.calibration.uncertainty = 7e-6;
    measured.scan.height = DVec3::new(2.0, 3.0, 6.0) / 7.0;
    let measurement = Measurement::new(measured).unwrap();
    let frame = measurement.measure(None, 0, |_| (), &AtomicBool::new(false));
    let point = frame.unwrap().points[0];
    // 7 µm times the cosine to the heights, for the calibration is exact but for them.
    for (direction, expected) in [
        (DVec3::X, 2e-6),
        (DVec3::Y, 3e-6),
        (DVec3::Z, 6e-6),
        (DVec3::new(0.6, 0.8, 0.0), 3.6e-6),
        (DVec3::new(-0.6, 0.0, 0.8), 3.6e-6),
        (DVec3::new(6.0, 2.0, -3.0) / 7.0, 0.0),
    ] {
        let found = point.calibration_uncertainty_along(direction);
        assert!((found - expected).abs() < 1e-12, "{direction}: {found}");
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
    // (1 + P²) / 2 by the number of patterns.
    for (others, expected) in [((0.0, 2), 0.25), ((0.0, 4), 0.17)] {
        let mut measured = measured(SCENE);
        let kinds = [(0.6, 4), others];
        for (surface, (polarisation, patterns)) in measured.scene.surfaces.iter_mut().zip(kinds) {
            (surface.speckle.polarisation, surface.speckle.patterns) = (polarisation, patterns);
        }
        let found = Measurement::new(measured).unwrap().speckle().variance;
        assert!((found - expected).abs() < 1e-15, "{found}");
    }
}

#[test]
fn light_without_speckle_correlates_no_columns() {
    let scene = SCENE.replace("[32, 24]", "[32, 64]");
    let measurement = Measurement::new(measured(&scene)).unwrap();
    let speckled = without_speckle(&scene).exposure;
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
             rectangle = {{ centre = [\"{x} mm\", 0, \"8 mm\"], normal = [{}, 0, 1], size = [\"22.627 mm\", \"40 mm\"] }}\n",
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
        without_speckle(&text)
    };
    let frame = scene(&[-8, 8]);
    let points = frame.points.iter().filter(|point| point.is_valid());
    let (mut count, mut held, mut by_noise, mut left) = (0.0, 0.0, 0.0, 0.0);
    for point in points {
        let error = point.position.z - point.position.x.abs();
        let noise = point.noise.total().sqrt() * point.per_pixel.z.abs();
        count += 1.0;
        held += f64::from(u8::from(
            error.abs() < 1.96 * point.uncertainty_along(DVec3::Z),
        ));
        by_noise += f64::from(u8::from(error.abs() < 1.96 * noise));
        // What the shift leaves is noise of the sensor and of 32 samples of a pixel.
        left += ((error - point.indirect.shift * point.per_pixel.z) / noise).powi(2);
        if point.position.x.abs() < 1e-3 {
            assert!(
                (0.6..0.95).contains(&point.indirect.fraction),
                "{:?}",
                point.indirect
            );
        }
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

/// A correlation that falls to a half from column to column, and to a quarter from frame to frame.
struct Halving;

impl SpeckleCorrelation for Halving {
    fn between(&self, columns: i64, later: u32) -> f64 {
        0.5_f64.powi(i32::try_from(columns.abs()).unwrap() + 2 * i32::try_from(later).unwrap())
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
    let mean = mean_point(&members, &Halving).unwrap();
    assert!((mean.position - 1e-3 * DVec3::Z).length() < 1e-18);
    // Sum of ρ: (2 + 2 · 1/2) within a frame, twice, and as much times 1/4 between them, twice.
    assert!((mean.noise.speckle - 0.04 * 7.5 / 16.0).abs() < 1e-15);
    assert!((mean.noise.shot - 0.0025 / 4.0).abs() < 1e-15);
    // The response of a pixel stays over frames: two columns average.
    assert!((mean.noise.prnu - 0.01 / 2.0).abs() < 1e-15);
    // Indirect light moves all alike.
    let up = mean.uncertainty_along(DVec3::Z);
    assert!(
        (up - 1e-5 * mean.noise.total().sqrt().hypot(0.3)).abs() < 1e-18,
        "{up}"
    );
}

/// Frames whose errors are opposite.
struct Opposite;

impl SpeckleCorrelation for Opposite {
    fn between(&self, columns: i64, later: u32) -> f64 {
        let same = if columns == 0 { 1.0 } else { 0.0 };
        if later == 0 { same } else { -0.9 * same }
    }
}

#[test]
fn a_mean_is_not_better_than_one_over_independent_frames() {
    let points = point(0, DVec3::ZERO);
    let mean = mean_point(&[(0, &points), (1, &points)], &Opposite).unwrap();
    assert!((mean.noise.speckle - 0.04 / 2.0).abs() < 1e-15);
    let law = FrameCorrelation::new(vec![vec![1.0], vec![-0.9], vec![0.5]]);
    // Three frames, of which the first and the last go together: 9 / (3 + 2 · 1/2).
    assert!((law.effective_frames(3) - 9.0 / 4.0).abs() < 1e-15);
    assert_eq!(law.effective_frames(2), 2.0, "both count");
    assert_eq!(law.between(0, 1), -0.9, "the law is told as it is");
}

#[test]
fn settings_that_no_scan_has_are_refused() {
    let measure = |scan: ScanSettings| {
        Measurement::new(MeasurementScene {
            scan,
            ..measured(SCENE)
        })
    };
    refuses!(scan = ScanSettings::default() => measure(scan);
        scan.average.frames: [0],
        scan.average.columns: [0],
        scan.pitch: [Some(0.0), Some(-1e-3), Some(f64::NAN), Some(f64::INFINITY)],
        scan.height: [DVec3::ZERO, DVec3::splat(f64::NAN), 2.0 * DVec3::Z],
    );
}

#[test]
fn a_map_of_profiles_has_holes_where_nothing_is_valid() {
    let profiles = [
        vec![point(0, 1e-3 * DVec3::Z), doubtful(2, 5e-3 * DVec3::Z)],
        vec![point(1, 2e-3 * DVec3::Z)],
    ];
    let map = HeightMap::of_profiles(&profiles, DVec3::Z, [3, 1]);
    let holes: Vec<bool> = map.heights.values().iter().map(|h| h.is_nan()).collect();
    assert_eq!(holes, [false, true, true, true, false, true]);
    assert_eq!(map.heights[(1, 1)], 2e-3);
    assert!((map.holes() - 4.0 / 6.0).abs() < 1e-15);
    let quantised = QuantisedGrid::new(&map.heights).unwrap();
    let integers = quantised.integers.values();
    assert_eq!(integers, [1, 0, 0, 0, u16::MAX, 0], "holes are 0");
    for (&integer, &height) in integers.iter().zip(map.heights.values()) {
        let back = quantised.offset + quantised.scale * f64::from(integer);
        // Half a step of 1 mm / 65534, and the rounding of f32.
        assert!(
            height.is_nan() || (back - f64::from(height)).abs() < 0.8e-8,
            "{back}"
        );
    }
}

#[test]
fn where_nothing_is_valid_there_is_no_height_and_no_scale() {
    let profiles = [vec![], vec![doubtful(2, 5e-3 * DVec3::Z)]];
    let map = HeightMap::of_profiles(&profiles, DVec3::Z, [3, 1]);
    assert_eq!(map.holes(), 1.0);
    assert_eq!(map.range(), None);
    assert_eq!(QuantisedGrid::new(&map.heights), None);
}

#[test]
fn equal_values_are_quantised_exactly() {
    let flat = QuantisedGrid::new(&Grid::filled(2, 1, 0.25)).unwrap();
    assert_eq!(flat.integers.values(), [1, 1]);
    assert_eq!(flat.offset + flat.scale, 0.25);
}

#[test]
fn a_map_of_the_part_has_square_cells() {
    let at = |x: f64, y: f64, z: f64| point(0, 1e-3 * DVec3::new(x, y, z));
    let profiles = [
        vec![at(0.0, 0.0, 1.0), at(0.4, 0.3, 3.0)],
        vec![at(2.2, 0.8, 7.0)],
    ];
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let map = HeightMap::of_points(&profiles, axes, 1e-3).unwrap();
    assert_eq!((map.heights.width(), map.heights.height()), (3, 2));
    assert_eq!(map.heights[(0, 0)], 2e-3, "the mean of two");
    assert_eq!(map.heights[(2, 1)], 7e-3);
    assert!((map.holes() - 4.0 / 6.0).abs() < 1e-15);
    assert!(
        HeightMap::of_points(&profiles, axes, 1e-12).is_err(),
        "too fine"
    );
    assert!(HeightMap::of_points(&[], axes, 1e-3).is_err(), "nothing");
    for pitch in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = HeightMap::of_points(&profiles, axes, pitch);
        assert!(refused.is_err(), "{pitch}");
    }
}

/// Profiles that are a whole number of parts of a pitch apart fall into rows evenly, wherever the part
/// stands and however their places were rounded.
#[test]
fn rows_of_a_map_have_equally_many_profiles() {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for (step, count) in [
        (3e-4, 30),
        (1e-4, 200),
        (2.2e-4, 61),
        (1e-3 / 3.0, 97),
        (7e-6, 1000),
    ] {
        for offset in [0.0, -4.35e-3, 0.1, -1.0 / 3.0] {
            let sum = |k: usize| (0..k).fold(offset, |y, _| y + step);
            let roundings: [&dyn Fn(usize) -> f64; 3] = [
                &|k| offset + k as f64 * step,
                &|k| offset - (count - 1 - k) as f64 * step,
                &sum,
            ];
            let ways = roundings
                .iter()
                .flat_map(|place| [1, 2, 3].map(|steps| (place, steps)));
            for (place, steps) in ways {
                let at = |k| vec![point(0, DVec3::new(0.0, place(k), k as f64))];
                let profiles: Vec<_> = (0..count).map(at).collect();
                let map = HeightMap::of_points(&profiles, axes, step * steps as f64).unwrap();
                // The first row begins half a pitch below the first profile.
                let row = |k: usize| (2 * k + steps) / (2 * steps);
                let rows = row(count - 1) + 1;
                let mean = |r| {
                    let of_row: Vec<usize> = (0..count).filter(|&k| row(k) == r).collect();
                    of_row.iter().sum::<usize>() as f32 / of_row.len() as f32
                };
                let expected: Vec<f32> = (0..rows).map(mean).collect();
                assert_eq!(map.heights.values(), expected, "{step} m from {offset} m");
            }
        }
    }
}

#[test]
fn point_clouds_are_read_by_another_program() {
    let position = DVec3::new(1e-3, -2e-3, 0.123_456_789_012_345);
    let profiles = [vec![], vec![point(4, position), doubtful(5, DVec3::ONE)]];
    let mut file = Vec::new();
    write_ply(&profiles, &mut file).unwrap();
    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut file.as_slice())
        .unwrap();
    let [vertex] = &ply.payload["vertex"][..] else {
        panic!("one valid point");
    };
    assert!(matches!(vertex["z"], Property::Double(z) if z == position.z));
    assert!(matches!(vertex["frame"], Property::Int(1)));
    let sigma = 1e-5 * (0.04_f64 + 0.0025 + 0.01).sqrt();
    for name in ["sigma_z", "sigma"] {
        assert!(
            matches!(vertex[name], Property::Float(found) if (f64::from(found) / sigma - 1.0).abs() < 1e-6),
            "{name}: {:?}",
            vertex[name]
        );
    }
}

#[test]
fn a_sensor_that_is_not_possible_is_refused() {
    let mut measured = measured(SCENE);
    measured.sensor = SensorDescription {
        gain: -1.0,
        ..*Sensor::new(measured.sensor).unwrap().description()
    };
    assert!(Measurement::new(measured).is_err(), "a negative gain");
}

/// A plate that the whole line falls on, and beside it a strip of 50 µm, a pixel in the image.
fn frame_with_slivers() -> MeasuredFrame {
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
    let measurement = Measurement::new(measured).unwrap();
    let cancel = AtomicBool::new(false);
    measurement.measure(None, 0, |_| (), &cancel).unwrap()
}

#[test]
fn slivers_of_a_line_are_no_places_of_the_line() {
    let points = frame_with_slivers().points;
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
