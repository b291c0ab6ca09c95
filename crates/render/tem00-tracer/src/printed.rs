//! The light of a laser by the formulas of Bergmann et al. 2016, as printed.

use glam::DVec3;
use tem00_shading::{Laser, LaserEvent, PlacedLight};

/// Returns how a laser lights `point` of a surface with the unit normal `normal`, by eq. (3) as printed.
pub(crate) fn next_event(laser: &Laser, point: DVec3, normal: DVec3) -> Option<LaserEvent> {
    let (point, normal) = (point.to_array(), normal.to_array());
    let event = match laser.placed() {
        PlacedLight::Spot(light) => tem00_paper::spot_next_event(&light, point, normal),
        PlacedLight::Line(light) => tem00_paper::line_next_event(&light, point, normal),
    }?;
    Some(LaserEvent {
        point: event.point.into(),
        wi: event.wi.into(),
        e_perp: event.radiance,
    })
}
