use super::document::Document;
use super::error::Problem;
use super::placement::rejected;
use super::quantity::{POWER, RADIANCE};
use super::section::{Choice, Section};
use super::shape::rectangle;
use crate::Lamp;

pub(super) const KEYS: &[&str] = &["point", "rectangle"];
pub(super) const SHAPES: &[Choice] = &[
    ("point", &["position", "power"]),
    ("rectangle", &["centre", "normal", "up", "size", "radiance"]),
];

pub(super) fn read(root: &Document<'_>) -> Result<Vec<Lamp>, Problem> {
    root.tables("lamp", KEYS)?.iter().map(lamp).collect()
}

fn lamp(section: &Section<'_>) -> Result<Lamp, Problem> {
    match section.one_of("shape", SHAPES)? {
        ("point", section) => point(&section),
        (_, section) => area(&section),
    }
}

fn point(section: &Section<'_>) -> Result<Lamp, Problem> {
    let position = section.required("position", "[0, 0, \"1 m\"]")?.lengths()?;
    let power = section.required("power", "\"10 mW\"")?.positive(&POWER)?;
    Lamp::point(position, power).map_err(|error| rejected(&error, &[section]))
}

fn area(section: &Section<'_>) -> Result<Lamp, Problem> {
    let radiance = section.required("radiance", "0.5")?.positive(&RADIANCE)?;
    Lamp::area(rectangle(section)?, radiance).map_err(|error| rejected(&error, &[section]))
}
