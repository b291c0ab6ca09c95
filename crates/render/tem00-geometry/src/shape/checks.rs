use glam::DVec3;
use tem00_numerics::check;

use crate::Refusal;

pub(super) fn check_point(parameter: &'static str, point: DVec3) -> Result<(), Refusal> {
    let components = point.to_array();
    check::that(
        point.is_finite(),
        parameter,
        components,
        "",
        "a finite point",
    )
}

/// Returns a vector of unit length along `vector`.
pub(super) fn unit_vector(parameter: &'static str, vector: DVec3) -> Result<DVec3, Refusal> {
    let allowed = "a finite vector longer than zero";
    vector
        .try_normalize()
        .ok_or_else(|| Refusal::new(parameter, vector.to_array(), allowed))
}
