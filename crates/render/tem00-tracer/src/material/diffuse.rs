use core::f64::consts::FRAC_1_PI;

use glam::{DVec2, DVec3};
use tem00_numerics::circle_point_at_turn;

/// The largest uniform number below 1.
const LARGEST: f64 = 1.0 - f64::EPSILON / 2.0;

/// Draws a direction above the surface with the density [`cosine_pdf`].
pub(super) fn sample_cosine([u, v]: [f64; 2]) -> DVec3 {
    let radius = u.sqrt();
    (radius * DVec2::from(circle_point_at_turn(v))).extend((1.0 - u).sqrt())
}

/// Returns `cos θ / π`, per steradian.
pub(super) fn cosine_pdf(wi: DVec3) -> f64 {
    wi.z * FRAC_1_PI
}

/// Draws a direction above the surface with the density `1 / (2π)`.
pub(super) fn sample_hemisphere([u, v]: [f64; 2]) -> DVec3 {
    let cosine = 1.0 - u;
    let radius = (u * (1.0 + cosine)).sqrt();
    (radius * DVec2::from(circle_point_at_turn(v))).extend(cosine)
}

/// Chooses the first of two lobes with `probability` by `u`, which is uniform again afterwards.
pub(super) fn choose_first(probability: f64, u: f64) -> (bool, f64) {
    if u < probability {
        (true, (u / probability).min(LARGEST))
    } else {
        (
            false,
            ((u - probability) / (1.0 - probability)).min(LARGEST),
        )
    }
}
