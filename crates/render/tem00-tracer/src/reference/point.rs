use glam::DVec3;
use tem00_camera::Ray;
use tem00_geometry::Hit;

use crate::{LocalFrame, Material};

/// A surface point at the end of a path.
pub(super) struct Point<'a> {
    pub hit: Hit,
    pub material: &'a Material,
    /// Local axes whose z is the normal by which light is scattered.
    pub axes: LocalFrame,
    /// The direction back along the path, in these axes.
    pub back: DVec3,
    /// The cosine between that direction and the normal of the surface itself.
    pub cosine: f64,
}

impl<'a> Point<'a> {
    /// Returns the point where a ray meets a surface; `None` along the surface, of which the ray
    /// sees no area.
    pub(super) fn new(ray: &Ray, hit: &Hit, material: &'a Material) -> Option<Self> {
        let axes = LocalFrame::from_normal(hit.normal_seen_from(-ray.direction));
        let point = Self {
            hit: *hit,
            material,
            axes,
            back: axes.to_local(-ray.direction),
            cosine: -hit.normal.dot(ray.direction),
        };
        (point.back.z * point.cosine > 0.0).then_some(point)
    }

    /// Returns the normal by which light is scattered, on the side that is seen.
    pub(super) fn seen_normal(&self) -> DVec3 {
        self.axes.normal() * self.back.z.signum()
    }

    /// Returns the local components of a direction towards light, unless surface and shading
    /// disagree about its side.
    pub(super) fn towards(&self, direction: DVec3) -> Option<DVec3> {
        let wi = self.axes.to_local(direction);
        (wi.z * self.hit.normal.dot(direction) > 0.0).then_some(wi)
    }

    /// Returns the BSDF times |cos θ|, without the light from below a boundary.
    pub(super) fn reflected_by_boundary(&self, wi: DVec3, wavelength: f64) -> f64 {
        self.material.evaluate_boundary(self.back, wi, wavelength) * wi.z.abs()
    }

    /// Returns the BSDF times |cos θ|.
    pub(super) fn reflected(&self, wi: DVec3, wavelength: f64) -> f64 {
        self.material.evaluate(self.back, wi, wavelength) * wi.z.abs()
    }

    /// Returns the density with which the material draws a direction, per steradian.
    pub(super) fn pdf(&self, wi: DVec3) -> f64 {
        self.material.pdf(self.back, wi)
    }
}
