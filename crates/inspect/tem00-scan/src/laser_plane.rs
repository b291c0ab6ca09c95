use tem00_tracer::Laser;
use tem00_triangulation::{LaserPlane, TriangulationError};

/// Returns the plane in which the line of a laser opens.
///
/// A spot has a plane, too, the plane of its first axis; only a point of it is lit.
///
/// # Errors
///
/// Returns an error if the laser is so far away that rounding leaves no direction.
pub(crate) fn plane_of(laser: &Laser) -> Result<LaserPlane, TriangulationError> {
    let description = laser.description();
    let axis = description.look_at - description.position;
    LaserPlane::of_line(description.position, axis, description.line_direction)
}
