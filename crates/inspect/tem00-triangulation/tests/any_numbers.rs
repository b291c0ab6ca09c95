//! Whatever numbers they are given, constructors refuse them by name or give something that works.

use core::sync::atomic::AtomicBool;

use tem00_testkit::refuses;
use tem00_triangulation::{
    Budget, DVec3, Dorsch, LaserPlane, LineImage, LineImageData, LineMethod, Setup,
    SetupDescription, SetupQuantity, SimulationOptions, UncertaintySource, simulate,
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
    let mut description = SetupDescription::default();
    description.camera.resolution = [64, 64];
    description.camera.angle = 0.5;
    // The line fills a quarter of the range.
    description.sensor.exposure_time = 0.1e-3;
    description.detector.min_peak = 1.0;
    description.calibration_uncertainty = 1e-6;
    description
}

type Change = fn(&mut SetupDescription, f64);

/// Numbers of a description that are no quantities.
const OTHERS: [(&str, Change); 4] = [
    ("uncertainty", |d, value| d.calibration_uncertainty = value),
    ("min_peak", |d, value| d.detector.min_peak = value),
    ("saturation", |d, value| d.detector.saturation = value),
    ("threshold", |d, threshold| {
        d.detector.method = LineMethod::ThresholdedCentreOfGravity { threshold };
    }),
];

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
    let is_number = |u: &f64| u.is_finite() && *u >= 0.0;
    assert!(
        terms.iter().chain(&all).all(is_number),
        "{what}: {budget:?}"
    );
    // Trials take long: where grey values may leave their range they are worth it.
    let clips = |name: &&str| what.starts_with(name);
    if !["gain", "full_well", "saturation"].iter().any(clips) {
        return;
    }
    let options = SimulationOptions {
        trials: 10,
        seed: 1,
    };
    if let Ok(simulation) = simulate(setup, options, &|_| (), &AtomicBool::new(false))
        && let Some(total) = simulation.total
    {
        let found = [total.uncertainty, total.standard_error];
        assert!(found.iter().all(|u| u.is_finite()), "{what}: {total:?}");
    }
}

#[test]
fn setups_with_strange_numbers_are_refused_by_name_or_work() {
    let mut refused = 0;
    let mut hold = |name: &str, change: &dyn Fn(&mut SetupDescription, f64)| {
        for strange in STRANGE {
            let mut description = description();
            description.auto_exposure = name != "exposure" && strange.abs() >= 1.0;
            change(&mut description, strange);
            match Setup::new(description) {
                Ok(setup) => exercise(&setup, &format!("{name} = {strange:e}")),
                Err(error) => {
                    refused += 1;
                    let named = !strange.is_nan() || error.to_string().contains(name);
                    assert!(named, "{name} must be a number: {error}");
                }
            }
        }
    };
    for quantity in SetupQuantity::ALL {
        hold(quantity.key(), &|d, value| quantity.set(d, value));
    }
    for (name, change) in OTHERS {
        hold(name, &change);
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
    refuses!(d = description() => Setup::new(d);
        d.camera.resolution as "columns": [[0, 128]],
        d.camera.resolution: [[64, 0], [usize::MAX; 2]],
        d.surface.patterns: [0],
        d.average.columns: [0, u32::MAX],
        d.average.frames: [0],
        d.detector.window: [0, usize::MAX],
        d.detector.max_lines: [0],
        d.sensor.bit_depth as "black_level": [0],
        d.sensor.bit_depth: [u32::MAX],
    );
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
            if let Ok(deviation) = dorsch.distance_deviation() {
                assert!(deviation >= 0.0, "{dorsch:?}");
            }
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
                let frame = image.speckled(1, |_| 4.0).unwrap();
                let finite = frame.values().iter().all(|v| v.is_finite());
                assert!(finite, "{:?}", image.data());
            }
        }
    }
}
