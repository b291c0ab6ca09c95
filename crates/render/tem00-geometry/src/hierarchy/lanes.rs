//! Tests in single precision, on many rays or many boxes at once.

use fearless_simd::{Simd, prelude::*};

/// Rays, one in each lane, in the unit of a hierarchy.
#[derive(Clone, Copy)]
pub(crate) struct RayLanes<V> {
    pub origin: [V; 3],
    pub direction: [V; 3],
    /// The reciprocals of the direction's components, which are finite.
    pub inverse: [V; 3],
    /// The distance beyond which nothing matters; finite.
    pub end: V,
}

/// Triangles, one in each lane: a corner, and the edges from there to the two others.
#[derive(Clone, Copy)]
pub(crate) struct TriangleLanes<V> {
    pub corner: [V; 3],
    pub edges: [[V; 3]; 2],
    /// [`TOLERANCE`] times the length of the longer edge.
    pub tolerance: V,
}

/// The error of single precision about a triangle, in units of the longer edge of the two.
///
/// In the unit of the hierarchy the origin o of a ray lies within √2 of the centre, the corner c
/// within 1, and edges e₁, e₂ ≤ L are at most 2 long. With u = 2⁻²⁴ the roundings of inputs and
/// operations sum up to
///
/// ```text
/// T = o − c                  6.1 u
/// P = d × e₂                 4.9 u L
/// Q = T × e₁                15.8 u L
/// U = T · P                 25.3 u L         V = d · Q        25.2 u L
/// D = e₁ · P                 8.9 u L²        W = D − U − V      82 u L
/// N = e₂ · Q                25.5 u L²        (distance = N / D)
/// ```
///
/// Where the sign of D itself is in doubt, a ray that meets the triangle has |U|, |V|, |W| up to
/// 118 u L and |N| up to 77 u L². Both, and 60 u L² for N − end · D, are below 128 u.
pub(crate) const TOLERANCE: f32 = 128.0 / (1 << 24) as f32;

/// Lanes in which a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    /// Lanes in which the ray may hit.
    pub possibly: u64,
    /// Lanes in which the ray hits for certain.
    pub certainly: u64,
}

/// Returns the distances at which rays enter boxes, and the lanes in which they meet them.
#[inline(always)]
pub(crate) fn meet_boxes<S: Simd, V: SimdFloat<S, Element = f32>>(
    ray: &RayLanes<V>,
    low: [V; 3],
    high: [V; 3],
) -> (V, u64) {
    let simd = ray.end.token();
    let (mut near, mut far) = (V::splat(simd, 0.0), ray.end);
    for axis in 0..3 {
        let to_low = (low[axis] - ray.origin[axis]) * ray.inverse[axis];
        let to_high = (high[axis] - ray.origin[axis]) * ray.inverse[axis];
        near = near.max(to_low.min(to_high));
        far = far.min(to_low.max(to_high));
    }
    (near, near.simd_le(far).to_bitmask())
}

/// Returns the lanes in which rays meet triangles (Möller and Trumbore 1997, without the division).
#[inline(always)]
pub(crate) fn meet_triangles<S: Simd, V: SimdFloat<S, Element = f32>>(
    ray: &RayLanes<V>,
    triangle: &TriangleLanes<V>,
) -> Met {
    let simd = ray.end.token();
    let [e1, e2] = triangle.edges;
    let t = difference(ray.origin, triangle.corner);
    let p = cross(ray.direction, e2);
    let q = cross(t, e1);
    let determinant = dot(e1, p);
    let sign = V::splat(simd, 1.0).copysign(determinant);
    let determinant = determinant.abs();
    let u = sign * dot(t, p);
    let v = sign * dot(ray.direction, q);
    let w = determinant - u - v;
    let near = sign * dot(e2, q);
    let far = ray.end * determinant - near;
    // The longer edge times itself, from 128 u L.
    let wide = triangle.tolerance;
    let deep = wide * wide * V::splat(simd, TOLERANCE.recip());
    let inside = u.min(v).min(w);
    let between = near.min(far);
    let zero = V::splat(simd, 0.0);
    let possibly = inside.simd_ge(zero - wide) & between.simd_ge(zero - deep);
    let certainly = inside.simd_gt(wide) & between.simd_gt(deep);
    Met {
        possibly: possibly.to_bitmask(),
        certainly: certainly.to_bitmask(),
    }
}

#[inline(always)]
fn difference<S: Simd, V: SimdFloat<S, Element = f32>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross<S: Simd, V: SimdFloat<S, Element = f32>>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
fn dot<S: Simd, V: SimdFloat<S, Element = f32>>(a: [V; 3], b: [V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
