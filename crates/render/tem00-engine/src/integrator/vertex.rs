use glam::DVec3;
use tem00_camera::Ray;
use tem00_geometry::{Hit, Intersector, Segment};
use tem00_tracer::{BsdfSample, LocalFrame, Material};

/// A surface point that a path has met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<'a> {
    pub position: DVec3,
    /// The distance along the ray, in metres.
    pub distance: f64,
    /// The index of the surface in the scene.
    pub surface: usize,
    /// The unit normal of the surface itself.
    pub normal: DVec3,
    /// Local axes whose z is the normal by which light is scattered.
    axes: LocalFrame,
    /// The direction back along the path, in local axes.
    wo: DVec3,
    /// The cosine between that direction and the surface's own normal, positive or negative.
    pub cosine: f64,
    material: &'a Material,
}

impl<'a> Vertex<'a> {
    /// Creates the point where a ray hits a surface; `None` for a ray along the surface, which sees
    /// no area of it.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, hit: &Hit, material: &'a Material) -> Option<Self> {
        let back = -ray.direction;
        let cosine = hit.normal.dot(back);
        let axes = LocalFrame::from_normal(hit.normal_seen_from(back));
        let wo = axes.to_local(back);
        (wo.z * cosine > 0.0).then_some(Self {
            position: hit.position,
            distance: hit.distance,
            surface: hit.surface,
            normal: hit.normal,
            axes,
            wo,
            cosine,
            material,
        })
    }

    /// Tells whether the material only mirrors and refracts.
    pub(crate) fn is_specular(&self) -> bool {
        self.material.is_specular()
    }

    /// Returns the normal by which light is scattered, on the side that is seen.
    pub(crate) fn seen_normal(&self) -> DVec3 {
        self.axes.normal() * self.wo.z.signum()
    }

    /// Returns the local components of a direction towards light, or `None` if the surface and the
    /// shading disagree about the side from which it comes.
    pub(crate) fn towards(&self, direction: DVec3) -> Option<DVec3> {
        let wi = self.axes.to_local(direction);
        (wi.z * self.normal.dot(direction) > 0.0).then_some(wi)
    }

    /// Returns the BSDF times |cos θ| for light from the local direction `wi`.
    pub(crate) fn reflected(&self, wi: DVec3, wavelength: f64) -> f64 {
        self.material.evaluate(self.wo, wi, wavelength) * wi.z.abs()
    }

    /// Returns the BSDF times |cos θ| for light from a unit direction in space.
    pub(crate) fn reflected_from(&self, direction: DVec3, wavelength: f64) -> f64 {
        self.towards(direction)
            .map_or(0.0, |wi| self.reflected(wi, wavelength))
    }

    /// Returns the density with which [`sample`](Self::sample) draws `wi`, per steradian.
    pub(crate) fn pdf(&self, wi: DVec3) -> f64 {
        self.material.pdf(self.wo, wi)
    }

    /// Returns the density of the vertex on its surface, per square metre, if the direction of the ray to it was drawn
    /// with `pdf`, per steradian.
    pub(crate) fn area_pdf(&self, pdf: f64) -> f64 {
        pdf * self.cosine.abs() / self.distance.powi(2)
    }

    /// Tells whether the local direction is on the side from which the path came.
    pub(crate) fn is_seen_side(&self, wi: DVec3) -> bool {
        wi.z * self.wo.z > 0.0
    }

    /// Draws a direction from the material.
    pub(crate) fn sample(&self, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        let event = self.material.sample(self.wo, u, wavelength)?;
        self.towards(self.axes.to_world(event.wi))?;
        Some(event)
    }

    /// Returns the weight of a drawn direction at a wavelength.
    pub(crate) fn weight(&self, event: &BsdfSample, wavelength: f64) -> f64 {
        self.material.reweighted(self.wo, event, wavelength)
    }

    /// Returns the ray that leaves the surface in the local direction `wi`.
    pub(crate) fn leave(&self, intersector: &Intersector, wi: DVec3) -> Ray {
        intersector.ray_from(self.position, self.normal, self.axes.to_world(wi))
    }

    /// Returns the way from the surface to a point.
    pub(crate) const fn segment_to(&self, point: DVec3) -> Segment {
        Segment {
            from: self.position,
            from_normal: self.normal,
            to: point,
        }
    }

    /// Returns the way from the surface out of the scene.
    pub(crate) fn segment_along(&self, direction: DVec3) -> Segment {
        Segment::to_infinity(self.position, self.normal, direction)
    }
}
