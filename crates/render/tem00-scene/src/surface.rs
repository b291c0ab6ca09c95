use glam::DVec3;
use tem00_config::{Document, NUMBER, Problem, Section, Value, read_relief, rejected};
use tem00_decorrelation::RigidMotion;
use tem00_tracer::{Laser, Surface, SurfaceSpeckle};

use crate::assets::Assets;
use crate::material::{self, Finished};
use crate::motion::{pivot, rotation, trajectory};
use crate::shape::{self, PlacedShape};

const KEYS: &[&str] = &[
    "name",
    "displacement_per_frame",
    "rotation_per_frame",
    "pivot",
    "keyframe",
    "instance",
    "rectangle",
    "sphere",
    "cylinder",
    "mesh",
    "lambertian",
    "oren_nayar",
    "conductor",
    "plastic",
    "translucent",
    "mirror",
    "dielectric",
    "one_sided",
    "rms_height",
    "correlation_length",
    "speckle",
];
const INSTANCE_KEYS: &[&str] = &["displacement", "rotation"];
const SPECKLE_KEYS: &[&str] = &["patterns", "polarisation"];

pub(crate) fn read(
    root: &Document<'_>,
    assets: &mut Assets,
    lasers: &[Laser],
) -> Result<Vec<Surface>, Problem> {
    let sections = root.tables("surface", KEYS)?;
    if sections.is_empty() {
        return Err(Problem::new(
            "the scene needs a surface: a section [[surface]]",
        ));
    }
    let surfaces = sections.iter().enumerate().map(|(index, section)| {
        let name = match section.optional("name") {
            Some(name) => name.string()?.to_owned(),
            None => format!("surface {}", index + 1),
        };
        instances(section, &surface(section, name, assets, lasers)?)
    });
    Ok(surfaces.collect::<Result<Vec<_>, _>>()?.concat())
}

/// A surface that stands where its shape does, and the point that it turns about.
struct PlacedSurface {
    surface: Surface,
    pivot: DVec3,
}

fn surface(
    section: &Section<'_>,
    name: String,
    assets: &mut Assets,
    lasers: &[Laser],
) -> Result<PlacedSurface, Problem> {
    let Finished {
        material,
        rms_height,
    } = material::read(section, lasers)?;
    let PlacedShape { shape, position } = shape::read(section, assets)?;
    let pivot = pivot(section, position)?;
    let surface = Surface {
        name,
        shape,
        material,
        trajectory: trajectory(section, pivot)?,
        speckle: speckle(section)?,
        relief: read_relief(section, rms_height)?,
    };
    let curved = surface.check_curvature();
    curved.map_err(|error| section.problem_with("translucent", error))?;
    Ok(PlacedSurface { surface, pivot })
}

/// Returns the surface, or its instances if the file lists some: each is turned about the pivot,
/// then displaced, and moves about its displaced pivot.
fn instances(
    section: &Section<'_>,
    PlacedSurface { surface, pivot }: &PlacedSurface,
) -> Result<Vec<Surface>, Problem> {
    let listed = section.tables("instance", INSTANCE_KEYS)?;
    if listed.is_empty() {
        return Ok(vec![surface.clone()]);
    }
    let instance = |(index, instance): (usize, &Section<'_>)| {
        let displacement = instance.or("displacement", DVec3::ZERO, Value::lengths)?;
        let rotation = rotation(instance, "rotation")?;
        let motion = RigidMotion::about(*pivot, rotation.axis, rotation.angle)
            .and_then(|turn| Ok(turn.then(&RigidMotion::along(displacement)?)))
            .map_err(|error| rejected(&error, Some(error.parameter()), &[instance]))?;
        Ok(Surface {
            name: format!("{} {}", surface.name, index + 1),
            shape: surface.shape.moved(&motion),
            trajectory: trajectory(section, *pivot + displacement)?,
            ..surface.clone()
        })
    };
    listed.iter().enumerate().map(instance).collect()
}

fn speckle(section: &Section<'_>) -> Result<SurfaceSpeckle, Problem> {
    let default = SurfaceSpeckle::default();
    let Some(speckle) = section.table("speckle", SPECKLE_KEYS)? else {
        return Ok(default);
    };
    Ok(SurfaceSpeckle {
        patterns: speckle.or("patterns", default.patterns, |value| {
            let patterns = value.integer(1..=MAX_PATTERNS)?;
            Ok(u32::try_from(patterns).unwrap_or(default.patterns))
        })?,
        polarisation: speckle.or("polarisation", default.polarisation, |value| {
            value.within(&NUMBER, 0.0..=1.0, "from 0 to 1")
        })?,
    })
}

/// The maximum number of patterns: more leave a contrast below 1/32, which is hardly visible.
const MAX_PATTERNS: u64 = 1 << 10;
