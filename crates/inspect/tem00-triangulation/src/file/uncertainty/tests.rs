use tem00_testkit::rows;

use super::*;
use crate::parse_setup_with;

/// A set-up whose lines are changed.
fn text(changes: &[(&str, &str)], more: &str) -> String {
    let mut text = r#"
[laser]
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
"#
    .to_owned();
    for (key, value) in changes {
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("{key} =")))
            .unwrap()
            .to_owned();
        text = text.replace(&line, &format!("{key} = {value}"));
    }
    text + more
}

fn read(text: &str) -> Result<(Setup, SetupUncertainty), tem00_config::ConfigError> {
    parse_setup_with(text, read_uncertainty)
}

const ANGLE: (&str, &str) = ("angle", r#"{ value = "30 deg", uncertainty = "0.05 deg" }"#);
const DISTANCE: (&str, &str) = ("distance", r#"{ value = "300 mm", uncertainty = 1e-4 }"#);

#[test]
fn bare_values_are_exact() {
    let (_, found) = read(&text(&[], "")).unwrap();
    assert_eq!(found, SetupUncertainty::default());
}

#[test]
fn uncertain_values_are_read_beside_their_set_up() {
    let focal = r#"{ value = "25 mm", uncertainty = "10 um", distribution = "rectangular" }"#;
    let exposure =
        r#"{ value = "auto", uncertainty = "2 us", distribution = "t", degrees_of_freedom = 8 }"#;
    let changes = [
        ANGLE,
        DISTANCE,
        ("focal_length", focal),
        ("exposure", exposure),
    ];
    let more = r#"
[[correlation]]
between = ["camera.distance", "camera.angle"]
coefficient = -0.5
[budget]
height = "5 mm"
"#;
    let (setup, found) = read(&text(&changes, more)).unwrap();
    let (exact, _) = read(&text(&[], "")).unwrap();
    assert_eq!(setup, exact, "the best estimates make the set-up");
    let time = setup.description().sensor.exposure_time;
    let input = |estimate, uncertainty, shape| Input::new(estimate, uncertainty, shape).unwrap();
    let degree = core::f64::consts::PI / 180.0;
    let time = input(time, 2e-6, Distribution::StudentT).with_degrees_of_freedom(8.0);
    let expected = SetupUncertainty {
        height: Some(5e-3),
        quantities: vec![
            (
                SetupQuantity::FocalLength,
                input(25e-3, 10e-6, Distribution::Rectangular),
            ),
            (
                SetupQuantity::Distance,
                input(0.3, 1e-4, Distribution::Normal),
            ),
            (
                SetupQuantity::Angle,
                input(
                    30.0 * degree,
                    0.05 * core::f64::consts::PI / 180.0,
                    Distribution::Normal,
                ),
            ),
            (SetupQuantity::Exposure, time.unwrap()),
        ],
        correlations: vec![Correlation {
            between: [1, 2],
            coefficient: -0.5,
        }],
    };
    assert_eq!(found, expected);
}

#[test]
fn every_quantity_may_be_uncertain() {
    for &quantity in SetupQuantity::ALL {
        let [section, key] = quantity.path();
        let value = match key {
            "linewidth" => "\"1 nm\"",
            "source_half_angle" => "\"2 mrad\"",
            "offset" => "\"1 mm\"",
            "tilt" => "\"1 deg\"",
            "rms_height" | "correlation_length" => "\"1 um\"",
            "principal_row" => "240",
            "full_well" => "1e4",
            "black_level" => "64",
            "temperature_change" => "2",
            "base_expansion" | "mount_expansion" => "1e-5",
            "gain" | "fill_factor" | "polarisation" => "0.5",
            "dark_noise" | "dark_current" | "dsnu" => "2",
            "prnu" => "0.01",
            "exposure" => "\"0.1 ms\"",
            _ => "",
        };
        let bare = text(&[], "");
        let line = bare
            .lines()
            .find(|line| line.starts_with(&format!("{key} =")));
        let value = if value.is_empty() {
            line.unwrap().split_once("= ").unwrap().1.to_owned()
        } else {
            value.to_owned()
        };
        let uncertainty = match value
            .strip_prefix('"')
            .and_then(|value| value.split_once(' '))
        {
            Some((_, unit)) => format!("\"0.001 {unit}"),
            None => "1e-6".to_owned(),
        };
        let uncertain = format!("{key} = {{ value = {value}, uncertainty = {uncertainty} }}\n");
        let without = line.map_or(bare.clone(), |line| bare.replace(&format!("{line}\n"), ""));
        let relief = if key == "correlation_length" {
            "rms_height = 1e-6\n"
        } else {
            ""
        };
        let header = format!("[{section}]\n");
        let text = if without.contains(&header) {
            without.replace(&header, &format!("{header}{relief}{uncertain}"))
        } else {
            format!("{without}{header}{uncertain}")
        };
        let (setup, found) = read(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(found.quantities.len(), 1, "{quantity}");
        let (read, input) = found.quantities[0];
        assert_eq!(read, quantity, "{quantity}");
        let value = quantity.value_in(setup.description());
        assert!(
            (input.estimate() - value).abs() <= 1e-15 * value,
            "{quantity}"
        );
    }
}

#[test]
fn an_uncertainty_of_zero_is_none() {
    let angle = ("angle", r#"{ value = "30 deg", uncertainty = 0 }"#);
    let (_, found) = read(&text(&[angle], "")).unwrap();
    assert_eq!(found, SetupUncertainty::default());
}

/// Asserts that a text is refused at a position, with such words.
fn assert_refused(text: &str, at: &str, words: &str) {
    let error = read(text).map(drop).unwrap_err();
    let message = error.to_string();
    assert!(message.contains(words), "{message}\nhas no {words}");
    let (line, column) = error.line_column().unwrap();
    let line = text.lines().nth(line - 1).unwrap();
    let rest: String = line.chars().skip(column - 1).collect();
    assert!(
        rest.starts_with(at),
        "{message}\npoints at {rest}, not {at}"
    );
}

#[test]
fn uncertain_values_that_cannot_be_are_refused_where_they_stand() {
    let table = r#"
        { value = "30 deg", uncertanty = 1 } => uncertanty => did you mean `uncertainty`?
        { value = "30 deg" } => { value => needs the key `uncertainty`
        { uncertainty = "1 deg" } => { uncert => `angle` must be an angle
        { value = "30 mm", uncertainty = "1 deg" } => "30 mm" => `angle` must be an angle
        { value = "30 deg", uncertainty = "1 mm" } => "1 mm" => `uncertainty` must be an angle
        { value = "30 deg", uncertainty = "-1 deg" } => "-1 deg" => must be at least 0
        { value = "30 deg", uncertainty = "80 deg" } => "80 deg" => one `uncertainty` below its value, angle must be from 1 deg to 89 deg
        { value = "30 deg", uncertainty = 0.01, distribution = "gauss" } => "gauss" => one of "normal"
        { value = "30 deg", uncertainty = 0.01, distribution = "t" } => { value => `degrees_of_freedom`
        { value = "30 deg", uncertainty = 0.01, degrees_of_freedom = 0 } => 0 } => at least 1
        { value = "30 deg", uncertainty = 0.01, degrees_of_freedom = 2 } => 2 } => `degrees_of_freedom` must be above 2, got 2
    "#;
    for [angle, at, words] in rows(table) {
        assert_refused(&text(&[("angle", &angle)], ""), &at, &words);
    }
    let pixels = ("resolution", "{ value = [640, 480], uncertainty = 1 }");
    assert_refused(
        &text(&[pixels], ""),
        "{ value",
        "`resolution` must be two numbers",
    );
}

#[test]
fn a_set_up_alone_is_not_read_past_what_is_wrong_with_its_uncertainties() {
    let angle = ("angle", r#"{ value = "30 deg", uncertainty = "-1 deg" }"#);
    let error = crate::parse_setup(&text(&[angle], "")).unwrap_err();
    assert!(error.to_string().contains("at least 0"), "{error}");
}

#[test]
fn correlations_and_heights_that_cannot_be_are_refused_where_they_stand() {
    let pair = r#"between = ["camera.angle", "camera.distance"]"#;
    let more = format!("[[correlation]]\n{pair}\ncoefficient = 0.5\n");
    let rectangular = (
        "angle",
        r#"{ value = "30 deg", uncertainty = 1e-3, distribution = "rectangular" }"#,
    );
    assert_refused(
        &text(&[rectangular, DISTANCE], &more),
        "[\"camera.angle",
        "camera.angle is none",
    );
    for (section, at, words) in [
        (
            more.replace("camera.distance", "camera.distanse"),
            "\"camera.distanse",
            "did you mean \"camera.distance\"?",
        ),
        (
            more.replace("camera.distance", "surface.reflectance"),
            "\"surface",
            "an uncertain quantity",
        ),
        (
            more.replace("camera.distance", "camera.angle"),
            "[\"camera",
            "two different quantities",
        ),
        (more.replace("0.5", "1.5"), "1.5", "from -1 to 1"),
        (
            more.replace("coefficient", "koefficient"),
            "koefficient",
            "did you mean `coefficient`?",
        ),
        (format!("{more}{more}"), "[\"camera.angle", "a second time"),
        (
            "[budget]\nheight = \"1 m\"\n".into(),
            "\"1 m\"",
            "within the measuring range",
        ),
    ] {
        assert_refused(&text(&[ANGLE, DISTANCE], &section), at, words);
    }
    let focal = (
        "focal_length",
        r#"{ value = "25 mm", uncertainty = "10 um" }"#,
    );
    // With the first coefficient of 0.5, whose second makes focal length and angle one.
    let three = |coefficient: &str| {
        format!(
            "{more}[[correlation]]\nbetween = [\"camera.angle\", \"camera.focal_length\"]\ncoefficient = 1\n\
             [[correlation]]\nbetween = [\"camera.distance\", \"camera.focal_length\"]\ncoefficient = {coefficient}\n"
        )
    };
    let changes = [ANGLE, DISTANCE, focal];
    assert_refused(&text(&changes, &three("-1")), "-1", "contradicts");
    let (_, found) = read(&text(&changes, &three("0.5"))).unwrap();
    assert_eq!(found.correlations.len(), 3, "possible all together");
}
