use glam::DVec3;
use tem00_config::{Choice, Document, NUMBER, POWER, Problem, RADIANCE, Section, Value, rejected};
use tem00_tracer::{Environment, Light, TracerError};

use crate::assets::Assets;
use crate::placement::across;
use crate::shape::rectangle;

const KEYS: &[&str] = &["point", "rectangle", "environment"];
const SHAPES: &[Choice] = &[
    ("point", &["position", "power"]),
    ("rectangle", &["centre", "normal", "up", "size", "radiance"]),
    (
        "environment",
        &["radiance", "file", "scale", "up", "middle"],
    ),
];

pub(crate) fn read(root: &Document<'_>, assets: &mut Assets) -> Result<Vec<Light>, Problem> {
    let sections = root.tables("light", KEYS)?;
    sections
        .iter()
        .map(|section| light(section, assets))
        .collect()
}

fn light(section: &Section<'_>, assets: &mut Assets) -> Result<Light, Problem> {
    match section.one_of("shape", SHAPES)? {
        ("point", section) => point(&section),
        ("rectangle", section) => area(&section),
        (_, section) => Ok(Light::Environment(environment(&section, assets)?)),
    }
}

fn point(section: &Section<'_>) -> Result<Light, Problem> {
    let position = section.required("position", "[0, 0, \"1 m\"]")?.lengths()?;
    let power = section.required("power", "\"10 mW\"")?.positive(&POWER)?;
    Light::point(position, power).map_err(|error| rejected(&error, error.parameter(), &[section]))
}

fn area(section: &Section<'_>) -> Result<Light, Problem> {
    let radiance = section.required("radiance", "0.5")?.positive(&RADIANCE)?;
    Light::area(rectangle(section)?, radiance)
        .map_err(|error| rejected(&error, error.parameter(), &[section]))
}

/// Reads light from all around: the same everywhere, or a map.
fn environment(section: &Section<'_>, assets: &mut Assets) -> Result<Environment, Problem> {
    let Some(file) = section.optional("file") else {
        let radiance = section.required("radiance", "0.5")?.positive(&RADIANCE)?;
        let of_maps = ["scale", "up", "middle"]
            .into_iter()
            .find(|key| section.has(key));
        if let Some(key) = of_maps {
            let message = format!("`{key}` belongs to a map: write `file` as well");
            return Err(section.problem_with(key, message));
        }
        return Environment::constant(radiance)
            .map_err(|error| rejected(&error, error.parameter(), &[section]));
    };
    if section.has("radiance") {
        let message = "`radiance` is for a sky without a map: use `scale` to brighten the `file`";
        return Err(section.problem_with("radiance", message));
    }
    let scale = section.or("scale", 1.0, |value| value.positive(&NUMBER))?;
    let up = section.or("up", DVec3::Y, Value::direction)?;
    let middle = section.or(
        "middle",
        across(up, DVec3::NEG_Z, DVec3::Y),
        Value::direction,
    )?;
    let path = section.beside(file.string()?);
    let failed =
        |why: String| file.problem(format_args!("`file` must be a map of radiance: {why}"));
    let map = assets
        .radiance_map(&path, scale)
        .map_err(|error| failed(error.to_string()).unreadable(error.is_unreadable()))?;
    Environment::from_radiance(map, up, middle).map_err(|error| match &error {
        TracerError::Direction { .. } => rejected(&error, error.parameter(), &[section]),
        other => failed(other.to_string()),
    })
}
