//! Rays as slopes against the axis of a light.

use crate::real::Real;

/// Returns `√(1 + s²)`, the length of the ray per distance along the axis.
#[inline(always)]
pub(super) fn secant<T: Real>(slope: [T; 2]) -> T {
    (T::ONE + slope[0] * slope[0] + slope[1] * slope[1]).sqrt()
}

/// Returns the unit vector of a slope, in the frame of the light.
#[inline(always)]
pub(super) fn direction<T: Real>(slope: [T; 2]) -> [T; 3] {
    let cos = T::ONE / secant(slope);
    [slope[0] * cos, slope[1] * cos, cos]
}

/// Returns the slope of a direction, unless it runs against the axis, or at right angles to it: up to
/// this cosine the cube of the secant, in the densities, is within the range of `f32`.
pub(super) fn slope_of<T: Real>(direction: [T; 3]) -> Option<[T; 2]> {
    let [x, y, z] = direction;
    (z > T::of(1e-12)).then(|| [x / z, y / z])
}

/// Follows the ray through `local` back to the aperture plane.
#[inline(always)]
pub(super) fn aperture_point<T: Real>(local: [T; 3], slope: [T; 2]) -> [T; 2] {
    let [x, y, z] = local;
    [x - slope[0] * z, y - slope[1] * z]
}

#[inline(always)]
pub(super) fn towards_light<T: Real>([x, y, z]: [T; 3]) -> [T; 3] {
    [-x, -y, -z]
}
