use std::path::Path;

use glam::{DQuat, DVec3};

use super::error::Problem;
use super::material;
use super::placement::{across, rejected};
use super::quantity::{ANGLE, LENGTH, NUMBER};
use super::section::{Choice, Section};
use super::value::Value;
use crate::{Laser, Rectangle, Shape, Sphere, Surface, TriangleMesh, read_mesh};

pub(super) const KEYS: &[&str] = &[
    "name",
    "displacement_per_frame",
    "rectangle",
    "sphere",
    "mesh",
    "lambertian",
    "conductor",
];
pub(super) const SHAPES: &[Choice] = &[
    ("rectangle", &["centre", "normal", "up", "size"]),
    ("sphere", &["centre", "radius"]),
    (
        "mesh",
        &["file", "unit", "scale", "rotation", "position", "centre"],
    ),
];
const ROTATION_KEYS: &[&str] = &["axis", "angle"];

pub(super) fn read(
    root: &Section<'_>,
    base_directory: &Path,
    lasers: &[Laser],
) -> Result<Vec<Surface>, Problem> {
    let sections = root.tables("surface", KEYS)?;
    if sections.is_empty() {
        return Err(Problem::new(
            "the scene needs a surface: a section [[surface]]",
        ));
    }
    sections
        .iter()
        .enumerate()
        .map(|(index, section)| {
            let material = material::read(section, lasers)?;
            let name = match section.optional("name") {
                Some(name) => name.string()?.to_owned(),
                None => format!("surface {}", index + 1),
            };
            Ok(Surface {
                name,
                shape: shape(section, base_directory)?,
                material,
                displacement_per_frame: section.or(
                    "displacement_per_frame",
                    DVec3::ZERO,
                    Value::lengths,
                )?,
            })
        })
        .collect()
}

fn shape(section: &Section<'_>, base_directory: &Path) -> Result<Shape, Problem> {
    Ok(match section.one_of("shape", SHAPES)? {
        ("rectangle", shape) => Shape::Rectangle(rectangle(&shape)?),
        ("sphere", shape) => Shape::Sphere(sphere(&shape)?),
        (_, shape) => Shape::from(mesh(&shape, base_directory)?),
    })
}

/// Reads a rectangle; without any of its keys but `size` it stands upright in the origin and faces
/// +z.
pub(super) fn rectangle(section: &Section<'_>) -> Result<Rectangle, Problem> {
    let centre = section.or("centre", DVec3::ZERO, Value::lengths)?;
    let normal = section.or("normal", DVec3::Z, Value::direction)?;
    let upright = across(normal, DVec3::Y, DVec3::Z);
    let up = section.or("up", upright, Value::direction)?;
    let size = section.required("size", "[\"40 mm\", \"30 mm\"]")?;
    let [width, height] = size.elements("two lengths, such as [\"40 mm\", \"30 mm\"]")?;
    let Some(right) = up.cross(normal).try_normalize() else {
        let message = "`up` must not be parallel to the normal of the rectangle";
        return Err(section.problem_with("up", message));
    };
    let half_width = 0.5 * width.positive(&LENGTH)?;
    let half_height = 0.5 * height.positive(&LENGTH)?;
    Rectangle::new(
        centre,
        half_width * right,
        half_height * normal.cross(right),
    )
    .map_err(|error| rejected(&error, &[section]))
}

fn sphere(section: &Section<'_>) -> Result<Sphere, Problem> {
    let centre = section.or("centre", DVec3::ZERO, Value::lengths)?;
    let radius = section.required("radius", "\"10 mm\"")?.positive(&LENGTH)?;
    Sphere::new(centre, radius).map_err(|error| rejected(&error, &[section]))
}

/// Reads a mesh file and puts it in its place: scaled, then rotated, then moved by `position` or
/// until the middle of its box is at `centre`.
fn mesh(section: &Section<'_>, base_directory: &Path) -> Result<TriangleMesh, Problem> {
    let file = section.required("file", "\"part.ply\"")?;
    let unit = section.or("unit", 1e-3, |value| value.unit_of_length())?;
    let scale = section.or("scale", 1.0, |value| value.positive(&NUMBER))?;
    let rotation = rotation(section)?;
    let position = section.or("position", DVec3::ZERO, Value::lengths)?;
    let centre = section.optional("centre");
    if let (Some(centre), true) = (&centre, section.has("position")) {
        let message = "`centre` and `position` both place the mesh: give one of the two";
        return Err(Problem::new(message).at(centre.span()));
    }
    let path = base_directory.join(file.string()?);
    let failed = |error| Problem::new(format!("`file` must be a mesh: {error}")).at(file.span());
    let mesh = read_mesh(&path, unit * scale).map_err(failed)?;
    let vertices = mesh.vertices().iter().map(|v| rotation * *v + position);
    let mesh = TriangleMesh::new(vertices.collect(), mesh.triangles().to_vec()).map_err(failed)?;
    let Some(centre) = centre else {
        return Ok(mesh);
    };
    let (low, high) = mesh.bounds();
    Ok(mesh.translated(centre.lengths()? - 0.5 * (low + high)))
}

fn rotation(section: &Section<'_>) -> Result<DQuat, Problem> {
    let Some(rotation) = section.table("rotation", ROTATION_KEYS)? else {
        return Ok(DQuat::IDENTITY);
    };
    let axis = rotation.required("axis", "[0, 0, 1]")?.direction()?;
    let angle = rotation.required("angle", "\"90 deg\"")?.quantity(&ANGLE)?;
    Ok(DQuat::from_axis_angle(axis, angle))
}
