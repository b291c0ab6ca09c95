//! Checks of vectors.

use glam::DVec3;

use crate::Refusal;

/// Returns a position or displacement, in metres, if it is finite.
pub(crate) fn finite(parameter: &'static str, vector: DVec3) -> Result<DVec3, Refusal> {
    if vector.is_finite() {
        Ok(vector)
    } else {
        Err(Refusal::new(parameter, vector.to_array(), "finite").in_unit("m"))
    }
}

/// Returns the unit vector along a vector, if the vector has a direction.
pub(crate) fn unit(parameter: &'static str, vector: DVec3) -> Result<DVec3, Refusal> {
    let refused = || Refusal::new(parameter, vector.to_array(), "finite and not zero");
    vector.try_normalize().ok_or_else(refused)
}
