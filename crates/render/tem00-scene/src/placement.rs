use glam::DVec3;
use tem00_config::{Problem, Section, Value};

/// Position of an object and the point that it looks at, two different points in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) position: DVec3,
    pub(crate) look_at: DVec3,
}

impl Placement {
    /// Reads `position` and `look_at`; without the latter, the origin is looked at.
    pub(crate) fn read(section: &Section<'_>) -> Result<Self, Problem> {
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
    pub(crate) fn axis(&self) -> DVec3 {
        self.look_at - self.position
    }
}

/// Returns `preferred`, unless it is parallel to `axis` within a milliradian: then `otherwise`.
pub(crate) fn across(axis: DVec3, preferred: DVec3, otherwise: DVec3) -> DVec3 {
    const PARALLEL: f64 = 1e-3;
    if axis.normalize_or_zero().cross(preferred).length() > PARALLEL {
        preferred
    } else {
        otherwise
    }
}
