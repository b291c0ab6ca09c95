use glam::DVec3;
use tem00_camera::Ray;
use tem00_geometry::{Hit, Intersector, Segment};
use tem00_tracer::{BsdfSample, Laser, LocalFrame, Material, Medium};

/// A point where a path meets a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<'a> {
    pub hit: Hit,
    /// Local axes whose z is the normal by which light is scattered.
    axes: LocalFrame,
    /// The direction back along the path, in local axes.
    back: DVec3,
    /// The cosine between that direction and the surface's own normal, positive or negative.
    pub cosine: f64,
    material: &'a Material,
}

impl<'a> Vertex<'a> {
    /// Creates the point where a path from the camera hits a surface; `None` for a ray along the
    /// surface, which sees no area of it.
    #[inline(always)]
    pub(crate) fn seen(ray: &Ray, hit: &Hit, material: &'a Material) -> Option<Self> {
        let normal = hit.normal_seen_from(-ray.direction);
        let vertex = Self::with_normal(normal, ray, hit, material);
        (vertex.back.z * vertex.cosine > 0.0).then_some(vertex)
    }

    /// Creates the point where a path from a laser hits a surface.
    pub(crate) fn lit(ray: &Ray, hit: &Hit, material: &'a Material) -> Self {
        Self::with_normal(hit.shading_normal, ray, hit, material)
    }

    #[inline(always)]
    fn with_normal(normal: DVec3, ray: &Ray, hit: &Hit, material: &'a Material) -> Self {
        let axes = LocalFrame::from_normal(normal);
        Self {
            hit: *hit,
            axes,
            back: axes.to_local(-ray.direction),
            cosine: hit.normal.dot(-ray.direction),
            material,
        }
    }

    /// Returns whether the material only mirrors and refracts.
    pub(crate) fn is_specular(&self) -> bool {
        self.material.is_specular()
    }

    /// Returns the normal by which light is scattered, on the side that is seen.
    pub(crate) fn seen_normal(&self) -> DVec3 {
        self.axes.normal() * self.back.z.signum()
    }

    /// Returns the local components of a direction towards light, or `None` if the surface and the
    /// shading disagree about the side from which it comes.
    pub(crate) fn towards(&self, direction: DVec3) -> Option<DVec3> {
        let wi = self.axes.to_local(direction);
        (wi.z * self.hit.normal.dot(direction) > 0.0).then_some(wi)
    }

    /// Returns the BSDF times |cos θ| for light from the local direction `wi`.
    pub(crate) fn reflected(&self, wi: DVec3, wavelength: f64) -> f64 {
        self.material.evaluate(self.back, wi, wavelength) * wi.z.abs()
    }

    /// Returns the body below the boundary of a translucent material.
    pub(crate) const fn below(&self) -> Option<&Medium> {
        self.material.below()
    }

    /// Returns the BSDF times |cos θ| for light from the local direction `wi`, without light from
    /// below the boundary.
    pub(crate) fn reflected_by_boundary(&self, wi: DVec3, wavelength: f64) -> f64 {
        self.material.evaluate_boundary(self.back, wi, wavelength) * wi.z.abs()
    }

    /// Draws the point of a body where light of a laser entered that leaves it at the vertex: the
    /// segment from there to the laser, and the radiance at the vertex.
    pub(crate) fn entry(
        &self,
        laser: &Laser,
        seed: u64,
        intersector: &Intersector,
    ) -> Option<(Segment, f64)> {
        let place = |offset: DVec3| self.hit.position + self.axes.to_world(offset);
        let irradiance = |offset| {
            laser
                .next_event(place(offset))
                .map_or(0.0, |event| event.e_perp)
        };
        let wi = self.towards(laser.wave_direction_at(self.hit.position))?;
        let distance = laser.distance_beside(self.hit.position);
        let directions = [self.back, wi];
        let (offset, radiance) = self
            .material
            .entry(directions, distance, seed, irradiance)?;
        // The tangent plane is left for the surface itself, unless this ends before.
        let height = 0.5 * offset.length();
        let normal = self.seen_normal();
        let below = intersector.intersect(&Ray {
            origin: intersector.leave(place(offset) + height * normal, normal),
            direction: -normal,
        })?;
        let is_same = below.surface == self.hit.surface && below.distance < 2.0 * height;
        let segment = Segment {
            from: below.position,
            from_normal: below.normal,
            to: laser.next_event(place(offset))?.point,
        };
        is_same.then_some((segment, radiance))
    }

    /// Returns the BSDF times |cos θ| for light from a unit direction in space.
    pub(crate) fn reflected_from(&self, direction: DVec3, wavelength: f64) -> f64 {
        self.towards(direction)
            .map_or(0.0, |wi| self.reflected(wi, wavelength))
    }

    /// Returns the density with which [`sample`](Self::sample) draws `wi`, per steradian.
    pub(crate) fn pdf(&self, wi: DVec3) -> f64 {
        self.material.pdf(self.back, wi)
    }

    /// Returns the density of the vertex on its surface, per square metre, if the direction of the
    /// ray to it was drawn with `pdf`, per steradian.
    pub(crate) fn area_pdf(&self, pdf: f64) -> f64 {
        pdf * self.cosine.abs() / self.hit.distance.powi(2)
    }

    /// Returns whether the local direction is on the side from which the path came.
    pub(crate) fn is_seen_side(&self, wi: DVec3) -> bool {
        wi.z * self.back.z > 0.0
    }

    /// Draws a direction from the material, whether or not surface and shading agree about its
    /// side.
    pub(crate) fn draw(&self, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        self.material.sample(self.back, u, wavelength)
    }

    /// Draws a direction on whose side surface and shading agree.
    pub(crate) fn sample(&self, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        let event = self.draw(u, wavelength)?;
        self.towards(self.axes.to_world(event.wi))?;
        Some(event)
    }

    /// Returns the weight of a drawn direction at a wavelength.
    pub(crate) fn weight(&self, event: &BsdfSample, wavelength: f64) -> f64 {
        self.material.reweighted(self.back, event, wavelength)
    }

    /// Returns the ray that leaves the surface in the local direction `wi`.
    pub(crate) fn leave(&self, intersector: &Intersector, wi: DVec3) -> Ray {
        intersector.ray_from(self.hit.position, self.hit.normal, self.axes.to_world(wi))
    }

    /// Returns the segment from the surface to a point.
    pub(crate) const fn segment_to(&self, point: DVec3) -> Segment {
        Segment {
            from: self.hit.position,
            from_normal: self.hit.normal,
            to: point,
        }
    }

    /// Returns the segment from the surface out of the scene.
    pub(crate) fn segment_along(&self, direction: DVec3) -> Segment {
        Segment::to_infinity(self.hit.position, self.hit.normal, direction)
    }

    /// Returns the fraction of the power from the direction `back` that goes towards the unit
    /// vector `out`, per steradian, where light is scattered in these `axes`.
    pub(crate) fn sent(&self, back: DVec3, out: DVec3, axes: &LocalFrame, wavelength: f64) -> f64 {
        let [wo, wi] = [out, back].map(|direction| axes.to_local(direction));
        let reflected = self.material.evaluate(wo, wi, wavelength) * wo.z.abs();
        reflected * self.adjoint_factor(out, [wi.z, wo.z])
    }

    /// Returns the factor [`adjoint_factor`](Self::adjoint_factor) of a drawn direction.
    pub(crate) fn adjoint_factor_of(&self, event: &BsdfSample) -> f64 {
        let out = self.axes.to_world(event.wi);
        self.adjoint_factor(out, [self.back.z, event.wi.z])
    }

    /// Returns the gain of the power scattered towards `out` over scattering with the normal of the
    /// surface itself, so that light carries as much as a path from the camera would find.
    ///
    /// ```text
    /// |i·n_s| |o·n_g| / (|i·n_g| |o·n_s|)     i back along the path, n_s shading, n_g geometric
    /// ```
    ///
    /// The products with the shading normal are `shaded`. The factor is 1 without shading normals,
    /// and 0 where the two normals disagree about the side.
    ///
    /// # References
    ///
    /// - E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, §5.3.
    fn adjoint_factor(&self, out: DVec3, shaded: [f64; 2]) -> f64 {
        let out = out.dot(self.hit.normal);
        let agree = shaded[0] * self.cosine > 0.0 && shaded[1] * out > 0.0;
        let ratio = (shaded[0] / self.cosine) * (out / shaded[1]);
        if agree { ratio } else { 0.0 }
    }
}
