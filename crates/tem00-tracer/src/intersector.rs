mod primitive;

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    cwbvh::{CwBvh, builder::build_cwbvh},
    ray::RayHit,
};

use self::primitive::{Primitive, ShearedRay};
use crate::{Hit, Ray, Shape, TracerError};

/// Finds where rays meet shapes.
///
/// A hierarchy of boxes in single precision finds the candidates, and tests in double precision
/// decide. The boxes are padded by more than single precision can err, so the answers are those of
/// double precision throughout.
///
/// # Validity
///
/// Hit points lie on their surface within 1e−15 of the scene's largest coordinate, and along the
/// ray within that divided by the cosine of incidence. No ray passes between two triangles of a mesh
/// that share an edge.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_tracer::{Intersector, Ray, Shape, Sphere};
///
/// let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 0.01)?);
/// let intersector = Intersector::build(&[ball])?;
///
/// let ray = Ray { origin: DVec3::new(0.0, 0.0, 0.5), direction: -DVec3::Z };
/// let hit = intersector.intersect(&ray).unwrap();
/// assert!((hit.distance - 0.49).abs() < 1e-15);
/// assert_eq!(hit.normal, DVec3::Z);
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Intersector {
    boxes: CwBvh,
    primitives: Vec<Primitive>,
    /// The shape to which each primitive belongs.
    surfaces: Vec<usize>,
    /// The centre of a sphere around everything, in metres.
    centre: DVec3,
    /// The radius of that sphere, in metres: the unit of the boxes.
    radius: f64,
    /// By how much a computed point may be off its surface, in metres.
    clearance: f64,
}

/// How far the boxes extend beyond what they hold, in units of the bounding sphere's radius.
///
/// With u = 2⁻²⁴ the rounding of single precision, origins within √2 of the centre, boxes within 1
/// and distances up to 2, the plane of a box is met at its true distance once it is moved by
///
/// ```text
/// 1.5 u          rounding of the origin
/// 4.1 u          rounding of the direction, and its components below 2⁻²³, which count as 2⁻²³
/// 9.4 u          (plane − origin) / direction, in four operations
/// 11 u           rounding of the boxes themselves, and of their 8-bit coordinates in the nodes
/// ```
///
/// which is 26 u. The padding is 64 u.
const PADDING: f64 = 1.0 / (1 << 18) as f64;

/// How far before their origin rays start in the hierarchy, in the same unit.
///
/// The nodes of obvhs ignore what ends within 1e−4 of the start.
const RUN_UP: f64 = 1.0 / (1 << 12) as f64;

impl Intersector {
    /// Builds the hierarchy over `shapes`.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no shapes, if they reach farther than 1e9 m from the origin,
    /// if together they are smaller than 1e−12 m, or if they have more than 2³¹ triangles.
    pub fn build(shapes: &[Shape]) -> Result<Self, TracerError> {
        let (primitives, surfaces) = collect(shapes);
        let (low, high) = primitives.iter().map(Primitive::bounds).fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), bounds| (low.min(bounds.0), high.max(bounds.1)),
        );
        let radius = 0.5 * (high - low).length();
        let reach = low.abs().max(high.abs()).max_element();
        check(primitives.len(), reach, radius)?;
        let mut intersector = Self {
            boxes: CwBvh::default(),
            primitives,
            surfaces,
            centre: 0.5 * (low + high),
            radius,
            clearance: clearance(reach),
        };
        let boxes: Vec<Aabb> = intersector
            .primitives
            .iter()
            .map(|primitive| intersector.padded_box(primitive))
            .collect();
        let preset = BvhBuildParams {
            pre_split: false,
            ..BvhBuildParams::slow_build()
        };
        intersector.boxes = build_cwbvh(&boxes, preset, &mut Duration::default());
        Ok(intersector)
    }

    /// Returns the nearest point in front of the ray's origin where it meets a shape.
    ///
    /// Of shapes met at the same distance, the first in the list given to [`build`](Self::build)
    /// counts. To follow light on from a hit, [`leave`](Self::leave) the surface first.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let traversal = self.enter(ray)?;
        let sheared = ShearedRay::new(*ray);
        let mut nearest: Option<(f64, u32)> = None;
        let hit = &mut RayHit::none();
        self.boxes
            .ray_traverse(traversal.ray(f64::INFINITY), hit, |_, slot| {
                let index = self.boxes.primitive_indices[slot];
                match self.primitives[index as usize].distance(&sheared) {
                    Some(distance) if nearest.is_none_or(|best| (distance, index) < best) => {
                        nearest = Some((distance, index));
                        traversal.end(distance)
                    }
                    _ => f32::INFINITY,
                }
            });
        let (distance, index) = nearest?;
        let (position, normal) = self.primitives[index as usize].point_and_normal(&sheared)?;
        Some(Hit {
            distance,
            position,
            normal,
            surface: self.surfaces[index as usize],
        })
    }

    /// Tells whether nothing stands between a surface point and another point.
    ///
    /// `from` lies on a surface with the unit normal `from_normal`, of either sign; that surface
    /// does not hide `to` at either side. A surface on which `to` lies does not hide it.
    pub fn visible(&self, from: DVec3, from_normal: DVec3, to: DVec3) -> bool {
        let side = from_normal.dot(to - from);
        let origin = self.leave(
            from,
            if side < 0.0 {
                -from_normal
            } else {
                from_normal
            },
        );
        let Some(direction) = (to - origin).try_normalize() else {
            return true;
        };
        let ray = Ray { origin, direction };
        let Some(traversal) = self.enter(&ray) else {
            return true;
        };
        let length = (to - origin).length();
        let sheared = ShearedRay::new(ray);
        self.boxes
            .ray_traverse_miss(traversal.ray(length), |_, slot| {
                let index = self.boxes.primitive_indices[slot];
                if self.hides(
                    &self.primitives[index as usize],
                    &sheared,
                    direction,
                    length,
                ) {
                    0.0
                } else {
                    f32::INFINITY
                }
            })
    }

    /// Returns a surface point moved along `normal`, of unit length, until a ray from there cannot
    /// meet the same surface by rounding.
    ///
    /// The normal points to the side on which the ray goes on. The step is 2⁻⁴⁵ of the scene's
    /// largest coordinate: 3e−14 m in a scene of a metre.
    #[must_use]
    pub fn leave(&self, position: DVec3, normal: DVec3) -> DVec3 {
        position + self.clearance * normal
    }

    /// Tells whether a primitive stands in the way, unless it is what the ray ends on.
    fn hides(
        &self,
        primitive: &Primitive,
        ray: &ShearedRay,
        direction: DVec3,
        length: f64,
    ) -> bool {
        let Some(distance) = primitive.distance(ray).filter(|&met| met < length) else {
            return false;
        };
        // The height of the ray's end above the primitive's tangent plane.
        let height =
            |(_, normal): (DVec3, DVec3)| (length - distance) * normal.dot(direction).abs();
        primitive
            .point_and_normal(ray)
            .is_some_and(|met| height(met) > self.clearance)
    }

    fn padded_box(&self, primitive: &Primitive) -> Aabb {
        let (low, high) = primitive.bounds();
        Aabb::new(
            self.single(low - PADDING * self.radius),
            self.single(high + PADDING * self.radius),
        )
    }

    /// Returns a point in the unit and about the centre of the boxes.
    fn single(&self, point: DVec3) -> Vec3A {
        ((point - self.centre) / self.radius).as_vec3a()
    }

    /// Returns where a ray enters the surroundings of the bounding sphere, unless it passes by.
    fn enter(&self, ray: &Ray) -> Option<Traversal> {
        let Ray { origin, direction } = *ray;
        if !(origin.is_finite() && direction.is_finite()) {
            return None;
        }
        let offset = self.centre - origin;
        let middle = offset.dot(direction);
        let miss = (offset - middle * direction).length();
        let reach = (1.0 + PADDING) * self.radius;
        if miss > reach || middle < -reach {
            return None;
        }
        let start = (middle - self.radius).max(0.0) - RUN_UP * self.radius;
        // Adding 0 turns −0 into +0, for which obvhs does not confuse the sides of a box.
        Some(Traversal {
            origin: self.single(origin + start * direction),
            direction: direction.as_vec3a() + Vec3A::ZERO,
            start,
            radius: self.radius,
        })
    }
}

/// A ray in the unit of the boxes.
#[derive(Clone, Copy, Debug)]
struct Traversal {
    origin: Vec3A,
    direction: Vec3A,
    /// The distance along the ray at which the traversal starts, in metres.
    start: f64,
    radius: f64,
}

impl Traversal {
    fn ray(&self, distance: f64) -> obvhs::ray::Ray {
        obvhs::ray::Ray::new(self.origin, self.direction, 0.0, self.end(distance))
    }

    /// Returns a distance from the ray's origin, in metres, in the unit of the boxes, rounded up.
    fn end(&self, distance: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "rounded up right after")]
        let end = ((distance - self.start) / self.radius) as f32;
        end.next_up()
    }
}

fn collect(shapes: &[Shape]) -> (Vec<Primitive>, Vec<usize>) {
    let mut primitives = Vec::new();
    let mut surfaces = Vec::new();
    for (surface, shape) in shapes.iter().enumerate() {
        match shape {
            Shape::Rectangle(rectangle) => primitives.push(Primitive::Rectangle(*rectangle)),
            Shape::Sphere(sphere) => primitives.push(Primitive::Sphere(*sphere)),
            Shape::Mesh(mesh) => primitives.extend(mesh.corners().map(Primitive::Triangle)),
        }
        surfaces.resize(primitives.len(), surface);
    }
    (primitives, surfaces)
}

fn check(primitives: usize, reach: f64, radius: f64) -> Result<(), TracerError> {
    const MOST: usize = 1 << 31;
    if primitives == 0 {
        return Err(TracerError::Missing("a surface"));
    }
    if primitives > MOST {
        return Err(TracerError::OutOfRange {
            parameter: "number of triangles",
            value: primitives as f64,
            allowed: "at most 2^31",
        });
    }
    if reach.is_nan() || reach > 1e9 {
        return Err(TracerError::OutOfRange {
            parameter: "coordinate of a shape",
            value: reach,
            allowed: "within 1e9 m of the origin",
        });
    }
    if radius < 1e-12 {
        return Err(TracerError::OutOfRange {
            parameter: "extent of all shapes",
            value: radius,
            allowed: "at least 1e-12 m",
        });
    }
    Ok(())
}

/// Returns by how much a computed point may be off its surface, in metres, where no coordinate
/// exceeds `reach`.
///
/// With u = 2⁻⁵³: composing a point from three others costs 7 u √3 `reach`. The next test then sees
/// that point at the wrong side of the surface by what its corners move in sheared coordinates,
/// five roundings of distances up to 2√3 `reach` in each of two axes: 25 u `reach`; and by the
/// weights, four roundings: 14 u `reach`. The sum, 51 u `reach`, is below a quarter of 2⁻⁴⁵ `reach`.
fn clearance(reach: f64) -> f64 {
    const STEP: f64 = 256.0 * (f64::EPSILON / 2.0);
    STEP * reach
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use proptest::prelude::*;

    use super::*;
    use crate::{Rectangle, Sphere, TriangleMesh};

    fn rectangle(centre: DVec3, half_u: DVec3, half_v: DVec3) -> Shape {
        Shape::Rectangle(Rectangle::new(centre, half_u, half_v).unwrap())
    }

    fn sphere(centre: DVec3, radius: f64) -> Shape {
        Shape::Sphere(Sphere::new(centre, radius).unwrap())
    }

    fn build(shapes: &[Shape]) -> Intersector {
        Intersector::build(shapes).unwrap()
    }

    fn ray(origin: DVec3, direction: DVec3) -> Ray {
        Ray {
            origin,
            direction: direction.normalize(),
        }
    }

    fn direction(cosine: f64, azimuth: f64) -> DVec3 {
        let radius = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
        DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), cosine)
    }

    /// Uniform numbers in [0, 1) from `SplitMix64`.
    fn uniforms(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53)
        }
    }

    /// A closed, bumpy ball around the origin: `rings` × 2 `rings` quadrilaterals, each two
    /// triangles, and triangles at the poles.
    fn ball(rings: u32, radius: f64) -> TriangleMesh {
        let sectors = 2 * rings;
        let mut vertices = vec![radius * DVec3::Z, -radius * DVec3::Z];
        let index = |ring: u32, sector: u32| 2 + (ring - 1) * sectors + sector % sectors;
        for ring in 1..rings {
            for sector in 0..sectors {
                let (theta, phi) = (
                    PI * f64::from(ring) / f64::from(rings),
                    TAU * f64::from(sector) / f64::from(sectors),
                );
                let bumpy = radius * (1.0 + 0.1 * (5.0 * theta).sin() * (3.0 * phi).cos());
                vertices.push(bumpy * direction(theta.cos(), phi));
            }
        }
        let mut triangles = Vec::new();
        for sector in 0..sectors {
            triangles.push([0, index(1, sector), index(1, sector + 1)]);
            triangles.push([1, index(rings - 1, sector + 1), index(rings - 1, sector)]);
            for ring in 1..rings - 1 {
                let (a, b) = (index(ring, sector), index(ring, sector + 1));
                let (c, d) = (index(ring + 1, sector), index(ring + 1, sector + 1));
                triangles.push([a, c, d]);
                triangles.push([a, d, b]);
            }
        }
        TriangleMesh::new(vertices, triangles).unwrap()
    }

    fn mixed_scene() -> Vec<Shape> {
        vec![
            rectangle(DVec3::new(0.0, 0.0, -0.3), 0.5 * DVec3::X, 0.4 * DVec3::Y),
            Shape::Mesh(ball(12, 0.1)),
            sphere(DVec3::new(0.2, 0.1, 0.0), 0.05),
            sphere(DVec3::new(-0.2, 0.15, -0.1), 1e-4),
            Shape::Mesh(ball(6, 0.004)).translated(DVec3::new(-0.1, -0.2, 0.2)),
            rectangle(
                DVec3::new(0.0, 0.2, 0.2),
                DVec3::new(0.01, 0.02, 0.02),
                DVec3::new(0.02, -0.02, 0.01),
            ),
        ]
    }

    /// The nearest hit among all primitives, without a hierarchy.
    fn brute_force(shapes: &[Shape], ray: &Ray) -> Option<(f64, usize)> {
        let (primitives, surfaces) = collect(shapes);
        let sheared = ShearedRay::new(*ray);
        primitives
            .iter()
            .zip(surfaces)
            .filter_map(|(primitive, surface)| Some((primitive.distance(&sheared)?, surface)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    #[test]
    fn a_plane_is_met_where_geometry_says() {
        // A wall at x = 0.5 m that faces back to the origin.
        let wall = rectangle(0.5 * DVec3::X, DVec3::Z, DVec3::Y);
        let wall = build(&[wall]);
        for tangent in [0.0, 0.3, 1.0, 1.9] {
            let ray = ray(DVec3::ZERO, DVec3::new(1.0, tangent, 0.0));
            let hit = wall.intersect(&ray).unwrap();
            let distance = 0.5 * 1.0_f64.hypot(tangent);
            // Ten roundings of numbers up to 1.1.
            assert!((hit.distance - distance).abs() < 1e-15, "{}", hit.distance);
            let position = DVec3::new(0.5, 0.5 * tangent, 0.0);
            assert!(
                hit.position.abs_diff_eq(position, 1e-15),
                "{}",
                hit.position
            );
            assert!(hit.normal.abs_diff_eq(-DVec3::X, 1e-15), "{}", hit.normal);
        }
        let past = ray(DVec3::ZERO, DVec3::new(1.0, 2.1, 0.0));
        assert_eq!(wall.intersect(&past), None, "beyond the edge at 1 m");
        let away = ray(DVec3::ZERO, -DVec3::X);
        assert_eq!(wall.intersect(&away), None, "behind");
        let along = ray(DVec3::new(0.5, -2.0, 0.0), DVec3::Y);
        assert_eq!(wall.intersect(&along), None, "in the plane");
    }

    #[test]
    fn a_ball_is_met_where_geometry_says() {
        let ball = build(&[sphere(DVec3::new(0.0, 0.0, 0.5), 0.02)]);
        for miss in [0.0, 0.005, 0.019, 0.019_999_999] {
            let ray = ray(DVec3::new(miss, 0.0, 0.0), DVec3::Z);
            let hit = ball.intersect(&ray).unwrap();
            let half_chord = ((0.02 - miss) * (0.02 + miss)).sqrt();
            // The half chord c changes by Δmiss r/c for a rounding of the 0.5 m: c is 2e−5 m last.
            let tolerance = 1e-15 + 2e-16 * 0.02 / half_chord;
            let distance = 0.5 - half_chord;
            assert!((hit.distance - distance).abs() < tolerance, "miss = {miss}");
            let normal = DVec3::new(miss, 0.0, -half_chord) / 0.02;
            // Relative to the radius, 1 / 0.02 times as much.
            assert!(
                hit.normal.abs_diff_eq(normal, 50.0 * tolerance),
                "miss = {miss}"
            );
        }
        let past = ray(DVec3::new(0.020_000_001, 0.0, 0.0), DVec3::Z);
        assert_eq!(ball.intersect(&past), None, "just beside");
        let away = ray(DVec3::ZERO, -DVec3::Z);
        assert_eq!(ball.intersect(&away), None, "behind");
    }

    #[test]
    fn from_inside_the_far_side_of_a_ball_is_met_with_its_outward_normal() {
        let ball = build(&[sphere(DVec3::ONE, 0.1)]);
        let inside = ray(DVec3::new(1.0, 1.0, 1.06), DVec3::Z);
        let hit = ball.intersect(&inside).unwrap();
        assert!((hit.distance - 0.04).abs() < 1e-15, "{}", hit.distance);
        assert!(hit.normal.abs_diff_eq(DVec3::Z, 1e-14), "{}", hit.normal);
        let back = ray(DVec3::new(1.0, 1.0, 1.06), -DVec3::Z);
        let hit = ball.intersect(&back).unwrap();
        assert!((hit.distance - 0.16).abs() < 1e-15, "{}", hit.distance);
    }

    #[test]
    fn triangle_normals_follow_the_order_of_corners_and_never_flip() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let mesh = Shape::Mesh(TriangleMesh::new(vertices, vec![[0, 1, 2]]).unwrap());
        let mesh = build(&[mesh]);
        for side in [1.0, -1.0] {
            let ray = ray(DVec3::new(0.25, 0.5, side), -side * DVec3::Z);
            let hit = mesh.intersect(&ray).unwrap();
            assert_eq!(hit.normal, DVec3::Z, "seen from z = {side}");
            assert!((hit.distance - 1.0).abs() < 1e-15, "{}", hit.distance);
            assert_eq!(hit.position, DVec3::new(0.25, 0.5, 0.0), "position");
        }
    }

    #[test]
    fn grazing_rays_meet_a_mesh_to_a_nanometre_at_half_a_metre() {
        // A floor of two triangles, 1 m long, met 0.5 m away at 0.01°, 0.001° …
        let vertices = [(-1.0, -0.1), (1.0, -0.1), (1.0, 0.1), (-1.0, 0.1)];
        let vertices = vertices.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let floor = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let floor = build(&[Shape::Mesh(floor)]);
        for height in [0.1, 1e-4, 1e-6] {
            let target = DVec3::new(0.123, 0.03, 0.0);
            let origin = target + DVec3::new(-0.5, 0.0, height);
            let hit = floor.intersect(&ray(origin, target - origin)).unwrap();
            // The direction is rounded to 1e−16: 0.5 m · 1e−16 · 0.5 / height along the floor.
            let tolerance = 1e-15 + 2e-16 / height;
            assert!(tolerance < 1e-9, "the promise");
            assert!(
                hit.position.abs_diff_eq(target, tolerance),
                "{}",
                hit.position
            );
            assert!(
                hit.position.z.abs() < 1e-16,
                "on the floor: {}",
                hit.position.z
            );
        }
    }

    #[test]
    fn hierarchy_and_brute_force_agree_on_every_ray() {
        let shapes = mixed_scene();
        let intersector = build(&shapes);
        let mut uniform = uniforms(1);
        let mut hits = 0;
        for i in 0..4000 {
            let mut point = || DVec3::new(uniform(), uniform(), uniform()) - 0.5;
            // Toward the middle from near and far, and anywhere.
            let (from, to) = (point(), 0.2 * point());
            let far = if i % 4 == 0 { 1e3 } else { 1.0 };
            let ray = ray(to + far * (from - to), to - from);
            let found = intersector.intersect(&ray).map(|hit| hit.distance);
            let expected = brute_force(&shapes, &ray).map(|(distance, _)| distance);
            assert_eq!(found, expected, "{ray:?}");
            hits += u32::from(found.is_some());
        }
        assert!(hits > 1000, "{hits} hits");
    }

    #[test]
    fn axis_parallel_rays_are_found_whatever_the_sign_of_zero() {
        let shapes = mixed_scene();
        let intersector = build(&shapes);
        let mut uniform = uniforms(2);
        for i in 0..2000 {
            let mut direction = DVec3::splat(if i % 2 == 0 { 0.0 } else { -0.0 });
            direction[i % 3] = if i % 4 < 2 { 1.0 } else { -1.0 };
            if i % 5 == 0 {
                // Rounded to single precision this is −0.
                direction[(i + 1) % 3] = -1e-60;
            }
            let place = 0.5 * (DVec3::new(uniform(), uniform(), uniform()) - 0.5);
            let ray = Ray {
                origin: place - direction,
                direction,
            };
            let found = intersector.intersect(&ray).map(|hit| hit.distance);
            let expected = brute_force(&shapes, &ray).map(|(distance, _)| distance);
            assert_eq!(found, expected, "{ray:?}");
        }
    }

    #[test]
    fn near_hits_are_found_in_scenes_of_any_size() {
        // The same scene a million times smaller and larger; hits a thousandth of it away.
        for size in [1e-6, 1.0, 1e6] {
            let ball = build(&[
                sphere(DVec3::ZERO, size),
                sphere(3.0 * size * DVec3::X, size),
            ]);
            for gap in [0.5, 1e-3, 1e-6, 1e-9] {
                let ray = ray(size * (1.0 + gap) * DVec3::Z, -DVec3::Z);
                let hit = ball.intersect(&ray).unwrap();
                let error = (hit.distance - gap * size).abs();
                assert!(error < 5e-16 * size, "size {size}, gap {gap}: {error}");
            }
        }
    }

    #[test]
    fn no_ray_leaves_a_closed_mesh_through_an_edge_or_a_corner() {
        let mesh = ball(10, 0.1);
        let shape = Shape::Mesh(mesh.clone()).translated(DVec3::new(0.3, 0.2, 0.7));
        let Shape::Mesh(moved) = &shape else {
            unreachable!("still a mesh")
        };
        let intersector = build(std::slice::from_ref(&shape));
        let inside = DVec3::new(0.31, 0.19, 0.72);
        for corners in moved.corners() {
            let [a, b, c] = corners;
            for target in [
                a,
                b,
                c,
                0.5 * (a + b),
                0.25 * a + 0.75 * c,
                0.3 * b + 0.7 * c,
            ] {
                let hit = intersector.intersect(&ray(inside, target - inside));
                let hit = hit.unwrap_or_else(|| panic!("the ray to {target} left the mesh"));
                assert!(
                    hit.position.abs_diff_eq(target, 1e-15),
                    "{} is not {target}",
                    hit.position
                );
                assert!(hit.normal.dot(target - inside) > 0.0, "outward from inside");
            }
        }
    }

    #[test]
    fn the_surface_is_the_index_of_the_shape_and_ties_go_to_the_first() {
        let shapes = mixed_scene();
        let intersector = build(&shapes);
        for (target, surface) in [
            (DVec3::new(0.4, 0.3, -0.3), 0),
            (DVec3::new(0.0, 0.0, 0.0), 1),
            (DVec3::new(0.2, 0.1, 0.0), 2),
            (DVec3::new(-0.2, 0.15, -0.1), 3),
            (DVec3::new(-0.1, -0.2, 0.2), 4),
            (DVec3::new(0.0, 0.2, 0.2), 5),
        ] {
            let hit = intersector
                .intersect(&ray(target + DVec3::Z, -DVec3::Z))
                .unwrap();
            assert_eq!(hit.surface, surface, "above {target}");
        }
        let sheet = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let twins = build(&[sheet.clone(), sheet.clone(), sheet]);
        let hit = twins
            .intersect(&ray(DVec3::new(0.2, 0.3, 1.0), -DVec3::Z))
            .unwrap();
        assert_eq!(hit.surface, 0, "the first of three");
    }

    proptest! {
        #[test]
        fn a_ray_that_leaves_a_surface_does_not_meet_it_again(
            (x, y) in (-0.9_f64..0.9, -0.9_f64..0.9),
            exponent in -12.0_f64..0.0,
            azimuth in 0.0_f64..6.3,
            tilt in (-1.0_f64..1.0, 0.0_f64..6.3),
            below in any::<bool>(),
        ) {
            // A tilted plane as rectangle and as mesh, away from the origin, and a ball; points on
            // them found from afar; rays that leave upwards by 10^exponent of a right angle.
            let up = direction(tilt.0, tilt.1);
            let frame = crate::LocalFrame::from_normal(up);
            let (u, v) = (frame.tangent(), frame.bitangent());
            let centre = DVec3::new(0.3, -0.2, 0.4);
            let corners = vec![centre - u - v, centre + u - v, centre + u + v, centre - u + v];
            let mesh = TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
            for shape in [rectangle(centre, u, v), Shape::Mesh(mesh), sphere(centre - up, 1.0)] {
                let alone = build(&[shape]);
                let side = if below { -1.0 } else { 1.0 };
                let above = centre + 0.7 * (x * u + y * v) + side * 0.5 * up;
                let Some(hit) = alone.intersect(&ray(above, -side * up)) else { continue };
                let normal = side * hit.normal;
                let axes = crate::LocalFrame::from_normal(normal);
                let goes = axes.to_world(direction(10.0_f64.powf(exponent), azimuth));
                let next = alone.intersect(&ray(alone.leave(hit.position, normal), goes));
                // From inside, a ball is met again, on its other side.
                let through = next.is_none_or(|next| next.distance > 1e-13 && next.normal.dot(normal) < 1.0);
                let flat = !matches!(alone.primitives[0], Primitive::Sphere(_));
                prop_assert!(if flat { next.is_none() } else { through }, "met again: {next:?}");
                prop_assert!(alone.visible(hit.position, hit.normal, hit.position + 2.0 * goes)
                    == (flat || !below), "visible from the surface");
            }
        }
    }

    #[test]
    fn a_sheet_one_nanometre_above_half_a_metre_of_floor_hides_the_light() {
        let floor = rectangle(0.5 * DVec3::ONE, 0.5 * DVec3::X, 0.5 * DVec3::Y);
        let sheet = floor.translated(1e-9 * DVec3::Z);
        let light = DVec3::new(0.5, 0.5, 1.0);
        let (open, covered) = (build(std::slice::from_ref(&floor)), build(&[floor, sheet]));
        for x in [0.1, 0.5, 0.9] {
            let point = DVec3::new(x, 0.3, 0.5);
            assert!(open.visible(point, DVec3::Z, light), "open at {x}");
            assert!(
                open.visible(point, -DVec3::Z, light),
                "open, normal down, at {x}"
            );
            assert!(!covered.visible(point, DVec3::Z, light), "covered at {x}");
            let above = point + 1e-9 * DVec3::Z;
            assert!(
                covered.visible(above, DVec3::Z, light),
                "on the sheet at {x}"
            );
            assert!(
                !covered.visible(above, DVec3::Z, light.with_z(0.0)),
                "under it at {x}"
            );
        }
    }

    #[test]
    fn a_lamp_does_not_hide_itself_but_what_is_before_it_does() {
        let floor = rectangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let lamp = Rectangle::new(
            DVec3::new(0.3, 0.1, 0.8),
            DVec3::new(0.1, 0.0, 0.05),
            DVec3::new(0.0, -0.1, 0.0),
        )
        .unwrap();
        let post = sphere(DVec3::new(0.15, 0.05, 0.4), 0.001);
        let open = build(&[floor.clone(), Shape::Rectangle(lamp)]);
        let blocked = build(&[floor, Shape::Rectangle(lamp), post]);
        let mut uniform = uniforms(3);
        for _ in 0..500 {
            let on_lamp = lamp.point(uniform(), uniform());
            let on_floor = DVec3::new(uniform() - 0.5, uniform() - 0.5, 0.0);
            assert!(
                open.visible(on_floor, DVec3::Z, on_lamp),
                "{on_floor} to {on_lamp}"
            );
        }
        assert!(
            !blocked.visible(DVec3::ZERO, DVec3::Z, lamp.centre()),
            "the post is in the middle"
        );
        assert!(
            blocked.visible(0.1 * DVec3::X, DVec3::Z, lamp.centre()),
            "beside the post"
        );
    }

    #[test]
    fn a_point_sees_itself_and_what_is_outside_the_scene() {
        let floor = build(&[rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
        assert!(floor.visible(DVec3::ZERO, DVec3::Z, DVec3::ZERO), "itself");
        assert!(
            floor.visible(DVec3::ZERO, DVec3::Z, 1e6 * DVec3::Z),
            "far away"
        );
        let below = DVec3::new(0.0, 0.0, -1.0);
        assert!(
            !floor.visible(1e3 * DVec3::Z, DVec3::Z, below),
            "through the floor"
        );
    }

    #[test]
    fn rays_that_are_no_rays_meet_nothing() {
        let floor = build(&[rectangle(DVec3::ZERO, DVec3::X, DVec3::Y)]);
        for (origin, direction) in [
            (DVec3::NAN, DVec3::Z),
            (DVec3::Z, DVec3::NAN),
            (DVec3::Z, DVec3::ZERO),
            (DVec3::INFINITY, -DVec3::Z),
        ] {
            assert_eq!(
                floor.intersect(&Ray { origin, direction }),
                None,
                "{origin} {direction}"
            );
        }
    }

    #[test]
    fn scenes_without_shapes_or_of_impossible_size_are_refused() {
        let empty = Intersector::build(&[]).unwrap_err();
        assert_eq!(empty, TracerError::Missing("a surface"), "{empty}");
        for (shape, name) in [
            (sphere(DVec3::ZERO, 1e10), "coordinate of a shape"),
            (sphere(DVec3::ZERO, 1e-13), "extent of all shapes"),
            (
                sphere(DVec3::ZERO, 1.0).translated(DVec3::NAN),
                "coordinate of a shape",
            ),
        ] {
            let result = Intersector::build(&[shape]);
            assert!(
                matches!(result, Err(TracerError::OutOfRange { parameter, .. }) if parameter == name),
                "{name}: {result:?}"
            );
        }
    }

    #[test]
    fn intersectors_are_shared_between_threads() {
        fn shared<T: Send + Sync>() {}
        shared::<Intersector>();
    }
}
