//! The JSON schema of scene files, for editors, says what the reader does.

mod json;

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use tem00_testkit::rows;

use super::{minimal, parse, repository::page, with};
use json::{check, each_object, from_toml};

fn schema() -> Value {
    serde_json::from_str(&page("scene.schema.json")).unwrap()
}

fn checked(text: &str) -> Result<(), String> {
    let schema = schema();
    check(&schema, &schema, &from_toml(text))
}

/// Asserts that the schema allows a document that the reader has accepted.
#[track_caller]
pub(super) fn assert_allowed(text: &str) {
    if let Err(why) = checked(text) {
        panic!("the schema does not allow this scene: {why}\n{text}");
    }
}

/// Every table of a scene file: the name of its definition in the schema, the section that it
/// stands in, and a line there that gives it a key that no table has.
const TABLES: &str = "
    scene => ?
    camera => [camera] ?
    tilt => [camera] tilt = { ? }
    laser => [[laser]] ?
    spot => [[laser]] spot = { ? }
    line => [[laser]] line = { ? }
    profile_table => [[laser]] line = { fan_angle = 1, thickness = 1e-3, profile = { ? } }
    surface => [[surface]] ?
    rectangle => [[surface]] rectangle = { ? }
    sphere => [[surface]] sphere = { ? }
    cylinder => [[surface]] cylinder = { ? }
    mesh => [[surface]] mesh = { ? }
    lambertian => [[surface]] lambertian = { ? }
    oren_nayar => [[surface]] oren_nayar = { ? }
    conductor => [[surface]] conductor = { ? }
    plastic => [[surface]] plastic = { ? }
    translucent => [[surface]] translucent = { ? }
    mirror => [[surface]] mirror = { ? }
    dielectric => [[surface]] dielectric = { ? }
    instance => [[surface]] rectangle.size = [1, 1]\\ninstance = [{ ? }]
    surface_speckle => [[surface]] rectangle.size = [1, 1]\\nspeckle = { ? }
    keyframe => [camera] keyframe = [{ ? }]
    rotation => [camera] rotation_per_frame = { ? }
    light => [[light]] ?
    light_point => [[light]] point = { ? }
    light_rectangle => [[light]] rectangle = { ? }
    environment => [[light]] environment = { ? }
    render => [render] ?
    filter => [render] filter = { ? }
    filter_radius => [render] filter = { box = { ? } }
    filter_gaussian => [render] filter = { gaussian = { ? } }
    speckle => [speckle] ?
";

/// Asks the reader for the keys of every table, by the name of its definition.
pub(super) fn tables() -> BTreeMap<String, BTreeSet<String>> {
    let table = |[name, place]: [String; 2]| (name, keys(&place));
    rows(TABLES).map(table).collect()
}

/// Returns the keys that the reader says are allowed at a place in a section.
fn keys(place: &str) -> BTreeSet<String> {
    let place = place.replace('?', "unheard_of = 0");
    let (section, line) = match place.split_once("] ") {
        Some((section, line)) => (format!("{section}]"), line),
        None => (String::new(), &*place),
    };
    let shape = match &*section {
        "[[laser]]" => "spot.waist_radius = \"0.5 mm\"\n",
        "[[surface]]" => "rectangle.size = [\"40 mm\", \"30 mm\"]\n",
        _ => "",
    };
    let scene = with(shape, "");
    let text = match scene.contains(&section) {
        true => scene.replacen(&section, &format!("{section}\n{line}\n"), 1),
        false => format!("{scene}{section}\n{line}\n"),
    };
    let error = parse(&text).unwrap_err();
    assert!(error.message().contains("`unheard_of`"), "{error}\n{text}");
    let help = error.help().unwrap();
    let keys = help.strip_prefix("allowed here: ").unwrap();
    keys.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_schema_has_exactly_the_keys_of_the_reader() {
    let schema = schema();
    let definitions = schema["$defs"].as_object().unwrap().iter();
    let all = definitions.map(|(name, table)| (name.as_str(), table));
    let all = all.chain([("scene", &schema)]);
    let defined = all.filter_map(|(name, table)| {
        let properties = table.get("properties")?.as_object()?;
        assert_eq!(table["additionalProperties"], false, "{name} is open");
        Some((name.to_owned(), properties.keys().cloned().collect()))
    });
    assert_eq!(defined.collect::<BTreeMap<_, _>>(), tables());
}

#[test]
fn the_schema_refuses_what_an_editor_should_mark() {
    let mistakes = r#"
        wavelength => wave_length
        "650 nm" => "650 km"
        "650 nm" => "-650 nm"
        "650 nm" => "650"
        "650 nm" => true
        "5 mW" => "5 nm"
        [0.1, 0, 0.2] => [0.1, 0]
        [[laser]] => [laser]
        spot.waist_radius = "0.5 mm" => # no shape
        spot. => line = { fan_angle = 1, thickness = 1 }\nspot.
        rectangle.size = => sphere.radius = 1\nrectangle.size =
        rectangle. => lambertian = {}\nconductor.metal = "gold"\nrectangle.
        rectangle. => conductor.metal = "aluminum"\nrectangle.
        rectangle. => lambertian.reflectance = 1.5\nrectangle.
        [camera] => [render]\nframes = 0\n[camera]
        [camera] => [render]\nmethod = "photon"\n[camera]
    "#;
    for [good, bad] in rows(mistakes) {
        let text = with(&good, &bad);
        assert!(parse(&text).is_err(), "the reader takes {bad}");
        assert!(checked(&text).is_err(), "the schema takes {bad}");
    }
    assert_allowed(&minimal());
}

#[test]
fn values_that_the_reader_writes_down_are_in_the_schema() {
    let text = page("scene.schema.json");
    for (name, _) in tem00_tracer::Metal::NAMED {
        assert!(text.contains(&format!("\"{name}\"")), "{name}");
    }
    for dimension in tem00_config::DIMENSIONS {
        for symbol in dimension.symbols() {
            // Parentheses are escaped in a pattern, and backslashes in JSON.
            let symbol = symbol.replace('(', "\\\\(").replace(')', "\\\\)");
            let listed = [
                format!("({symbol}|"),
                format!("|{symbol}|"),
                format!("|{symbol})"),
            ];
            assert!(listed.iter().any(|s| text.contains(s)), "{symbol}");
        }
    }
}

#[test]
fn defaults_are_allowed_values() {
    let schema = schema();
    each_object(&schema, &mut |words| {
        let mut words = words.clone();
        if let Some(default) = words.remove("default") {
            let fits = check(&schema, &Value::Object(words), &default);
            assert_eq!(fits, Ok(()), "{default}");
        }
    });
}
