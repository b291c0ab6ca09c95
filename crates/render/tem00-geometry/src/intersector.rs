mod bodies;
mod packet;
mod primitive;
mod query;
mod traverse;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;
use tem00_camera::Ray;

use self::{
    bodies::{Bodies, Body},
    packet::{LANES, Packet},
    query::{Nearest, Query, Shadow},
    traverse::{Leaves, Stacks, follow_many, follow_one},
};
use crate::{Hit, Refusal, Segment, Shape, hierarchy::Placement};

/// Finds where rays meet shapes.
///
/// A hierarchy of boxes over the scene leads to its shapes, and a hierarchy of each mesh, which its
/// instances share, leads to its triangles. Boxes and triangles are tested in single precision, up
/// to 16 in one instruction, with tolerances larger than the error of single precision; the
/// candidates are then tested in double precision, which decides. So the answers have double
/// precision and are the same on every processor, alone and in batches.
///
/// Batches are faster: 64 rays that follow each other in the list go through the boxes together,
/// and part where fewer than eight meet the same box.
///
/// # Validity
///
/// Hit points lie on their surface within 2e−15 of the scene's largest coordinate, and along the
/// ray within that divided by the cosine of incidence. No ray passes between two triangles of a
/// mesh that share an edge. Rays start within 10⁹ times the size of the smallest mesh.
///
/// Time is lost, but nothing else, where a mesh is more than 10⁷ times smaller than the coordinates
/// of the scene, and among triangles that all lie within 10⁻⁵ of the size of their mesh.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_camera::Ray;
/// use tem00_geometry::{Intersector, Shape, Sphere};
///
/// let ball = Shape::Sphere(Sphere::new(DVec3::ZERO, 0.01)?);
/// let intersector = Intersector::build(&[ball])?;
///
/// let ray = Ray { origin: DVec3::new(0.0, 0.0, 0.5), direction: -DVec3::Z };
/// let hit = intersector.intersect(&ray).unwrap();
/// assert!((hit.distance - 0.49).abs() < 1e-15);
/// assert_eq!(hit.normal, DVec3::Z);
/// # Ok::<(), tem00_geometry::Refusal>(())
/// ```
#[derive(Clone, Debug)]
pub struct Intersector {
    bodies: Bodies,
    /// The largest distance of a computed point from its surface, in metres.
    clearance: f64,
    level: Level,
}

impl Intersector {
    /// Builds the hierarchy over `shapes`, and the hierarchies of meshes that have none yet.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no shapes, if they reach farther than 1e9 m from the origin,
    /// if together they are smaller than 1e−12 m, or if they have more than 2³¹ triangles.
    pub fn build(shapes: &[Shape]) -> Result<Self, Refusal> {
        let (low, high) = shapes.iter().map(Shape::bounds).fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), bounds| (low.min(bounds.0), high.max(bounds.1)),
        );
        let radius = 0.5 * (high - low).length();
        let reach = low.abs().max(high.abs()).max_element();
        check(shapes.iter().map(primitives).sum(), reach, radius)?;
        for shape in shapes {
            if let Shape::Mesh(instance) = shape {
                instance.hierarchy();
            }
        }
        let bodies = shapes.iter().enumerate();
        let bodies = bodies.flat_map(|(surface, shape)| Body::parts_of(surface, shape, reach));
        Ok(Self {
            bodies: Bodies::build(bodies.collect()),
            clearance: clearance(reach),
            level: Level::new(),
        })
    }

    /// Returns the nearest point in front of the ray's origin where it meets a shape.
    ///
    /// Of shapes met at the same distance, the first in the list given to [`build`](Self::build)
    /// counts. To follow light on from a hit, [`leave`](Self::leave) the surface first.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let mut query = Nearest::new(*ray);
        self.ask_one(&mut query);
        self.hit(&query)
    }

    /// Finds for each ray the hit that [`intersect`](Self::intersect) finds.
    ///
    /// Rays that run side by side are found fastest where they are neighbours in the list.
    ///
    /// # Panics
    ///
    /// Panics unless `hits.len() == rays.len()`.
    pub fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        assert_eq!(hits.len(), rays.len(), "one hit for each ray");
        self.ask_all(
            rays,
            |ray| Nearest::new(*ray),
            hits,
            |query| self.hit(query),
        );
    }

    /// Returns whether nothing stands between a surface point and another point.
    ///
    /// `from` lies on a surface with the unit normal `from_normal`, of either sign; that surface
    /// does not hide `to` at either side. A surface on which `to` lies does not hide it.
    pub fn visible(&self, from: DVec3, from_normal: DVec3, to: DVec3) -> bool {
        let segment = Segment {
            from,
            from_normal,
            to,
        };
        let mut query = Shadow::new(&segment, self.clearance);
        self.ask_one(&mut query);
        !query.hidden
    }

    /// Finds for each segment the answer of [`visible`](Self::visible) for its ends.
    ///
    /// Segments that run side by side are found fastest where they are neighbours in the list.
    ///
    /// # Panics
    ///
    /// Panics unless `visible.len() == segments.len()`.
    pub fn visible_batch(&self, segments: &[Segment], visible: &mut [bool]) {
        assert_eq!(visible.len(), segments.len(), "one answer for each segment");
        let query = |segment: &Segment| Shadow::new(segment, self.clearance);
        self.ask_all(segments, query, visible, |query| !query.hidden);
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

    /// Returns the ray that [leaves](Self::leave) a surface with this unit normal, of either sign.
    pub fn ray_from(&self, position: DVec3, normal: DVec3, direction: DVec3) -> Ray {
        let side = normal * normal.dot(direction).signum();
        Ray {
            origin: self.leave(position, side),
            direction,
        }
    }

    /// Returns whether a ray's nearest hit hides a point at `distance` along it, in metres; a point
    /// on the surface itself is not hidden.
    pub fn hides(&self, hit: &Hit, ray: &Ray, distance: f64) -> bool {
        let height = (distance - hit.distance) * hit.normal.dot(ray.direction).abs();
        height > self.clearance
    }

    fn hit(&self, query: &Nearest) -> Option<Hit> {
        let best = query.best?;
        self.bodies.body(best.1).hit(query, best)
    }

    fn ask_one<Q: Query>(&self, query: &mut Q) {
        let hierarchy = self.bodies.hierarchy();
        let (ray, enters) = hierarchy.enter(&Placement::WORLD, query.ray());
        if !enters {
            return;
        }
        let stacks = &mut Stacks::default();
        dispatch!(self.level, simd => follow_one(simd, &self.bodies, 0, &ray, query, stacks));
    }

    /// Answers queries about `items`, as many together as a packet holds.
    fn ask_all<T, Q: Query, A>(
        &self,
        items: &[T],
        query: impl Fn(&T) -> Q,
        answers: &mut [A],
        answer: impl Fn(&Q) -> A,
    ) {
        let stacks = &mut Stacks::default();
        let mut queries = Vec::with_capacity(LANES);
        for (items, answers) in items.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            queries.clear();
            queries.extend(items.iter().map(&query));
            self.ask_many(&mut queries, stacks);
            for (slot, query) in answers.iter_mut().zip(&queries) {
                *slot = answer(query);
            }
        }
    }

    fn ask_many<Q: Query>(&self, queries: &mut [Q], stacks: &mut Stacks) {
        let all = u64::MAX >> (LANES - queries.len());
        dispatch!(self.level, simd => follow_all(simd, &self.bodies, all, queries, stacks));
    }
}

/// Follows the rays in `lanes` through a scene.
#[inline(always)]
fn follow_all<S: Simd, Q: Query>(
    simd: S,
    bodies: &Bodies,
    lanes: u64,
    queries: &mut [Q],
    stacks: &mut Stacks,
) {
    let hierarchy = bodies.hierarchy();
    let (mut packet, inside) = Packet::gather(hierarchy, &Placement::WORLD, lanes, queries);
    follow_many(simd, bodies, &mut packet, inside, queries, stacks);
}

/// Returns the number of triangles of a mesh, and 1 for other shapes.
fn primitives(shape: &Shape) -> usize {
    match shape {
        Shape::Mesh(instance) => instance.mesh().triangles().len(),
        _ => 1,
    }
}

fn check(primitives: usize, reach: f64, radius: f64) -> Result<(), Refusal> {
    const MAX: usize = 1 << 31;
    if primitives == 0 {
        return Err(Refusal::new("number of shapes", 0.0, "at least 1"));
    }
    if primitives > MAX {
        let count = primitives as f64;
        return Err(Refusal::new("number of triangles", count, "at most 2^31"));
    }
    if reach.is_nan() || reach > 1e9 {
        let allowed = "within 1e9 m of the origin";
        return Err(Refusal::new("coordinate of a shape", reach, allowed));
    }
    if radius < 1e-12 {
        let allowed = "at least 1e-12 m";
        return Err(Refusal::new("extent of all shapes", radius, allowed));
    }
    Ok(())
}

/// Returns by how much a computed point may be off its surface, in metres, where no coordinate
/// exceeds `reach`.
///
/// With u = 2⁻⁵³: composing a point from three others costs 7 u √3 `reach`. The next test then sees
/// that point at the wrong side of the surface by what its corners move in sheared coordinates,
/// five roundings of distances up to 2√3 `reach` in each of two axes: 25 u `reach`; and by the
/// weights, four roundings: 14 u `reach`. The sum, 51 u `reach`, is below a quarter of 2⁻⁴⁵
/// `reach`.
fn clearance(reach: f64) -> f64 {
    const STEP: f64 = 256.0 * (f64::EPSILON / 2.0);
    STEP * reach
}

#[cfg(test)]
mod tests;
