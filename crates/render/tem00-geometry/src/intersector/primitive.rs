use glam::DVec3;
use tem00_camera::Ray;

use crate::{Cylinder, MeshInstance, Rectangle, Sphere, mesh};

/// Content of a leaf of the hierarchy.
#[derive(Clone, Debug)]
pub(super) enum Primitive {
    Triangle([DVec3; 3]),
    Rectangle(Rectangle),
    Sphere(Sphere),
    Cylinder(Cylinder),
}

/// A ray with the shear that turns it into the third axis.
///
/// In sheared coordinates a ray meets a triangle where the origin lies inside the triangle's
/// projection. The test of an edge uses only its two corners and changes only its sign when they
/// are swapped, so no ray slips between two triangles that share an edge (Woop, Benthin and Wald,
/// *Watertight Ray/Triangle Intersection*, 2013).
#[derive(Clone, Debug)]
pub(super) struct ShearedRay {
    origin: DVec3,
    axes: [usize; 3],
    shear: DVec3,
}

impl ShearedRay {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let direction = ray.direction;
        let main = direction.abs().max_position();
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        let shear = DVec3::new(direction[axes[0]], direction[axes[1]], 1.0) / direction[main];
        Self {
            origin: ray.origin,
            axes,
            shear,
        }
    }

    #[inline(always)]
    fn to_local(&self, point: DVec3) -> DVec3 {
        let offset = point - self.origin;
        let [i, j, k] = self.axes;
        let (x, y, z) = (offset[i], offset[j], offset[k]);
        DVec3::new(x - self.shear.x * z, y - self.shear.y * z, self.shear.z * z)
    }

    /// Returns the distance to a triangle and the barycentric weights of its corners there.
    #[inline(always)]
    pub(super) fn triangle(&self, corners: &[DVec3; 3]) -> Option<(f64, DVec3)> {
        let [a, b, c] = *corners;
        let (a, b, c) = (self.to_local(a), self.to_local(b), self.to_local(c));
        let weights = DVec3::new(
            c.x * b.y - c.y * b.x,
            a.x * c.y - a.y * c.x,
            b.x * a.y - b.y * a.x,
        );
        let outside = weights.min_element() < 0.0 && weights.max_element() > 0.0;
        let sum = weights.element_sum();
        if outside || sum == 0.0 {
            return None;
        }
        let weights = weights / sum;
        let distance = weights.dot(DVec3::new(a.z, b.z, c.z));
        Some((distance, weights))
    }
}

impl Primitive {
    /// Returns a triangle of a placed mesh.
    #[inline(always)]
    pub(super) fn triangle(instance: &MeshInstance, triangle: u32) -> Self {
        Self::Triangle(instance.corners(triangle as usize))
    }

    /// Returns the lowest and the highest corner of the axis-parallel box around the primitive.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Self::Triangle([a, b, c]) => (a.min(*b).min(*c), a.max(*b).max(*c)),
            Self::Rectangle(rectangle) => rectangle.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Cylinder(cylinder) => cylinder.bounds(),
        }
    }

    /// Returns the nearest positive distance at which the ray meets the primitive.
    #[inline(always)]
    pub(super) fn distance(&self, ray: &Ray) -> Option<f64> {
        let distance = match self {
            Self::Triangle(corners) => ShearedRay::new(ray).triangle(corners)?.0,
            Self::Rectangle(rectangle) => meet_rectangle(ray, rectangle)?.0,
            Self::Sphere(sphere) => meet_sphere(ray, sphere)?,
            Self::Cylinder(cylinder) => meet_cylinder(ray, cylinder)?.0,
        };
        (distance > 0.0).then_some(distance)
    }

    /// Returns the point where the ray meets the primitive, and the unit normal there.
    ///
    /// The point is composed of the primitive's own points, so that it lies on the primitive within
    /// the rounding of their coordinates, however long the ray.
    #[inline(always)]
    pub(super) fn point_and_normal(&self, ray: &Ray) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Triangle(corners) => {
                let (_, weights) = ShearedRay::new(ray).triangle(corners)?;
                let [a, b, c] = *corners;
                let point = weights.x * a + weights.y * b + weights.z * c;
                Some((point, mesh::normal(corners)?))
            }
            Self::Rectangle(rectangle) => {
                let (_, u, v) = meet_rectangle(ray, rectangle)?;
                Some((rectangle.at(u, v), rectangle.normal()))
            }
            Self::Sphere(sphere) => {
                let distance = meet_sphere(ray, sphere)?;
                let offset = sphere.centre() - ray.origin;
                let normal = (distance * ray.direction - offset).try_normalize()?;
                Some((sphere.centre() + sphere.radius() * normal, normal))
            }
            Self::Cylinder(cylinder) => {
                let (distance, height) = meet_cylinder(ray, cylinder)?;
                let on_axis = cylinder.centre() + height * cylinder.axis();
                let radial = ray.origin - on_axis + distance * ray.direction;
                let normal = radial.reject_from_normalized(cylinder.axis());
                let normal = normal.try_normalize()?;
                Some((on_axis + cylinder.radius() * normal, normal))
            }
        }
    }
}

/// Returns the distance to a rectangle and the point where it is met, as fractions of the half
/// edges. A ray along its plane has no finite values.
#[inline(always)]
fn meet_rectangle(ray: &Ray, rectangle: &Rectangle) -> Option<(f64, f64, f64)> {
    let Ray { origin, direction } = *ray;
    let offset = rectangle.centre() - origin;
    let distance = rectangle.normal().dot(offset) / rectangle.normal().dot(direction);
    let [u, v] = rectangle.fractions(distance * direction - offset);
    (u.abs() <= 1.0 && v.abs() <= 1.0).then_some((distance, u, v))
}

/// Returns the nearest positive distance to a sphere.
fn meet_sphere(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let Ray { origin, direction } = *ray;
    let radius = sphere.radius();
    let offset = sphere.centre() - origin;
    let middle = offset.dot(direction);
    // The distance at which the ray passes the centre keeps its digits where the difference of the
    // squared distance and the squared radius loses them: at small, distant spheres.
    let miss = (offset - middle * direction).length();
    let half_chord_square = (radius - miss) * (radius + miss);
    if half_chord_square < 0.0 {
        return None;
    }
    let far = middle.abs() + half_chord_square.sqrt();
    // The product of both distances is known without cancellation. Where a ray starts as a
    // tangent both are 0, the quotient is NaN and nothing is found.
    let distance = offset.length();
    let other = (distance - radius) * (distance + radius) / far;
    let (near, far) = if middle > 0.0 {
        (other, far)
    } else {
        (-far, -other)
    };
    [near, far].into_iter().find(|&distance| distance > 0.0)
}

/// Returns the nearest positive distance to a tube, and the position along its axis where it is
/// met, in metres from its middle.
fn meet_cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<(f64, f64)> {
    let Ray { origin, direction } = *ray;
    let (axis, radius) = (cylinder.axis(), cylinder.radius());
    let along = direction.dot(axis);
    let across = direction - along * axis;
    let offset = origin - cylinder.centre();
    let height = offset.dot(axis);
    let offset = offset - height * axis;
    // Seen along the axis: a circle, and a ray of the length `across`. As with the sphere, the
    // distance at which it passes the centre and the product of both distances keep their digits.
    let square = across.length_squared();
    let middle = -offset.dot(across) / square;
    let miss = (offset + middle * across).length();
    let half_chord_square = (radius - miss) * (radius + miss) / square;
    if !(half_chord_square >= 0.0 && half_chord_square.is_finite()) {
        return None;
    }
    let far = middle.abs() + half_chord_square.sqrt();
    let distance = offset.length();
    let other = (distance - radius) * (distance + radius) / square / far;
    let distances = if middle > 0.0 {
        [other, far]
    } else {
        [-far, -other]
    };
    let inside = |height: f64| height.abs() <= 0.5 * cylinder.length();
    distances
        .into_iter()
        .map(|distance| (distance, height + distance * along))
        .find(|&(distance, height)| distance > 0.0 && inside(height))
}
