use tem00_testkit::{assert_relative, refuses};

use super::*;
use crate::SensorDescription;

/// A 25 mm lens at f/8 that looks from 300 mm at 30°, at a line of 0.2 mm.
pub(crate) fn description() -> SetupDescription {
    let mut description = SetupDescription::default();
    description.sensor.quantum_efficiency = 0.6;
    description.sensor.exposure_time = 0.1e-3;
    description.detector.min_peak = 1.0;
    description.calibration_uncertainty = 1e-6;
    description
}

/// Returns the set-up of the description with changes.
pub(crate) fn setup_of(change: impl Fn(&mut SetupDescription)) -> Setup {
    let mut description = description();
    change(&mut description);
    Setup::new(description).unwrap()
}

fn setup() -> Setup {
    setup_of(|_| ())
}

fn scheimpflug() -> Setup {
    setup_of(|d| d.camera.scheimpflug = true)
}

#[test]
fn a_tilted_sensor_has_the_laser_plane_in_focus() {
    let (_, normal) = scheimpflug().camera().plane_in_focus();
    // The plane y = 0, to rounding; either side of it may count as its front.
    assert!((normal.dot(DVec3::Y).abs() - 1.0).abs() < 1e-12, "{normal}");
    for height in [-5e-3, 0.0, 5e-3] {
        let line = scheimpflug().line_at(height).unwrap();
        // A hundred roundings of 1/Z = 3.3 /m, times D s = 8.5e−5 m² in pixels of 3.45 µm.
        assert!(line.blur < 1e-11, "{height}: {}", line.blur);
    }
}

#[test]
fn the_height_per_pixel_is_that_of_the_pinhole() {
    let (sin, cos) = (0.5, 0.75_f64.sqrt());
    let (distance, focal) = (0.3, 25e-3_f64);
    let principal = focal * distance / (distance - focal);
    for height in [-4e-3, 0.0, 6e-3] {
        let line = setup().line_at(height).unwrap();
        // y = s z sin θ / (L − z cos θ), so dy/dz = s sin θ L / (L − z cos θ)².
        let depth: f64 = distance - height * cos;
        let slope = principal * sin * distance / (depth * depth) / 3.45e-6;
        // Central differences of 1e−5 L err by its square.
        assert_relative(line.height_per_pixel, 1.0 / slope, 1e-9);
    }
    assert_relative(setup().magnification(), principal / distance, 1e-12);
}

#[test]
fn heights_come_back_from_the_positions_of_the_line() {
    for setup in [setup(), scheimpflug()] {
        for height in [-4e-3, 0.0, 6e-3] {
            let line = setup.line_at(height).unwrap();
            let back = setup.height_at(line.position).unwrap();
            // A few roundings of the camera's distance.
            assert!((back - height).abs() < 1e-14, "{height}: {back}");
        }
    }
}

#[test]
fn light_through_the_pupil_frees_the_electrons_of_a_column() {
    let (line, d) = (setup().line().clone(), description());
    // What a strip of one pixel along the line scatters into the solid angle of the pupil.
    let strip = d.sensor.pixel_pitch / setup().magnification();
    let scattered = d.laser.power / d.laser.line_length * strip * d.surface.reflectance;
    let pupil = core::f64::consts::PI * (0.5_f64 * 25e-3 / 8.0).powi(2);
    let cosine = d.camera.angle.cos();
    let power = scattered * cosine / core::f64::consts::PI * pupil / (0.3 * 0.3);
    let photon = 6.626_070_15e-34 * 299_792_458.0 / d.laser.light.wavelength;
    let electrons = power * d.sensor.exposure_time / photon * d.sensor.quantum_efficiency;
    // The width of the line in perspective differs by (W/2L)² from the first-order one.
    assert_relative(line.column_electrons, electrons, 1e-6);
    let pixels: f64 = (-200..200)
        .map(|y| line.pixel_electrons(f64::from(y), 0.3))
        .sum();
    // Beyond are the wings of the lens, 4h/(π³ Y), to 3σ²/Y² of them.
    let wings = 4.0 * line.speckle_size[1] / (core::f64::consts::PI.powi(3) * 200.0);
    let inside = (1.0 - wings) * line.column_electrons;
    assert_relative(pixels, inside, 1e-6);
}

#[test]
fn the_line_is_as_wide_as_its_projection_the_lens_and_defocus_make_it() {
    let line = setup().line().clone();
    let magnification = setup().magnification();
    let flat = magnification * 0.2e-3 * 0.75_f64.sqrt() / 3.45e-6;
    // To second order in W/L = 7e−4.
    assert_relative(line.projected_thickness, flat, 1e-6);
    let speckle = 650e-9 * 8.0 * (1.0 + magnification) / 3.45e-6;
    assert_relative(line.speckle_size[0], speckle, 1e-12);
    assert_relative(line.speckle_size[1], speckle, 1e-12);
    // 1 − v²/4 of [2 J₁(v)/v]² with v = π r/h equals 1 − r²/2σ² for σ = √2 h/π.
    let airy = 4.0 * core::f64::consts::SQRT_2 * speckle / core::f64::consts::PI;
    assert_relative(line.diffraction_width, airy, 1e-12);
    assert!(
        line.blur < 1e-9,
        "in focus at the reference plane: {}",
        line.blur
    );
}

#[test]
fn at_the_ends_of_the_depth_of_field_the_line_is_wider_by_a_root_of_two() {
    let setup = setup();
    let in_focus = setup.line().width * 3.45e-6;
    let range = setup.depth_of_field();
    for height in [range.low, range.high] {
        let blur = setup.line_at(height).unwrap().blur * 3.45e-6;
        assert_relative(blur, in_focus, 1e-9);
    }
    let smaller = setup_of(|d| d.camera.f_number = 16.0).depth_of_field();
    assert!(
        smaller.length() > 2.0 * range.length(),
        "{smaller:?}, {range:?}"
    );
}

#[test]
fn a_line_that_is_all_in_focus_is_measured_where_it_has_spread_by_a_root_of_two() {
    let setup = scheimpflug();
    let d = setup.description();
    let HeightRange { low, high } = setup.depth_of_field();
    let waist = 0.5 * d.laser.line_thickness;
    let rayleigh_range = core::f64::consts::PI * waist * waist / 650e-9;
    assert_relative(high, rayleigh_range, 1e-12);
    assert_relative(low, -high, 1e-15);
    let row = |beside: f64| {
        let point = DVec3::new(0.0, beside, high);
        setup.camera().project(point).unwrap().y
    };
    let spread = core::f64::consts::SQRT_2 * waist;
    let width = row(-spread) - row(spread);
    let line = setup.line_at(high).unwrap();
    assert_relative(line.projected_thickness, width.abs(), 1e-9);
    // The light is the same.
    let electrons = line.column_electrons / setup.line().column_electrons;
    assert!((0.9..1.1).contains(&electrons), "{electrons}");
}

#[test]
fn a_line_on_a_leaning_plane_is_blurred_by_its_depth() {
    let setup = setup_of(|d| (d.laser.offset, d.laser.tilt) = (2e-3, 0.1));
    let camera = setup.camera();
    let disc = |height: f64| {
        let point = DVec3::new(0.0, 2e-3 + height * libm::tan(0.1), height);
        let depth = (point - camera.position()).dot(-camera.position().normalize());
        let vergence = (depth.recip() - 0.3_f64.recip()).abs();
        camera.pupil_diameter() * camera.image_distance() * vergence
    };
    for height in [-4e-3, 0.0, 5e-3] {
        let blur = setup.line_at(height).unwrap().blur * 3.45e-6;
        assert_relative(blur, disc(height), 1e-9);
    }
    let width = setup.line().width * 3.45e-6;
    let range = setup.depth_of_field();
    for height in [range.low, range.high] {
        assert_relative(disc(height), width, 1e-9);
    }
}

/// The set-up with a laser that leans, by degrees, and stands next to the axis, at an angle of the
/// camera.
fn leaning(tilt: f64, offset: f64, angle: f64, scheimpflug: bool) -> Setup {
    setup_of(|d| {
        (d.laser.tilt, d.laser.offset) = (tilt.to_radians(), offset);
        (d.camera.angle, d.camera.scheimpflug) = (angle.to_radians(), scheimpflug);
    })
}

#[test]
fn a_leaning_laser_is_seen_under_the_sum_of_both_angles() {
    let pairs = [
        (20.0, 30.0_f64),
        (-20.0, 30.0),
        (-40.0, 30.0),
        (40.0, 60.0),
        (44.0, 80.0),
    ];
    for (tilt, angle) in pairs {
        let found = leaning(tilt, 0.0, angle, false).line().height_per_pixel;
        let magnification = setup().magnification();
        let [theta, tau] = [angle.to_radians(), tilt.to_radians()];
        let expected = 3.45e-6 / magnification * tau.cos() / (theta + tau).sin();
        // Central differences of 1e−5 L err by its square.
        assert_relative(found, expected, 1e-8);
    }
    // As the data sheet of 75.9 µm per pixel at 30° under a laser that leans by 20°.
    let ratio =
        leaning(20.0, 0.0, 30.0, false).line().height_per_pixel / setup().line().height_per_pixel;
    assert_relative(75.9 * ratio, 46.55, 1e-3);
}

#[test]
fn a_sensor_after_scheimpflug_has_a_leaning_laser_in_focus_if_it_stands_on_the_axis() {
    for (tilt, angle) in [(20.0, 30.0), (-20.0, 30.0), (-40.0, 30.0), (40.0, 60.0)] {
        let setup = leaning(tilt, 0.0, angle, true);
        for height in [-5e-3, 0.0, 5e-3] {
            let blur = setup.line_at(height).unwrap().blur;
            assert!(blur < 1e-11, "{tilt}°, {angle}°, {height}: {blur}");
        }
    }
    // Off the axis the image of the depth at which the range of the lens ends is blurred by the
    // width of the line.
    for (tilt, offset, angle) in [(0.0, 20e-3, 30.0), (0.0, -15e-3, 30.0), (10.0, 30e-3, 40.0)] {
        let mut description = leaning(tilt, offset, angle, true).description().clone();
        description.camera.f_number = 2.0;
        // A line that spreads later than the lens.
        description.laser.line_thickness = 0.6e-3;
        let setup = Setup::new(description).unwrap();
        let HeightRange { high, .. } = setup.lens_range();
        let blur = setup.line_at(high).unwrap().blur;
        assert_relative(blur, setup.line().width, 1e-9);
        assert!(
            setup.line_at(0.9 * high).unwrap().blur < blur,
            "{tilt}°, {offset} m"
        );
    }
}

#[test]
fn ranges_of_leaning_lasers_are_not_empty() {
    for (tilt, angle) in [(-40.0, 30.0), (40.0, 60.0), (-20.0, 10.0), (44.0, 85.0)] {
        for scheimpflug in [false, true] {
            let setup = leaning(tilt, 0.0, angle, scheimpflug);
            let ranges = [
                setup.seen_range(),
                setup.lens_range(),
                setup.measuring_range(),
            ];
            for range in ranges {
                let holds = range.low < 0.0 && range.high > 0.0;
                assert!(holds, "{tilt}°, {angle}°: {range:?}");
            }
        }
    }
}

#[test]
fn the_measuring_range_is_seen_with_half_a_window_about_it() {
    for setup in [setup(), scheimpflug()] {
        let HeightRange { low, high } = setup.seen_range();
        let [top, bottom] = [high, low].map(|height| setup.line_at(height).unwrap().position);
        assert_relative(top, 15.5, 1e-10);
        assert_relative(bottom, 464.5, 1e-10);
        let range = setup.measuring_range();
        let is_seen = range.low >= low && range.high <= high;
        assert!(is_seen && range.length() > 0.0, "{range:?}");
    }
}

#[test]
fn a_chosen_exposure_leaves_room_for_bright_grains_and_not_much_more() {
    let mut chosen = 0;
    for (f_number, power, bits) in [
        (2.8, 5e-3, 12),
        (8.0, 5e-3, 10),
        (11.0, 1.0, 8),
        (5.6, 1e-6, 12),
    ] {
        let setup = setup_of(|d| {
            (d.camera.f_number, d.laser.power) = (f_number, power);
            d.sensor = SensorDescription::typical(bits);
            d.sensor.exposure_time = f64::NAN;
            d.auto_exposure = true;
        });
        // Grains three standard deviations above the mean, as drawn by nobody: in electrons, and in
        // DN.
        let d = setup.description().sensor;
        let dark = d.dark_current * d.exposure_time;
        let mean = setup.line().pixel_electrons(-0.5, 0.0);
        let grains = dark + mean * (1.0 + 3.0 * setup.contrast());
        let full = f64::from((1_u32 << bits) - 1);
        let part = (grains / d.full_well).max((d.black_level + d.gain * grains) / full);
        // Rounding down to two digits takes a tenth at most.
        assert!(
            part <= 0.9 && part > 0.9 * 0.9 - 0.1 / 64.0,
            "f/{f_number}: {part}"
        );
        if setup.light_level() == LightLevel::Good {
            chosen += 1;
        }
        // What was chosen is a time like any other.
        let mut fixed = setup.description().clone();
        fixed.auto_exposure = false;
        assert_eq!(Setup::new(fixed).unwrap().line(), setup.line());
        let milliseconds: f64 = format!("{:.1e}", 1e3 * d.exposure_time).parse().unwrap();
        let two_digits = (milliseconds / 1e3).to_bits();
        assert_eq!(d.exposure_time.to_bits(), two_digits, "{milliseconds} ms");
    }
    assert!(chosen >= 3, "{chosen} of them are good");
}

#[test]
fn each_quantity_is_the_field_of_its_key_in_values_and_in_text() {
    // Each gets its own number, in the order of the table.
    let mut d = description();
    for (quantity, number) in SetupQuantity::ALL.iter().zip(1_u32..) {
        quantity.set(&mut d, 1e-7 * f64::from(number));
    }
    let below = d.surface.subsurface;
    let fields = [
        ("laser.wavelength", d.laser.light.wavelength),
        ("laser.linewidth", d.laser.light.linewidth),
        ("laser.source_half_angle", d.laser.light.source_half_angle),
        ("laser.power", d.laser.power),
        ("laser.line_thickness", d.laser.line_thickness),
        ("laser.line_length", d.laser.line_length),
        ("laser.offset", d.laser.offset),
        ("laser.tilt", d.laser.tilt),
        ("camera.focal_length", d.camera.focal_length),
        ("camera.f_number", d.camera.f_number),
        ("camera.pixel_pitch", d.sensor.pixel_pitch),
        ("camera.distance", d.camera.distance),
        ("camera.angle", d.camera.angle),
        ("camera.principal_row", d.camera.principal_row.unwrap()),
        ("sensor.quantum_efficiency", d.sensor.quantum_efficiency),
        ("sensor.exposure", d.sensor.exposure_time),
        ("sensor.full_well", d.sensor.full_well),
        ("sensor.black_level", d.sensor.black_level),
        ("sensor.gain", d.sensor.gain),
        ("sensor.dark_noise", d.sensor.dark_noise),
        ("sensor.dark_current", d.sensor.dark_current),
        ("sensor.prnu", d.sensor.prnu),
        ("sensor.dsnu", d.sensor.dsnu),
        ("sensor.fill_factor", d.sensor.fill_factor),
        ("surface.reflectance", d.surface.reflectance),
        ("surface.polarisation", d.surface.polarisation),
        ("surface.rms_height", d.surface.relief.rms_height),
        (
            "surface.correlation_length",
            d.surface.relief.correlation_length,
        ),
        ("surface.transport_length", below.transport_length),
        ("surface.absorption", below.absorption),
        ("surface.refractive_index", below.refractive_index),
        ("surface.anisotropy", below.anisotropy),
        ("surface.boundary_slope", below.boundary_slope),
        ("surface.surface_fraction", below.surface_fraction),
        (
            "environment.temperature_change",
            d.environment.temperature_change,
        ),
        ("environment.base_expansion", d.environment.base_expansion),
        ("environment.mount_expansion", d.environment.mount_expansion),
    ];
    assert_eq!(fields.len(), SetupQuantity::ALL.len(), "all of them");
    let text = d.to_toml();
    for ((&quantity, (path, value)), number) in SetupQuantity::ALL.iter().zip(fields).zip(1_u32..) {
        assert_eq!(quantity.to_string(), path, "the order of a file");
        let expected = 1e-7 * f64::from(number);
        let found = [value, quantity.value_in(&d)].map(f64::to_bits);
        assert_eq!(found, [expected.to_bits(); 2], "{path}");
        let (key, unit) = (quantity.key(), quantity.unit());
        let line = format!("{key} = {}", unit.dimension.text(value, unit.symbol));
        let is_written = text.lines().any(|found| found.starts_with(&line));
        assert!(is_written, "{line} in\n{text}");
    }
}

#[test]
fn quantities_outside_their_ranges_are_refused_by_key() {
    for &quantity in SetupQuantity::ALL {
        for bad in [-1e9, f64::NAN, f64::INFINITY] {
            let mut description = description();
            quantity.set(&mut description, bad);
            let error = Setup::new(description).unwrap_err();
            assert_eq!(error.parameter(), Some(quantity.key()), "{error}");
        }
    }
    refuses!(d = description() => Setup::new(d);
        d.laser.power: [0.0],
        d.laser.line_thickness: [20e-3],
        d.laser.line_length: [0.1e-3],
        d.camera.f_number: [0.1, 900.0],
        d.camera.distance: [25e-3],
        d.camera.angle: [0.0],
        d.surface.reflectance: [1.1],
        d.surface.patterns: [0],
        d.calibration_uncertainty as "uncertainty": [f64::NAN],
        d.average.columns: [0, 641],
        d.average.frames: [0],
    );
}
