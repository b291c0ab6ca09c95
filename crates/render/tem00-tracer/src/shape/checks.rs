use glam::DVec3;

use crate::TracerError;

pub(super) fn check_point(parameter: &'static str, point: DVec3) -> Result<(), TracerError> {
    if point.is_finite() {
        return Ok(());
    }
    Err(TracerError::Direction {
        parameter,
        allowed: "a finite point",
    })
}

/// Returns a vector of unit length along `vector`.
pub(super) fn unit_vector(parameter: &'static str, vector: DVec3) -> Result<DVec3, TracerError> {
    vector.try_normalize().ok_or(TracerError::Direction {
        parameter,
        allowed: "a finite vector longer than zero",
    })
}
