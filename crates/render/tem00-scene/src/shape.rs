use glam::DVec3;
use tem00_config::{Choice, LENGTH, NUMBER, Problem, Section, Value, rejected};
use tem00_decorrelation::RigidMotion;
use tem00_geometry::{Cylinder, MeshInstance, Rectangle, Shape, Sphere};
use tem00_tracer::Rotation;

use crate::assets::{Assets, Shading};
use crate::mesh_file::MeshFileError;
use crate::motion::rotation;
use crate::placement::across;

const SHAPES: &[Choice] = &[
    ("rectangle", &["centre", "normal", "up", "size"]),
    ("sphere", &["centre", "radius"]),
    ("cylinder", &["centre", "base", "axis", "radius", "length"]),
    (
        "mesh",
        &[
            "file", "unit", "scale", "rotation", "position", "centre", "shading",
        ],
    ),
];
const SHADINGS: &[(&str, Shading)] = &[("smooth", Shading::Smooth), ("flat", Shading::Flat)];

/// A shape and the point by which the file places it, in metres.
#[derive(Clone, Debug)]
pub(crate) struct PlacedShape {
    pub(crate) shape: Shape,
    pub(crate) position: DVec3,
}

/// Reads the shape of a surface.
pub(crate) fn read(section: &Section<'_>, assets: &mut Assets) -> Result<PlacedShape, Problem> {
    let (kind, section) = section.one_of("shape", SHAPES)?;
    let at = |shape, position| PlacedShape { shape, position };
    Ok(match kind {
        "rectangle" => {
            let rectangle = rectangle(&section)?;
            at(Shape::Rectangle(rectangle), rectangle.centre())
        }
        "sphere" => {
            let sphere = sphere(&section)?;
            at(Shape::Sphere(sphere), sphere.centre())
        }
        "cylinder" => cylinder(&section)?,
        _ => {
            let (mesh, position) = mesh(&section, assets)?;
            at(Shape::Mesh(mesh), position)
        }
    })
}

/// Reads a rectangle; without any of its keys but `size` it stands upright in the origin and faces
/// +z.
pub(crate) fn rectangle(section: &Section<'_>) -> Result<Rectangle, Problem> {
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
    .map_err(|error| rejected(&error, Some(error.parameter()), &[section]))
}

fn sphere(section: &Section<'_>) -> Result<Sphere, Problem> {
    let centre = section.or("centre", DVec3::ZERO, Value::lengths)?;
    let radius = section.required("radius", "\"10 mm\"")?.positive(&LENGTH)?;
    Sphere::new(centre, radius)
        .map_err(|error| rejected(&error, Some(error.parameter()), &[section]))
}

/// Reads a tube, placed by the middle of its axis or by the end where the axis begins.
fn cylinder(section: &Section<'_>) -> Result<PlacedShape, Problem> {
    let axis = section.or("axis", DVec3::Z, Value::direction)?;
    let radius = section.required("radius", "\"4 mm\"")?.positive(&LENGTH)?;
    let length = section.required("length", "\"50 mm\"")?.positive(&LENGTH)?;
    let (position, centre) = match (section.optional("centre"), section.optional("base")) {
        (Some(_), Some(base)) => return Err(both("centre", "base", "the tube", &base)),
        (_, Some(base)) => {
            let base = base.lengths()?;
            (base, base + 0.5 * length * axis)
        }
        (centre, None) => {
            let centre = centre.map_or(Ok(DVec3::ZERO), |centre| centre.lengths())?;
            (centre, centre)
        }
    };
    let tube = Cylinder::new(centre, axis, radius, length);
    let tube = tube.map_err(|error| rejected(&error, Some(error.parameter()), &[section]))?;
    Ok(PlacedShape {
        shape: Shape::Cylinder(tube),
        position,
    })
}

/// Reads a mesh file and places it: scaled, then rotated, then moved by `position` or
/// until the middle of its box is at `centre`.
fn mesh(section: &Section<'_>, assets: &mut Assets) -> Result<(MeshInstance, DVec3), Problem> {
    let file = section.required("file", "\"part.ply\"")?;
    let path = section.beside(file.string()?);
    let unit = section.or("unit", usual_unit(file.string()?), |value| {
        value.unit_of_length()
    })?;
    let scale = section.or("scale", 1.0, |value| value.positive(&NUMBER))?;
    let turn = turn(rotation(section, "rotation")?);
    let position = section.or("position", DVec3::ZERO, Value::lengths)?;
    let centre = section.optional("centre");
    if let (Some(centre), true) = (&centre, section.has("position")) {
        return Err(both("centre", "position", "the mesh", centre));
    }
    let shading = section.or("shading", Shading::Smooth, |value| value.one_of(SHADINGS))?;
    let failed = |error: MeshFileError| {
        let problem = file.problem(format_args!("`file` must be a mesh: {error}"));
        problem.unreadable(error.is_unreadable())
    };
    let mesh = assets.mesh(&path, shading).map_err(failed)?;
    let place = |motion: &RigidMotion| {
        let placed = mesh.placed(unit * scale, motion);
        placed.map_err(|error| rejected(&error, Some(error.parameter()), &[section]))
    };
    let turned = place(&turn)?;
    let position = match &centre {
        Some(centre) => centre.lengths()? - middle(&turned),
        None => position,
    };
    Ok((
        turned.moved(&RigidMotion::along(position).unwrap_or_default()),
        centre.map_or(Ok(position), |centre| centre.lengths())?,
    ))
}

/// The unit of a mesh file that does not state one, in metres: glTF is defined in metres, drawings
/// of parts are in millimetres.
fn usual_unit(file: &str) -> f64 {
    let name = file.to_lowercase();
    if name.ends_with(".gltf") || name.ends_with(".glb") {
        1.0
    } else {
        1e-3
    }
}

/// Returns a rotation about the origin.
pub(crate) fn turn(rotation: Rotation) -> RigidMotion {
    RigidMotion::about(DVec3::ZERO, rotation.axis, rotation.angle).unwrap_or_default()
}

/// The middle of the box around the triangles of a mesh, in metres.
fn middle(mesh: &MeshInstance) -> DVec3 {
    let (vertices, triangles) = (mesh.mesh().vertices(), mesh.mesh().triangles());
    let corners = triangles.as_flattened().iter();
    let corners = corners.map(|&corner| mesh.point(vertices[corner as usize]));
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners.fold(nothing, |(low, high), p| (low.min(p), high.max(p)));
    0.5 * (low + high)
}

fn both(one: &str, other: &str, what: &str, value: &Value<'_>) -> Problem {
    value.problem(format_args!(
        "`{one}` and `{other}` both place {what}: give one of the two"
    ))
}
