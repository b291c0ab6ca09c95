//! The light of a laser as the class of its kind.

use pyo3::prelude::*;
use tem00_beam::LineProfile;
use tem00_shading::{BeamShape, Laser, PlacedLight};

use super::{
    emitter::Emitter,
    lights::SpotLight,
    line_lights::{LineLight, TabulatedLineLight},
};

/// Returns the placed light of a laser.
pub(crate) fn light_of<'py>(py: Python<'py>, laser: &Laser) -> PyResult<Bound<'py, Emitter>> {
    let profile = match &laser.description().shape {
        BeamShape::Line {
            profile: LineProfile::Tabulated(profile),
            ..
        } => Some(profile.clone()),
        _ => None,
    };
    Ok(match (laser.placed(), profile) {
        (PlacedLight::Spot(light), _) => SpotLight::of(py, light)?.into_bound(py).into_super(),
        (PlacedLight::Line(line), None) => LineLight::of(py, line)?.into_bound(py).into_super(),
        (PlacedLight::Line(line), Some(profile)) => TabulatedLineLight::of(py, line, profile)?
            .into_bound(py)
            .into_super(),
    })
}
