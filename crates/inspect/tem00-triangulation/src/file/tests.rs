use tem00_testkit::rows;

use crate::{
    FilterOrder, LaserLight, LineMethod, LineShape, Setup, SetupDescription, Spectrum, parse_setup,
    setup::tests::description,
};

/// A set-up file with all keys, in SI units.
const SETUP: &str = r#"[laser]
wavelength = 6.5e-7
power = 0.005
line_thickness = 2e-4
line_length = 0.05

[camera]
focal_length = 0.025
f_number = 8
pixel_pitch = 3.45e-6
resolution = [640, 480]
distance = 0.3
angle = 0.5235987755982988
scheimpflug = false

[sensor]
quantum_efficiency = 0.6
exposure = 1e-4
bit_depth = 12
gain = 0.3839047619047619
black_level = 64
full_well = 10500
dark_noise = 2.3
dark_current = 3
prnu = 0.005
dsnu = 1
fill_factor = 1
serial_number = 0

[surface]
reflectance = 0.5
patterns = 1
polarisation = 1

[detector]
method = "centre_of_gravity"
window = 31
min_peak = 1
max_lines = 1

[calibration]
uncertainty = 1e-6

[average]
columns = 1
frames = 1
independent_speckle = false
"#;

/// The set-up file with one line instead of another.
fn with(line: &str, instead: &str) -> String {
    assert!(SETUP.contains(line), "{line} is not in\n{SETUP}");
    SETUP.replacen(line, instead, 1)
}

#[test]
fn the_set_up_of_the_tests_is_that_of_the_file() {
    assert_eq!(*parse_setup(SETUP).unwrap().description(), description());
}

#[test]
fn a_written_set_up_is_what_a_person_would_write() {
    let mut description = description();
    description.sensor.exposure_time = 0.16 / 1e3;
    description.camera.angle = 40.0 * core::f64::consts::PI / 180.0;
    description.average.columns = 16;
    let text = description.to_toml();
    for line in [
        "wavelength = \"650 nm\"",
        "power = \"5 mW\"",
        "line_thickness = \"0.2 mm\" # between the points of 1/e², on the part",
        "f_number = 8",
        "pixel_pitch = \"3.45 um\"",
        "angle = \"40 deg\" # between the optical axis and the upright",
        "exposure = \"0.16 ms\"",
        "uncertainty = \"1 um\" # standard uncertainty of a height",
        "columns = 16",
    ] {
        assert!(
            text.lines().any(|found| found == line),
            "{line} is not in\n{text}"
        );
    }
    // What follows from the rest, or is as always, is not written.
    for key in [
        "gain",
        "black_level",
        "serial_number",
        "fill_factor",
        "scheimpflug",
    ] {
        assert!(!text.contains(key), "{key} is in\n{text}");
    }
    description.auto_exposure = true;
    let chosen = Setup::new(description).unwrap();
    let text = chosen.description().to_toml();
    let time = chosen.description().sensor.exposure_time * 1e3;
    let line = format!("exposure = \"auto\" # {time} ms");
    assert!(
        text.lines().any(|found| found == line),
        "{line} is not in\n{text}"
    );
    assert_eq!(parse_setup(&text).unwrap(), chosen);
}

#[test]
fn a_written_description_reads_back_as_the_same_bits() {
    let methods = [
        LineMethod::CentreOfGravity,
        LineMethod::ThresholdedCentreOfGravity { threshold: 0.3 },
        LineMethod::BlaisRioux {
            order: FilterOrder::Eighth,
        },
        LineMethod::Steger { sigma: 1.7 },
        LineMethod::GaussianFit,
    ];
    for method in methods {
        let mut written = description();
        written.detector.method = method;
        written.camera.angle = 0.1 + 0.2;
        written.laser.power = 1.0 / 3.0;
        written.camera.scheimpflug = true;
        written.average.columns = 7;
        written.sensor.gain = 0.3;
        written.sensor.black_level = 17.0;
        written.sensor.serial_number = 4;
        let read = parse_setup(&written.to_toml()).unwrap();
        assert_eq!(*read.description(), written, "{}", written.to_toml());
    }
    let mut written = description();
    for spectrum in [
        Spectrum::default(),
        Spectrum::Peak(LineShape::Lorentzian),
        Spectrum::Peak(LineShape::Rectangular),
        Spectrum::Comb(5),
    ] {
        written.laser.light.linewidth = 1e-9 / 3.0;
        written.laser.light.spectrum = spectrum;
        written.surface.relief.rms_height = 1.6e-6;
        written.surface.relief.correlation_length = 0.7e-6;
        let read = parse_setup(&written.to_toml()).unwrap();
        assert_eq!(*read.description(), written, "{}", written.to_toml());
    }
    let peaks = vec![[648e-9, 1.0], [651e-9, 0.1 + 0.2]];
    written.laser.light = LaserLight::of_peaks(peaks, 0.0).unwrap();
    let read = parse_setup(&written.to_toml()).unwrap();
    assert_eq!(*read.description(), written, "{}", written.to_toml());
}

/// Contrasts and line noises at 1, 5, 10 and 40 nm, of rows finer than a speckle, by direct quadrature.
#[test]
fn a_linewidth_lowers_the_noise_of_a_line_less_than_the_contrast() {
    let table = [
        (
            450,
            0.4,
            [0.984, 0.921, 0.845, 0.551],
            [0.991, 0.950, 0.896, 0.625],
        ),
        (
            450,
            1.6,
            [0.982, 0.888, 0.765, 0.435],
            [0.989, 0.913, 0.800, 0.463],
        ),
        (
            450,
            6.0,
            [0.959, 0.684, 0.508, 0.258],
            [0.964, 0.695, 0.517, 0.263],
        ),
        (
            660,
            0.4,
            [0.989, 0.947, 0.895, 0.652],
            [0.994, 0.967, 0.933, 0.733],
        ),
        (
            660,
            1.6,
            [0.989, 0.938, 0.869, 0.572],
            [0.993, 0.958, 0.903, 0.619],
        ),
        (
            660,
            6.0,
            [0.983, 0.849, 0.690, 0.369],
            [0.988, 0.863, 0.706, 0.379],
        ),
    ];
    // f / 2 L F = 0.025, at a magnification at which pixels are fine against a speckle.
    let fine = SETUP
        .replace("focal_length = 0.025", "focal_length = 0.12")
        .replace("pixel_pitch = 3.45e-6", "pixel_pitch = 1e-6");
    for (wavelength, height, contrasts, noises) in table {
        for (index, linewidth) in [1, 5, 10, 40].into_iter().enumerate() {
            let text = fine
                .replace(
                    "wavelength = 6.5e-7",
                    &format!("wavelength = \"{wavelength} nm\"\nlinewidth = \"{linewidth} nm\""),
                )
                .replace(
                    "reflectance = 0.5",
                    &format!("reflectance = 0.5\nrms_height = \"{height} um\""),
                );
            let setup = parse_setup(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let effect = setup.line().bandwidth;
            let what = format!("{wavelength} nm, {height} µm, {linewidth} nm: {effect:?}");
            assert!((effect.contrast - contrasts[index]).abs() < 4e-3, "{what}");
            let noise = effect.line_noise_ratio;
            assert!((noise - noises[index]).abs() < 4e-3, "{what}");
        }
    }
}

#[test]
fn what_may_be_left_out_has_defaults() {
    let needed: Vec<&str> = SETUP
        .split_inclusive("\n\n")
        .filter(|section| {
            !["[detector]", "[calibration]", "[average]"]
                .iter()
                .any(|name| section.starts_with(name))
        })
        .collect();
    let setup = parse_setup(&needed.concat()).unwrap();
    let read: &SetupDescription = setup.description();
    assert_eq!(
        read.average,
        crate::Averages::default(),
        "one column of one frame"
    );
    assert!(
        read.calibration_uncertainty.abs() < f64::MIN_POSITIVE,
        "none is known"
    );
}

#[test]
fn what_is_wrong_is_told_at_its_place() {
    let table = r#"
        [laser] => [lasser] => 1:2 => did you mean `laser`?
        wavelength = 6.5e-7 => wavelenght = 1 => 2:1 => did you mean `wavelength`?
        wavelength = 6.5e-7 => wavelength = "650 mm" => 2:14 => from 100 nm to 100 µm
        wavelength = 6.5e-7 => wavelength = nan => 2:14 => a finite number
        wavelength = 6.5e-7\n =>  => 1:1 => needs the key `wavelength`
        power = 0.005 => power = 1e300 => 3:9 => at most
        line_thickness = 2e-4 => line_width = 2e-4 => 4:1 => `line_width` in [laser] is now named `line_thickness`
        line_length = 0.05 => line_length = 1e-5 => 5:15 => thickness of the line
        f_number = 8 => f_number = 0.1 => 9:12 => from 0.5 to 1000
        [640, 480] => [640] => 11:14 => two numbers of pixels
        [640, 480] => [1048576, 1048576] => 11:14 => pixels
        distance = 0.3 => distance = 0.02 => 12:12 => focal lengths
        reflectance = 0.5 => reflectance = 0 => 31:15 => positive, at most 1
        columns = 1 => columns = 641 => 45:11 => columns of the image
        columns = 1 => columns = 1.5 => 45:11 => a whole number
        window = 31 => window = 30 => 37:10 => odd
    "#;
    for [line, instead, position, part] in rows(table) {
        let error = parse_setup(&with(&line, &instead)).unwrap_err();
        assert!(error.to_string().contains(&part), "{instead}: {error}");
        let (line, column) = error.line_column().unwrap();
        assert_eq!(format!("{line}:{column}"), position, "{instead}: {error}");
    }
}

#[test]
fn a_setup_without_a_laser_says_so() {
    let text = description().to_toml();
    let (_, rest) = text.split_once("\n\n").unwrap();
    let error = parse_setup(rest).unwrap_err();
    assert!(error.message().contains("[laser]"), "{error}");
    assert!(
        error.help().is_some_and(|help| help.contains("wavelength")),
        "{error:?}"
    );
    let empty = parse_setup("").unwrap_err();
    assert!(empty.message().contains("[laser]"), "{empty}");
}

#[test]
fn further_sections_are_read_with_the_setup() {
    let text = format!("{}\n[design]\nbest = 3\n", description().to_toml());
    let (setup, best) = crate::parse_setup_with(&text, |document, _| {
        let section = document.table("design", &["best"])?;
        section.map_or(Ok(0), |section| {
            section.or("best", 1, |value| value.integer(1..=9))
        })
    })
    .unwrap();
    assert_eq!(best, 3, "the number in the section");
    assert_eq!(
        setup,
        Setup::new(description()).unwrap(),
        "the set-up as without it"
    );
}
