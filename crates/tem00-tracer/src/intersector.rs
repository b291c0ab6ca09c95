mod primitive;
mod segment;

use glam::{DVec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::reinsertion::ReinsertionOptimizer,
    cwbvh::{BRANCHING, CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh},
    ploc::PlocBuilder,
    ray::RayHit,
};

use self::primitive::{Primitive, ShearedRay};
pub use self::segment::Segment;
use crate::{Hit, MeshInstance, Ray, Shape, TracerError, mesh};

/// Finds where rays meet shapes.
///
/// A hierarchy of boxes in single precision finds the candidates, and tests in double precision
/// decide. The boxes are padded by more than single precision can err, so the answers are those of
/// double precision throughout.
///
/// # Validity
///
/// Hit points lie on their surface within 2e−15 of the scene's largest coordinate, and along the
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
    /// The first primitive of each mesh, and the mesh.
    meshes: Vec<(usize, MeshInstance)>,
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
/// 2 u            rounding of the distance at which the traversal ends
/// ```
///
/// which is 28 u. The padding is between 64 u and 128 u, different for each face of each box: the
/// builder chains boxes that coincide into a tree as deep as there are boxes, and obvhs loses what
/// lies deeper than 32 nodes. Boxes that differ at random it pairs.
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
    /// if together they are smaller than 1e−12 m, if they have more than 2³¹ triangles, or if
    /// hundreds of thousands of triangles coincide.
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
            meshes: Vec::new(),
            centre: 0.5 * (low + high),
            radius,
            clearance: clearance(reach),
        };
        let boxes: Vec<Aabb> = (0_u64..)
            .zip(&intersector.primitives)
            .map(|(index, primitive)| intersector.padded_box(primitive, index))
            .collect();
        intersector.boxes = build_hierarchy(&boxes)?;
        for (surface, shape) in shapes.iter().enumerate() {
            if let Shape::Mesh(instance) = shape {
                let first = intersector
                    .surfaces
                    .partition_point(|&other| other < surface);
                intersector.meshes.push((first, instance.clone()));
            }
        }
        Ok(intersector)
    }

    /// Returns the nearest point in front of the ray's origin where it meets a shape.
    ///
    /// Of shapes met at the same distance, the first in the list given to [`build`](Self::build)
    /// counts. To follow light on from a hit, [`leave`](Self::leave) the surface first.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let traversal = self.enter(ray)?;
        let sheared = ShearedRay::new(*ray);
        let mut nearest = None;
        let hit = &mut RayHit::none();
        self.boxes
            .ray_traverse(traversal.ray(f64::INFINITY), hit, |_, slot| {
                let index = self.boxes.primitive_indices[slot] as usize;
                let Some(distance) = self.primitives[index].distance(&sheared) else {
                    return f32::INFINITY;
                };
                let candidate = (distance, index);
                if nearest.is_some_and(|best| best < candidate) {
                    return f32::INFINITY;
                }
                nearest = Some(candidate);
                traversal.end(distance)
            });
        let (distance, index) = nearest?;
        let (position, normal) = self.primitives[index].point_and_normal(&sheared)?;
        Some(Hit {
            distance,
            position,
            normal,
            shading_normal: self.shading_normal(&sheared, index, normal),
            surface: self.surfaces[index],
        })
    }

    /// Finds for each ray what [`intersect`](Self::intersect) finds.
    ///
    /// Rays that run side by side are found fastest where they are neighbours in the list.
    ///
    /// # Panics
    ///
    /// Panics unless `hits.len() == rays.len()`.
    pub fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        assert_eq!(hits.len(), rays.len(), "one hit for each ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.intersect(ray);
        }
    }

    /// Finds for each segment what [`visible`](Self::visible) tells of its ends.
    ///
    /// Segments that run side by side are found fastest where they are neighbours in the list.
    ///
    /// # Panics
    ///
    /// Panics unless `visible.len() == segments.len()`.
    pub fn visible_batch(&self, segments: &[Segment], visible: &mut [bool]) {
        assert_eq!(visible.len(), segments.len(), "one answer for each segment");
        for (segment, visible) in segments.iter().zip(visible) {
            *visible = self.visible(segment.from, segment.from_normal, segment.to);
        }
    }

    fn shading_normal(&self, ray: &ShearedRay, index: usize, normal: DVec3) -> DVec3 {
        let Primitive::Triangle(corners) = &self.primitives[index] else {
            return normal;
        };
        let after = self.meshes.partition_point(|&(first, _)| first <= index);
        let Some((first, instance)) = after.checked_sub(1).map(|mesh| &self.meshes[mesh]) else {
            return normal;
        };
        let interpolated = ray.triangle(corners).and_then(|(_, weights)| {
            let normal = instance
                .mesh()
                .interpolated_normal(index - first, weights)?;
            instance.direction(normal).try_normalize()
        });
        mesh::shading_normal(normal, interpolated)
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
                let index = self.boxes.primitive_indices[slot] as usize;
                if self.hides(&self.primitives[index], &sheared, direction, length) {
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
        let Some(distance) = primitive.distance(ray) else {
            return false;
        };
        // The height of the ray's end beyond the primitive's tangent plane; negative if it ends
        // before.
        let height =
            |(_, normal): (DVec3, DVec3)| (length - distance) * normal.dot(direction).abs();
        primitive
            .point_and_normal(ray)
            .is_some_and(|met| height(met) > self.clearance)
    }

    fn padded_box(&self, primitive: &Primitive, index: u64) -> Aabb {
        let (low, high) = primitive.bounds();
        let [below, above] = [2 * index, 2 * index + 1].map(|corner| self.radius * padding(corner));
        Aabb::new(self.single(low - below), self.single(high + above))
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

    /// Returns a distance from the ray's origin, in metres, as one from the start of the traversal
    /// in the unit of the boxes.
    fn end(&self, distance: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "the padding allows for it")]
        let end = ((distance - self.start) / self.radius) as f32;
        end
    }
}

/// Builds the hierarchy, which must not be deeper than obvhs can follow.
fn build_hierarchy(boxes: &[Aabb]) -> Result<CwBvh, TracerError> {
    const DEEPEST: u32 = 31;
    let preset = BvhBuildParams::slow_build();
    let indices = (0_u32..).take(boxes.len()).collect();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        preset.ploc_search_distance,
        boxes,
        indices,
        preset.sort_precision,
        preset.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut binary, preset.reinsertion_batch_ratio, None);
    let wide = bvh2_to_cwbvh(&binary, 3, true, false);
    let depth = depth(&wide, 0);
    if depth > DEEPEST {
        return Err(TracerError::OutOfRange {
            parameter: "depth of the box hierarchy",
            value: depth.into(),
            allowed: "at most 31 (too many triangles or shapes lie within each other's boxes)",
        });
    }
    Ok(wide)
}

fn depth(boxes: &CwBvh, index: usize) -> u32 {
    let node = &boxes.nodes[index];
    (0..BRANCHING)
        .filter(|&child| !node.is_child_empty(child) && !node.is_leaf(child))
        .map(|child| 1 + depth(boxes, node.child_node_index(child) as usize))
        .max()
        .unwrap_or(0)
}

/// Returns a scattered padding for each axis, in units of the bounding sphere's radius.
fn padding(corner: u64) -> DVec3 {
    const BITS: u64 = 1 << 20;
    // The finaliser of SplitMix64 (Steele, Lea and Flood 2014) spreads neighbouring numbers.
    let mut bits = corner.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    let excess = [bits, bits >> 20, bits >> 40].map(|word| (word % BITS) as f64 / BITS as f64);
    PADDING * (1.0 + DVec3::from_array(excess))
}

fn collect(shapes: &[Shape]) -> (Vec<Primitive>, Vec<usize>) {
    let mut primitives = Vec::new();
    let mut surfaces = Vec::new();
    for (surface, shape) in shapes.iter().enumerate() {
        match shape {
            Shape::Rectangle(rectangle) => primitives.push(Primitive::Rectangle(*rectangle)),
            Shape::Sphere(sphere) => primitives.push(Primitive::Sphere(*sphere)),
            Shape::Cylinder(cylinder) => primitives.push(Primitive::Cylinder(*cylinder)),
            Shape::Mesh(instance) => {
                let mesh = instance.mesh();
                primitives.extend((0..mesh.triangles().len()).map(|triangle| {
                    let corners = mesh.corners(triangle);
                    Primitive::Triangle(corners.map(|corner| instance.point(corner)))
                }));
            }
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
mod tests;
