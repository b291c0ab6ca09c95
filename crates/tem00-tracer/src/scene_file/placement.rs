use glam::DVec3;
use tem00_beam::BeamError;

use super::error::Problem;
use super::section::Section;
use super::value::Value;
use crate::TracerError;

/// Where something stands and what it looks at, two different points in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    pub(super) position: DVec3,
    pub(super) look_at: DVec3,
}

impl Placement {
    /// Reads `position` and `look_at`; without the latter, the origin is looked at.
    pub(super) fn read(section: &Section<'_>) -> Result<Self, Problem> {
        let position = section
            .required("position", "[0, 0, \"300 mm\"]")?
            .lengths()?;
        let look_at = section.or("look_at", DVec3::ZERO, Value::lengths)?;
        if (look_at - position).try_normalize().is_none() {
            let key = if section.has("look_at") {
                "look_at"
            } else {
                "position"
            };
            return Err(section
                .problem_with(key, "`look_at` must be another point than `position`")
                .with_help("without `look_at`, the origin is looked at"));
        }
        Ok(Self { position, look_at })
    }

    /// Returns the vector from the position to the point looked at, in metres.
    pub(super) fn axis(&self) -> DVec3 {
        self.look_at - self.position
    }
}

/// Returns `preferred`, unless it is parallel to `axis` within a milliradian: then `otherwise`.
pub(super) fn across(axis: DVec3, preferred: DVec3, otherwise: DVec3) -> DVec3 {
    const PARALLEL: f64 = 1e-3;
    if axis.normalize_or_zero().cross(preferred).length() > PARALLEL {
        preferred
    } else {
        otherwise
    }
}

/// Returns the problem of an object that could not be made, placed at the key that it is about in
/// the first of `sections` that has it, or else at the header of the first.
pub(super) fn rejected(error: &TracerError, sections: &[&Section<'_>]) -> Problem {
    let key = key_of(error);
    let section = sections.iter().find(|section| section.has(key));
    match section.or(sections.first()) {
        Some(section) => section.problem_with(key, error),
        None => Problem::new(error.to_string()),
    }
}

/// The key of a scene file that an error is about, or an empty string.
fn key_of(error: &TracerError) -> &str {
    match error {
        TracerError::OutOfRange { parameter, .. } | TracerError::Direction { parameter, .. } => {
            parameter
        }
        TracerError::Resolution { .. } => "resolution",
        TracerError::Beam(error) => key_of_beam(error),
        _ => "",
    }
}

fn key_of_beam(error: &BeamError) -> &str {
    match error {
        BeamError::Wavelength(_) => "wavelength",
        BeamError::WaistRadius(_) | BeamError::NotParaxial { .. } => "waist_radius",
        BeamError::MSquared(_) => "m_squared",
        BeamError::FanAngle(_) => "fan_angle",
        BeamError::ApexOffset { .. } => "apex_offset",
        BeamError::FocusDistance(_) => "focus_distance",
        BeamError::Edge(_) => "edge",
        BeamError::WaistDistance(_) => "waist_distance",
        BeamError::Power(_) => "power",
        BeamError::Origin(_) => "position",
        BeamError::Direction(_) => "look_at",
        BeamError::FanAxis(_) => "line_direction",
        _ => "",
    }
}
