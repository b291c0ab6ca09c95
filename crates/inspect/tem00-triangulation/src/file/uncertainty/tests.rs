use tem00_testkit::rows;

use super::*;
use crate::{
    SetupDescription,
    file::tests::{PLAIN, changed},
    parse_setup_with,
};

fn read(text: &str) -> Result<(Setup, SetupUncertainty), tem00_config::ConfigError> {
    parse_setup_with(text, read_uncertainty)
}

/// Returns the plain set-up with the lines of other values, and further sections.
fn text(changes: &[(&str, &str)], more: &str) -> String {
    changed(PLAIN, changes) + more
}

const ANGLE: (&str, &str) = ("angle", r#"{ value = "30 deg", uncertainty = "0.05 deg" }"#);
const DISTANCE: (&str, &str) = ("distance", r#"{ value = "300 mm", uncertainty = 1e-4 }"#);

#[test]
fn bare_values_and_those_with_an_uncertainty_of_zero_are_exact() {
    let angle = ("angle", r#"{ value = "30 deg", uncertainty = 0 }"#);
    for text in [text(&[], ""), text(&[angle], "")] {
        let (_, found) = read(&text).unwrap();
        assert_eq!(found, SetupUncertainty::default());
    }
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
    let degree = core::f64::consts::PI / 180.0;
    let input = |quantity, estimate, uncertainty, shape| {
        (quantity, Input::new(estimate, uncertainty, shape).unwrap())
    };
    let normal = Distribution::Normal;
    let (_, few) = input(SetupQuantity::Exposure, time, 2e-6, Distribution::StudentT);
    let few = few.with_degrees_of_freedom(8.0).unwrap();
    let expected = SetupUncertainty {
        height: Some(5e-3),
        quantities: vec![
            input(
                SetupQuantity::FocalLength,
                25e-3,
                10e-6,
                Distribution::Rectangular,
            ),
            input(SetupQuantity::Distance, 0.3, 1e-4, normal),
            input(SetupQuantity::Angle, 30.0 * degree, 0.05 * degree, normal),
            (SetupQuantity::Exposure, few),
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
    // What a file need not say. A body below the surface, a linewidth, an extended source or a
    // relief takes long to read: each is written for its own quantities alone.
    let everywhere = [
        (SetupQuantity::LaserOffset, 1e-3),
        (SetupQuantity::LaserTilt, 5_f64.to_radians()),
        (SetupQuantity::PrincipalRow, 240.0),
        (SetupQuantity::BlackLevel, 60.0),
        (SetupQuantity::Gain, 0.3),
        (SetupQuantity::FillFactor, 0.5),
        (SetupQuantity::Polarisation, 0.5),
        (SetupQuantity::Reflectance, 0.5),
        (SetupQuantity::QuantumEfficiency, 0.5),
        (SetupQuantity::Exposure, 0.1e-3),
        (SetupQuantity::TemperatureChange, 2.0),
        (SetupQuantity::BaseExpansion, 1e-5),
        (SetupQuantity::MountExpansion, 1e-5),
    ];
    let body = [
        (SetupQuantity::TransportLength, 0.3e-3),
        (SetupQuantity::Absorption, 10.0),
        (SetupQuantity::RefractiveIndex, 1.4),
        (SetupQuantity::Anisotropy, 0.25),
        (SetupQuantity::BoundarySlope, 0.25),
        (SetupQuantity::SurfaceFraction, 0.125),
    ];
    let relief = [
        (SetupQuantity::RmsHeight, 1e-6),
        (SetupQuantity::CorrelationLength, 1e-6),
    ];
    let alone: [&[_]; 4] = [
        &body,
        &relief,
        &[(SetupQuantity::Linewidth, 1e-9)],
        &[(SetupQuantity::SourceHalfAngle, 2e-3)],
    ];
    for &quantity in SetupQuantity::ALL {
        let mut all = SetupDescription::default();
        let with_it = |part: &&&[_]| part.iter().any(|&(other, _)| other == quantity);
        let own = alone.iter().find(with_it).map_or(&[][..], |&part| part);
        for (written, value) in everywhere.iter().chain(own) {
            written.set(&mut all, *value);
        }
        let bare = all.to_toml();
        let key = quantity.key();
        let line = bare
            .lines()
            .find(|line| line.starts_with(&format!("{key} =")));
        let value = line.unwrap().split_once(" = ").unwrap().1;
        let value = value.split(" #").next().unwrap();
        let u = 1e-3 * quantity.value_in(&all);
        let uncertain = format!("{{ value = {value}, uncertainty = {u:e} }}");
        let text = changed(&bare, &[(key, &uncertain)]);
        let (setup, found) = read(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let [(read, input)] = found.quantities[..] else {
            panic!("{quantity}: {found:?}");
        };
        assert_eq!((read, input.uncertainty()), (quantity, u));
        let value = quantity.value_in(setup.description());
        assert!(
            (input.estimate() - value).abs() <= 1e-15 * value,
            "{quantity}"
        );
    }
}

/// Asserts that a text is refused at a position, with the given words.
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
    let pixels = text(
        &[("resolution", "{ value = [640, 480], uncertainty = 1 }")],
        "",
    );
    assert_refused(&pixels, "{ value", "`resolution` must be two numbers");
    // A set-up alone is not read past it.
    let angle = ("angle", r#"{ value = "30 deg", uncertainty = "-1 deg" }"#);
    let error = crate::parse_setup(&text(&[angle], "")).unwrap_err();
    assert!(error.to_string().contains("at least 0"), "{error}");
}

#[test]
fn correlations_and_heights_that_cannot_be_are_refused_where_they_stand() {
    let pair = r#"between = ["camera.angle", "camera.distance"]"#;
    let more = format!("[[correlation]]\n{pair}\ncoefficient = 0.5\n");
    let table = r#"
        camera.distance => camera.distanse => "camera.distanse => did you mean "camera.distance"?
        camera.distance => surface.reflectance => "surface => an uncertain quantity
        camera.distance => camera.angle => ["camera => two different quantities
        0.5 => 1.5 => 1.5 => from -1 to 1
        coefficient => koefficient => koefficient => did you mean `coefficient`?
        [[correlation]] => [budget]\nheight = "1 m"\n[[correlation]] => "1 m" => within the measuring range
    "#;
    for [part, instead, at, words] in rows(table) {
        let section = more.replace(&part, &instead);
        assert_refused(&text(&[ANGLE, DISTANCE], &section), &at, &words);
    }
    let twice = text(&[ANGLE, DISTANCE], &format!("{more}{more}"));
    assert_refused(&twice, "[\"camera.angle", "a second time");
    let limits = r#"{ value = "30 deg", uncertainty = 1e-3, distribution = "rectangular" }"#;
    let limits = text(&[("angle", limits), DISTANCE], &more);
    assert_refused(&limits, "[\"camera.angle", "camera.angle is none");
    // With the first coefficient of 0.5, whose second makes focal length and angle one.
    let focal = (
        "focal_length",
        r#"{ value = "25 mm", uncertainty = "10 um" }"#,
    );
    let three = |coefficient: &str| {
        let section = format!(
            "{more}[[correlation]]\nbetween = [\"camera.angle\", \"camera.focal_length\"]\n\
             coefficient = 1\n\
             [[correlation]]\nbetween = [\"camera.distance\", \"camera.focal_length\"]\n\
             coefficient = {coefficient}\n"
        );
        text(&[ANGLE, DISTANCE, focal], &section)
    };
    assert_refused(&three("-1"), "-1", "contradicts");
    let (_, found) = read(&three("0.5")).unwrap();
    assert_eq!(found.correlations.len(), 3, "possible all together");
}
