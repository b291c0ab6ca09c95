mod checks;
mod cylinder;
mod instance;
mod rectangle;
mod sphere;

use glam::DVec3;
use tem00_decorrelation::RigidMotion;

pub use self::{cylinder::Cylinder, instance::MeshInstance, rectangle::Rectangle, sphere::Sphere};
use crate::TriangleMesh;

/// A shape that light can meet.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A flat rectangle.
    Rectangle(Rectangle),
    /// A sphere.
    Sphere(Sphere),
    /// An open tube.
    Cylinder(Cylinder),
    /// A placed mesh of flat triangles.
    Mesh(MeshInstance),
}

impl Shape {
    /// Returns the shape after a rigid motion; a mesh is shared, not copied.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        match self {
            Self::Rectangle(rectangle) => Self::Rectangle(rectangle.moved(motion)),
            Self::Sphere(sphere) => Self::Sphere(sphere.moved(motion)),
            Self::Cylinder(cylinder) => Self::Cylinder(cylinder.moved(motion)),
            Self::Mesh(instance) => Self::Mesh(instance.moved(motion)),
        }
    }

    /// Returns the radius of curvature in metres below which a twentieth of the area curves;
    /// infinite for flat faces. A mesh curves by its vertex normals, and has no sharper edges than
    /// they say.
    pub fn radius_of_curvature(&self) -> f64 {
        match self {
            Self::Rectangle(_) => f64::INFINITY,
            Self::Sphere(sphere) => sphere.radius(),
            Self::Cylinder(cylinder) => cylinder.radius(),
            Self::Mesh(instance) => instance.scale() * instance.mesh().radius_of_curvature(),
        }
    }

    /// Returns the lowest and the highest corner of an axis-parallel box around the shape, in
    /// metres.
    ///
    /// The box is tight, except around a rotated mesh, where it encloses the rotated box of the
    /// mesh.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Self::Rectangle(rectangle) => rectangle.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Cylinder(cylinder) => cylinder.bounds(),
            Self::Mesh(instance) => instance.bounds(),
        }
    }
}

impl From<TriangleMesh> for Shape {
    /// Places a mesh at the coordinates of its vertices.
    fn from(mesh: TriangleMesh) -> Self {
        Self::Mesh(mesh.into())
    }
}

/// A point where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance from the origin of the ray, in metres.
    pub distance: f64,
    /// The point, in metres, placed on the surface itself rather than along the ray.
    pub position: DVec3,
    /// The unit normal of the surface there.
    ///
    /// It points out of a sphere and a cylinder, along `half_u × half_v` of a rectangle and to the
    /// side from which the corners of a triangle run counter-clockwise; never flipped to face the
    /// ray.
    pub normal: DVec3,
    /// The unit normal with which light is scattered there.
    ///
    /// On a mesh with vertex normals it is interpolated between them, and turned around where it
    /// would point to the other side of the triangle than [`normal`](Self::normal). Everywhere
    /// else, and where the vertex normals cancel or lie in the triangle, it is the normal itself.
    pub shading_normal: DVec3,
    /// The index of the shape among those given to
    /// [`Intersector::build`](crate::Intersector::build).
    pub surface: usize,
}

impl Hit {
    /// Returns the normal with which light is scattered towards a viewer in this direction.
    ///
    /// Where the interpolated normal shows the viewer its other side, the result is the surface's
    /// own normal.
    pub fn normal_seen_from(&self, towards: DVec3) -> DVec3 {
        let agree = self.shading_normal.dot(towards) * self.normal.dot(towards) > 0.0;
        if agree {
            self.shading_normal
        } else {
            self.normal
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interpolated_normal_counts_for_those_who_see_its_front() {
        let hit = Hit {
            distance: 1.0,
            position: DVec3::ZERO,
            normal: DVec3::Z,
            shading_normal: DVec3::new(0.6, 0.0, 0.8),
            surface: 0,
        };
        let (from_above, from_beside) = (DVec3::Z, DVec3::new(-0.8, 0.0, 0.1));
        for (towards, normal) in [
            (from_above, hit.shading_normal),
            (-from_above, hit.shading_normal),
            (from_beside, hit.normal),
            (-from_beside, hit.normal),
        ] {
            assert_eq!(hit.normal_seen_from(towards), normal, "from {towards}");
        }
    }

    fn shapes() -> [Shape; 3] {
        let corners = vec![DVec3::ZERO, 0.3 * DVec3::X, 0.1 * DVec3::Y];
        [
            Shape::Rectangle(Rectangle::new(DVec3::ZERO, 0.2 * DVec3::X, 0.1 * DVec3::Y).unwrap()),
            Shape::Cylinder(Cylinder::new(DVec3::ZERO, DVec3::X, 0.1, 0.5).unwrap()),
            Shape::from(TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap()),
        ]
    }

    #[test]
    fn translation_moves_the_bounds() {
        let by = DVec3::new(0.25, -0.5, 0.125);
        let motion = RigidMotion::along(by).unwrap();
        let ball = Shape::Sphere(Sphere::new(DVec3::ONE, 0.25).unwrap());
        for shape in shapes().into_iter().chain([ball]) {
            let (low, high) = shape.bounds();
            let (moved_low, moved_high) = shape.moved(&motion).bounds();
            // Two roundings of numbers up to 1.5.
            assert!(moved_low.abs_diff_eq(low + by, 5e-16), "{shape:?}");
            assert!(moved_high.abs_diff_eq(high + by, 5e-16), "{shape:?}");
        }
    }

    #[test]
    fn a_quarter_turn_swaps_the_sides_of_every_shape() {
        let turn = RigidMotion::about(DVec3::ZERO, DVec3::Z, core::f64::consts::FRAC_PI_2);
        let turn = turn.unwrap();
        for shape in shapes() {
            // (x, y) turns to (−y, x).
            let (low, high) = shape.bounds();
            let (turned_low, turned_high) = shape.moved(&turn).bounds();
            let expected_low = DVec3::new(-high.y, low.x, low.z);
            let expected_high = DVec3::new(-low.y, high.x, high.z);
            assert!(turned_low.abs_diff_eq(expected_low, 2e-16), "{shape:?}");
            assert!(turned_high.abs_diff_eq(expected_high, 2e-16), "{shape:?}");
        }
    }
}
