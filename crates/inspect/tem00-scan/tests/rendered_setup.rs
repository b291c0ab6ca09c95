//! Image predicted by a set-up, against the path tracer's rendering of its scene.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::{f64::consts::PI, sync::atomic::AtomicBool};

use tem00_calibration::CalibrationSettings;
use tem00_engine::{SpeckleModel, SpecklePlan, render_frame};
use tem00_numerics::cast::to_usize;
use tem00_scan::{Measurement, MeasurementScene, ScanSettings, setup_scene};
use tem00_testkit::assert_relative;
use tem00_tracer::{Crop, RenderOptions};
use tem00_triangulation::{Budget, DVec2, DVec3, Setup, parse_setup};

fn setup(scheimpflug: bool, plane: &str) -> Setup {
    let text = format!(
        r#"
        laser = {{ wavelength = "650 nm", power = "5 mW", line_thickness = "0.4 mm", line_length = "50 mm"{plane} }}
        surface = {{ reflectance = 0.5 }}
        sensor = {{ quantum_efficiency = 0.6, exposure = "0.1 ms" }}
        [camera]
        focal_length = "25 mm"
        f_number = 4
        pixel_pitch = "3.45 um"
        resolution = [640, 480]
        distance = "200 mm"
        angle = "35 deg"
        scheimpflug = {scheimpflug}
        "#
    );
    parse_setup(&text).expect("a set-up")
}

/// The line as rendered in the middle columns: the electrons of a column, the position and the full
/// width.
fn rendered(setup: &Setup, height: f64) -> [f64; 3] {
    const COLUMNS: usize = 24;
    let line = setup.line_at(height).expect("the line is seen");
    let scene = setup_scene(setup, height).expect("a scene");
    let top = (line.position - 30.0).max(0.0).floor();
    let crop = Crop {
        x: 320 - COLUMNS / 2,
        y: to_usize(top),
        width: COLUMNS,
        height: 60,
    };
    let options = RenderOptions {
        samples_per_pixel: 256,
        crop: Some(crop),
        ..RenderOptions::default()
    };
    let frame = render_frame(&scene, None, 0, &options, &|_| (), &AtomicBool::new(false));
    let frame = frame.expect("it renders");
    let [mut sum, mut first, mut second] = [0.0; 3];
    for (row, y) in frame.lasers[0].single.rows().zip(0_u32..) {
        let position = top + f64::from(y) + 0.5;
        let radiance: f64 = row.iter().map(|&value| f64::from(value)).sum();
        let pixel = DVec2::new(320.0, position);
        let irradiance = radiance * scene.camera.irradiance_per_radiance(pixel) / COLUMNS as f64;
        let electrons = setup.sensor().electrons(irradiance, 650e-9);
        sum += electrons;
        first += electrons * position;
        second += electrons * position * position;
    }
    let position = first / sum;
    [
        sum,
        position,
        4.0 * (second / sum - position * position).sqrt(),
    ]
}

#[test]
fn the_scene_of_a_setup_has_its_camera() {
    for setup in [setup(false, ""), setup(true, "")] {
        let scene = setup_scene(&setup, 1e-3).expect("a scene");
        let point = DVec3::new(1e-3, 0.0, 2e-3);
        let cameras = [setup.camera(), &scene.camera];
        let [ours, theirs] = cameras.map(|camera| camera.project(point).expect("it is seen"));
        let apart = ours.distance(theirs);
        assert!(apart < 1e-9, "{apart}");
    }
}

#[test]
fn a_setup_predicts_what_is_rendered_of_it() {
    // One degree changes lengths by 0.02 %.
    let beside = r#", offset = "2 mm", tilt = "-1 deg""#;
    for (scheimpflug, height, plane) in [
        (false, 0.0, ""),
        (false, 6e-3, ""),
        (true, 6e-3, ""),
        (false, 6e-3, beside),
    ] {
        let setup = setup(scheimpflug, plane);
        let line = setup.line_at(height).expect("the line is seen");
        let [electrons, position, width] = rendered(&setup, height);
        let case = format!("Scheimpflug {scheimpflug}, height {height}{plane}");
        // 256 independent samples in each of 24 · 20 pixels of the line: the rms of their spread, 1
        // or less, by √123000 is 0.3 %. Lattices leave less. The fan spreads from an apex behind
        // the laser, where it is as wide as the beam; at 6 mm its line is 3 % shorter.
        let beam_radius = 0.2e-3_f64 * 1.0_f64.hypot(0.2 * 650e-9 / (PI * 0.2e-3 * 0.2e-3));
        let apex_offset = beam_radius * 0.2 / 25e-3;
        let shorter = 1.0 + (apex_offset - height) / 0.2;
        let ratio = electrons * shorter / line.column_electrons;
        assert!((ratio - 1.0).abs() < 0.003, "{case}: {ratio}");
        // The same samples leave W/4 · 0.3 % of the position. Perspective and, out of focus, the
        // disc across the tilted plate shift the centroid of a line of 0.4 mm by some (W/L) W.
        let shift = position - line.position;
        assert!(shift.abs() < 0.1, "{case}: {shift} pixels");
        // The tracer knows no diffraction, a pixel widens σ² by 1/12, and 1 % is chance. The waist
        // of the laser's line is at the height 0, 3 % wider it is at no height here.
        let pixel = 4.0 / 12.0_f64.sqrt();
        let expected = line.projected_thickness.hypot(line.blur).hypot(pixel);
        assert_relative(width, expected, 0.02);
    }
}

#[test]
fn a_frame_out_of_focus_says_how_much_more_speckle_noise_a_camera_sees() {
    let setup = parse_setup(
        r#"
        laser = { wavelength = "520 nm", power = "8 mW", line_thickness = "0.15 mm", line_length = "60 mm" }
        surface = { reflectance = 0.35 }
        sensor = { quantum_efficiency = 0.55, exposure = "auto" }
        detector = { window = 31 }
        [camera]
        focal_length = "16 mm"
        f_number = 5.6
        pixel_pitch = "4.8 um"
        resolution = [320, 300]
        distance = "110 mm"
        angle = "32 deg"
        "#,
    )
    .expect("a set-up");
    for (height, expected) in [(0.0, 1.0..1.1), (5.6e-3, 1.25..1.4)] {
        let mut scene = setup_scene(&setup, height).expect("a scene");
        scene.render.samples_per_pixel = 16;
        let measurement = Measurement::new(MeasurementScene {
            sensor: setup.description().sensor,
            detector: *setup.detector().settings(),
            calibration: CalibrationSettings::default(),
            scan: ScanSettings::default(),
            scene,
        })
        .expect("a measurement");
        let scene = measurement.scene();
        let plan = SpecklePlan::new(scene, 1).expect("a plan");
        let speckle = SpeckleModel::generate(scene, &plan).expect("speckle");
        let frame = measurement.measure(Some(&speckle), 0, &|_| (), &AtomicBool::new(false));
        let frame = frame.expect("a frame");
        let ratio = measurement.speckle_by_waves(&frame).expect("a ratio");
        assert!(expected.contains(&ratio), "{height}: {ratio}");
        // The budget is held to sums of waves.
        let budget = Budget::at_height(&setup, height).expect("a budget");
        let by_waves = budget.terms()[0].uncertainty;
        let middle = &frame.points[frame.points.len() / 2];
        let stated = middle.noise.speckle.sqrt();
        // The law for all of the light, and a line whose width is measured under speckle.
        assert_relative(ratio * stated, by_waves, 0.06);
    }
}
