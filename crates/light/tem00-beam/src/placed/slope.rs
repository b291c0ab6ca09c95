//! Rays as slopes relative to the axis of a light.

/// Returns `√(1 + s²)`, the secant of the angle of a slope: the length of the ray per distance
/// along the axis.
#[inline(always)]
pub(crate) fn secant<const N: usize>(slope: [f64; N]) -> f64 {
    slope.iter().fold(1.0, |sum, s| sum + s * s).sqrt()
}

/// Returns the unit vector of a slope, in the frame of the light.
#[inline(always)]
pub(super) fn direction(slope: [f64; 2]) -> [f64; 3] {
    let cos = 1.0 / secant(slope);
    [slope[0] * cos, slope[1] * cos, cos]
}

/// Returns the slope of a direction, or `None` if it runs against the axis or perpendicular to it.
/// Down to the limiting cosine, the cube of the secant in the densities is within the range of
/// `f32`.
pub(super) fn slope_of(direction: [f64; 3]) -> Option<[f64; 2]> {
    let [x, y, z] = direction;
    (z > (1e-12)).then(|| [x / z, y / z])
}

/// Follows the ray through `local` back to the aperture plane.
#[inline(always)]
pub(super) fn aperture_point(local: [f64; 3], slope: [f64; 2]) -> [f64; 2] {
    let [x, y, z] = local;
    [x - slope[0] * z, y - slope[1] * z]
}

#[inline(always)]
pub(super) fn towards_light([x, y, z]: [f64; 3]) -> [f64; 3] {
    [-x, -y, -z]
}

/// Returns the number if `condition` holds, and 0 otherwise.
#[inline(always)]
pub(super) fn only_if(condition: bool, x: f64) -> f64 {
    if condition { x } else { 0.0 }
}
