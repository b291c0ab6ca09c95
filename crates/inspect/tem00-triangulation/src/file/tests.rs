use tem00_testkit::rows;
use tem00_translucence::Material;

use crate::{
    Averages, FilterOrder, LaserLight, LineMethod, PeakShape, Setup, SetupDescription,
    SpectrumForm, Subsurface, parse_setup, setup::tests::description,
};

/// A set-up file without what has a default.
pub(crate) const PLAIN: &str = r#"[laser]
wavelength = "650 nm"
power = "5 mW"
line_thickness = "0.2 mm"
line_length = "50 mm"
[camera]
focal_length = "25 mm"
f_number = 8
pixel_pitch = "3.45 um"
resolution = [640, 480]
distance = "300 mm"
angle = "30 deg"
[sensor]
quantum_efficiency = 0.6
exposure = "auto"
[surface]
reflectance = 0.5
"#;

/// The sections and keys that have a default, in SI units.
const MORE: &str = r#"patterns = 1
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

/// Returns a set-up file with other values of some keys.
pub(crate) fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    let line = |line: &str| {
        let key = line.split(" = ").next();
        let change = changes.iter().find(|change| key == Some(change.0));
        change.map_or(line.to_owned(), |(key, value)| format!("{key} = {value}")) + "\n"
    };
    text.lines().map(line).collect()
}

/// Returns the set-up file of the tests' description.
fn full() -> String {
    changed(PLAIN, &[("exposure", "1e-4")]) + MORE
}

#[test]
fn the_set_up_of_the_tests_is_that_of_the_file() {
    assert_eq!(*parse_setup(&full()).unwrap().description(), description());
    let plain = parse_setup(PLAIN).unwrap();
    let read = plain.description();
    assert_eq!(read.average, Averages::default(), "one column of one frame");
    assert_eq!(read.calibration_uncertainty.to_bits(), 0, "none is known");
}

#[test]
fn a_written_set_up_is_what_a_person_would_write() {
    let mut description = description();
    description.sensor.exposure_time = 0.16 / 1e3;
    description.camera.angle = 40.0 * core::f64::consts::PI / 180.0;
    description.average.columns = 16;
    let text = description.to_toml();
    let has = |text: &str, line: &str| {
        let is_there = text.lines().any(|found| found == line);
        assert!(is_there, "{line} is not in\n{text}");
    };
    for line in [
        "wavelength = \"650 nm\"",
        "power = \"5 mW\"",
        "line_thickness = \"0.2 mm\" # between the points of 1/e², on the part",
        "f_number = 8",
        "pixel_pitch = \"3.45 um\"",
        "angle = \"40 deg\" # between the optical axis and the vertical",
        "exposure = \"0.16 ms\"",
        "uncertainty = \"1 um\" # standard uncertainty of a height",
        "columns = 16",
    ] {
        has(&text, line);
    }
    // Values that follow from the others, or equal their defaults, are not written.
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
    has(&text, &format!("exposure = \"auto\" # {time} ms"));
    assert_eq!(parse_setup(&text).unwrap(), chosen);
}

#[test]
fn a_written_description_reads_back_as_the_same_bits() {
    let comes_back = |written: &SetupDescription| {
        let text = written.to_toml();
        assert_eq!(parse_setup(&text).unwrap().description(), written, "{text}");
    };
    let order = FilterOrder::Eighth;
    for method in [
        LineMethod::CentreOfGravity,
        LineMethod::ThresholdedCentreOfGravity { threshold: 0.3 },
        LineMethod::BlaisRioux { order },
        LineMethod::Steger { sigma: 1.7 },
        LineMethod::GaussianFit,
    ] {
        let mut written = description();
        written.detector.method = method;
        written.camera.angle = 0.1 + 0.2;
        written.laser.power = 1.0 / 3.0;
        written.camera.scheimpflug = true;
        written.average.columns = 7;
        written.sensor.gain = 0.3;
        written.sensor.black_level = 17.0;
        written.sensor.serial_number = 4;
        comes_back(&written);
    }
    let mut written = description();
    for spectrum in [
        SpectrumForm::default(),
        SpectrumForm::Peak(PeakShape::Lorentzian),
        SpectrumForm::Peak(PeakShape::Rectangular),
        SpectrumForm::Comb(5),
    ] {
        written.laser.light.linewidth = 1e-9 / 3.0;
        written.laser.light.form = spectrum;
        written.surface.relief.rms_height = 1.6e-6;
        written.surface.relief.correlation_length = 0.7e-6;
        comes_back(&written);
    }
    written.surface.subsurface = Subsurface {
        material: Some(&Material::ALL[5]),
        transport_length: 0.3e-3 / 7.0,
        refractive_index: 1.4,
        surface_fraction: 0.1,
        ..Subsurface::default()
    };
    comes_back(&written);
    written.surface.subsurface = Subsurface::default();
    let peaks = vec![[648e-9, 1.0], [651e-9, 0.1 + 0.2]];
    written.laser.light = LaserLight::of_peaks(peaks, 0.0).unwrap();
    comes_back(&written);
}

/// Contrasts and line noises at 1, 5, 10 and 40 nm, of rows finer than a speckle, by direct
/// quadrature.
#[test]
fn a_linewidth_lowers_the_noise_of_a_line_less_than_the_contrast() {
    for (wavelength, height, contrasts, noises) in [
        (
            450,
            0.4,
            [0.984, 0.921, 0.845, 0.551],
            [0.991, 0.950, 0.896, 0.625],
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
    ] {
        for (index, linewidth) in [1, 5, 10, 40].into_iter().enumerate() {
            // f / 2 L F = 0.025, at a magnification at which pixels are small compared with a
            // speckle.
            let changes = [
                ("focal_length", "0.12"),
                ("pixel_pitch", "1e-6"),
                (
                    "wavelength",
                    &format!("\"{wavelength} nm\"\nlinewidth = \"{linewidth} nm\""),
                ),
                ("reflectance", &format!("0.5\nrms_height = \"{height} um\"")),
            ];
            let text = changed(&full(), &changes);
            let setup = parse_setup(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            let effect = setup.line().bandwidth;
            let what = format!("{wavelength} nm, {height} µm, {linewidth} nm: {effect:?}");
            assert!((effect.contrast - contrasts[index]).abs() < 4e-3, "{what}");
            assert!(
                (effect.line_noise_ratio - noises[index]).abs() < 4e-3,
                "{what}"
            );
        }
    }
}

#[test]
fn what_is_wrong_is_told_at_its_place() {
    let table = r#"
        [laser] => [lasser] => 1:2 => did you mean `laser`?
        wavelength = "650 nm" => wavelenght = 1 => 2:1 => did you mean `wavelength`?
        wavelength = "650 nm" => wavelength = "650 mm" => 2:14 => from 100 nm to 100 µm
        wavelength = "650 nm" => wavelength = nan => 2:14 => a finite number
        wavelength = "650 nm"\n =>  => 1:1 => needs the key `wavelength`
        power = "5 mW" => power = 1e300 => 3:9 => at most
        line_thickness = "0.2 mm" => line_width = 2e-4 => 4:1 => did you mean `line_thickness`
        line_length = "50 mm" => line_length = 1e-5 => 5:15 => thickness of the line
        f_number = 8 => f_number = 0.1 => 8:12 => from 0.5 to 1000
        [640, 480] => [640] => 10:14 => two numbers of pixels
        [640, 480] => [1048576, 1048576] => 10:14 => pixels
        distance = "300 mm" => distance = 0.02 => 11:12 => focal lengths
        reflectance = 0.5 => roughness = 0 => 17:1 => did you mean `rms_height`
        reflectance = 0.5 => reflectance = 0 => 17:15 => positive, at most 1
        columns = 1 => columns = 641 => 28:11 => columns of the image
        columns = 1 => columns = 1.5 => 28:11 => a whole number
        window = 31 => window = 30 => 22:10 => odd
        patterns = 1 => material = "marbel" => 18:12 => marble
        patterns = 1 => absorption = 5 => 18:14 => beside
        patterns = 1 => refractive_index = 1.5 => 18:20 => beside
        patterns = 1 => transport_length = "2 m"\nabsorption = 5 => 18:20 => to 1 m
        patterns = 1 => transport_length = 1e-4 => 16:1 => needs the key `absorption`
    "#;
    let full = full();
    for [line, instead, position, part] in rows(table) {
        assert!(full.contains(&line), "{line} is not in\n{full}");
        let error = parse_setup(&full.replacen(&line, &instead, 1)).unwrap_err();
        assert!(error.to_string().contains(&part), "{instead}: {error}");
        let (line, column) = error.line_column().unwrap();
        assert_eq!(format!("{line}:{column}"), position, "{instead}: {error}");
    }
    let (_, without) = PLAIN.split_once("[camera]").unwrap();
    let degrees = changed(&full, &[("angle", "45")]);
    let unknown = changed(&full, &[("angle", "0.5\nangel = 1\nzoom = 2")]);
    for (text, part, help) in [
        ("", "[laser]", "wavelength"),
        (&format!("[camera]{without}"), "[laser]", "wavelength"),
        (&degrees, "(in radians), got 45", "such as \"30 deg\""),
        (&unknown, "did you mean `angle`?", "; also unknown: `zoom`"),
    ] {
        let error = parse_setup(text).unwrap_err();
        assert!(error.message().contains(part), "{error}");
        assert!(
            error.help().is_some_and(|found| found.contains(help)),
            "{error:?}"
        );
    }
}

#[test]
fn further_sections_are_read_with_the_setup() {
    let text = format!("{}\n[design]\nbest = 3\n", description().to_toml());
    let (setup, best) = crate::parse_setup_with(&text, |document, _| {
        let section = document.table("design", &["best"])?.unwrap();
        section.or("best", 1, |value| value.integer(1..=9))
    })
    .unwrap();
    let expected = Setup::new(description()).unwrap();
    assert_eq!((best, setup), (3, expected), "the set-up as without it");
}
