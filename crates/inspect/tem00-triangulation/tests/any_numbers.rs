//! Whatever numbers they are given, constructors refuse them by name or give something that works.

use core::sync::atomic::AtomicBool;

use tem00_triangulation::{
    Averages, Budget, DVec3, DetectorSettings, Dorsch, LaserLight, LaserLineData, LaserPlane,
    LineImage, LineImageData, LineMethod, Relief, SensorDescription, Setup, SetupCamera,
    SetupDescription, SetupEnvironment, SetupSurface, SimulationOptions, UncertaintySource,
    simulate,
};

/// Numbers that nobody thinks of.
const STRANGE: [f64; 14] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    -0.0,
    0.0,
    -1.0,
    1.0,
    1e-12,
    1e6,
    1e18,
];

fn description() -> SetupDescription {
    SetupDescription {
        laser: LaserLineData {
            light: LaserLight::monochromatic(650e-9),
            power: 5e-3,
            line_thickness: 0.2e-3,
            line_length: 50e-3,
            offset: 0.0,
            tilt: 0.0,
        },
        camera: SetupCamera {
            focal_length: 25e-3,
            f_number: 8.0,
            resolution: [64, 64],
            distance: 0.3,
            angle: 0.5,
            principal_row: None,
            scheimpflug: false,
        },
        sensor: SensorDescription {
            // The line fills a quarter of the range.
            exposure_time: 0.1e-3,
            ..SensorDescription::typical(12)
        },
        auto_exposure: false,
        surface: SetupSurface {
            reflectance: 0.5,
            patterns: 1,
            polarisation: 1.0,
            relief: Relief::default(),
        },
        detector: DetectorSettings {
            min_peak: 1.0,
            ..DetectorSettings::default()
        },
        calibration_uncertainty: 1e-6,
        environment: SetupEnvironment::default(),
        average: Averages::default(),
    }
}

/// A number in a description.
type Field = fn(&mut SetupDescription) -> &mut f64;

const FIELDS: [(&str, Field); 28] = [
    ("wavelength", |d| &mut d.laser.light.wavelength),
    ("linewidth", |d| &mut d.laser.light.linewidth),
    ("power", |d| &mut d.laser.power),
    ("line_thickness", |d| &mut d.laser.line_thickness),
    ("line_length", |d| &mut d.laser.line_length),
    ("focal_length", |d| &mut d.camera.focal_length),
    ("f_number", |d| &mut d.camera.f_number),
    ("distance", |d| &mut d.camera.distance),
    ("angle", |d| &mut d.camera.angle),
    ("reflectance", |d| &mut d.surface.reflectance),
    ("polarisation", |d| &mut d.surface.polarisation),
    ("rms_height", |d| &mut d.surface.relief.rms_height),
    ("correlation_length", |d| {
        &mut d.surface.relief.correlation_length
    }),
    ("uncertainty", |d| &mut d.calibration_uncertainty),
    ("quantum_efficiency", |d| &mut d.sensor.quantum_efficiency),
    ("gain", |d| &mut d.sensor.gain),
    ("dark_noise", |d| &mut d.sensor.dark_noise),
    ("dark_current", |d| &mut d.sensor.dark_current),
    ("full_well", |d| &mut d.sensor.full_well),
    ("prnu", |d| &mut d.sensor.prnu),
    ("dsnu", |d| &mut d.sensor.dsnu),
    ("black_level", |d| &mut d.sensor.black_level),
    ("pixel_pitch", |d| &mut d.sensor.pixel_pitch),
    ("fill_factor", |d| &mut d.sensor.fill_factor),
    ("exposure_time", |d| &mut d.sensor.exposure_time),
    ("min_peak", |d| &mut d.detector.min_peak),
    ("saturation", |d| &mut d.detector.saturation),
    ("threshold", threshold),
];

/// The threshold of a centre of gravity that has one.
fn threshold(description: &mut SetupDescription) -> &mut f64 {
    let method = &mut description.detector.method;
    if !matches!(method, LineMethod::ThresholdedCentreOfGravity { .. }) {
        *method = LineMethod::ThresholdedCentreOfGravity { threshold: 0.0 };
    }
    match method {
        LineMethod::ThresholdedCentreOfGravity { threshold } => threshold,
        _ => unreachable!("it was made one"),
    }
}

/// Asks a set-up everything and holds the answers to be numbers.
fn exercise(setup: &Setup, what: &str) {
    let line = setup.line();
    for number in [
        line.width,
        line.peak_irradiance,
        line.column_electrons,
        line.height_per_pixel,
        setup.contrast(),
        setup.saturation(),
        setup.field_width(),
        setup.measuring_range().length(),
    ] {
        assert!(number.is_finite(), "{what}: {line:?}");
    }
    let _ = setup.light_level();
    let Ok(budget) = Budget::new(setup) else {
        return;
    };
    let terms = UncertaintySource::ALL.map(|source| budget.contribution(source));
    let all = [
        budget.combined(),
        budget.expanded(),
        budget.line_law(),
        budget.dorsch(),
    ];
    assert!(
        terms.iter().chain(&all).all(|u| u.is_finite() && *u >= 0.0),
        "{what}: {budget:?}"
    );
    let options = SimulationOptions {
        trials: 10,
        seed: 1,
    };
    // Trials take long: where grey values may leave their range they are worth it.
    if !["gain", "full_well", "saturation"]
        .iter()
        .any(|name| what.starts_with(name))
    {
        return;
    }
    if let Ok(simulation) = simulate(setup, options, |_| (), &AtomicBool::new(false)) {
        let total = simulation.total();
        assert!(
            total.is_none_or(|total| {
                total.uncertainty.is_finite() && total.standard_error.is_finite()
            }),
            "{what}: {total:?}"
        );
    }
}

#[test]
fn setups_with_strange_numbers_are_refused_by_name_or_work() {
    let mut refused = 0;
    for (name, field) in FIELDS {
        for strange in STRANGE {
            let mut description = description();
            description.auto_exposure = name != "exposure_time" && strange.abs() >= 1.0;
            *field(&mut description) = strange;
            match Setup::new(description) {
                Ok(setup) => exercise(&setup, &format!("{name} = {strange:e}")),
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().is_empty(), "{name} = {strange:e}");
                }
            }
        }
        let mut description = description();
        *field(&mut description) = f64::NAN;
        let error = Setup::new(description)
            .map(|_| ())
            .map_err(|e| e.to_string());
        assert!(
            error.as_ref().is_err_and(|error| error.contains(name)),
            "{name} must be a number: {error:?}"
        );
    }
    assert!(refused > 200, "only {refused} refused");
}

#[test]
fn strange_heights_have_no_budget_or_a_finite_one() {
    for scheimpflug in [false, true] {
        let mut description = description();
        description.camera.scheimpflug = scheimpflug;
        let setup = Setup::new(description).expect("a set-up");
        for height in STRANGE {
            if let Some(line) = setup.line_at(height) {
                assert!(line.width.is_finite(), "{height:e}: {line:?}");
            }
            if let Some(found) = setup.height_at(height) {
                assert!(found.is_finite(), "{height:e}: {found}");
            }
            if let Ok(budget) = Budget::at_height(&setup, height) {
                assert!(budget.combined().is_finite(), "{height:e}: {budget:?}");
            }
        }
    }
}

#[test]
fn counts_of_nothing_are_refused() {
    for change in [
        (|d| d.camera.resolution = [0, 128]) as fn(&mut SetupDescription),
        |d| d.camera.resolution = [64, 0],
        |d| d.camera.resolution = [usize::MAX, usize::MAX],
        |d| d.surface.patterns = 0,
        |d| d.average.columns = 0,
        |d| d.average.frames = 0,
        |d| d.average.columns = u32::MAX,
        |d| d.detector.window = 0,
        |d| d.detector.window = usize::MAX,
        |d| d.detector.max_lines = 0,
        |d| d.sensor.bit_depth = 0,
        |d| d.sensor.bit_depth = u32::MAX,
    ] {
        let mut description = description();
        change(&mut description);
        assert!(Setup::new(description.clone()).is_err(), "{description:?}");
    }
}

#[test]
fn pieces_with_strange_numbers_are_refused_or_work() {
    for a in STRANGE {
        for b in STRANGE {
            let vectors = [DVec3::new(a, b, 0.0), DVec3::new(b, 1.0, a)];
            if let Ok(plane) = LaserPlane::new(vectors[0], vectors[1]) {
                assert!(plane.normal().is_normalized(), "{plane:?}");
            }
            let dorsch = Dorsch {
                wavelength: a,
                contrast: 1.0,
                aperture_angle: b,
                triangulation_angle: 0.5,
            };
            let deviation = dorsch.distance_deviation();
            assert!(
                deviation.as_ref().is_ok_and(|d| *d >= 0.0) || deviation.is_err(),
                "{dorsch:?}"
            );
            let image = LineImage::new(LineImageData {
                size: [8, 8],
                width: a,
                blur: b,
                column_electrons: 100.0,
                speckle_size: [b, b],
                sensitive_side: 1.0,
                patterns: 1,
                polarisation: 1.0,
            });
            if let Ok(image) = image {
                let frame = image
                    .speckled(1, |_| 4.0)
                    .map(|frame| frame.values().to_vec());
                let finite = frame.is_ok_and(|values| values.iter().all(|v| v.is_finite()));
                assert!(finite, "{:?}", image.data());
            }
        }
    }
}
