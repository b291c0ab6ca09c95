use super::phase_space::{Batch, PhaseSpace, event_at, irradiance_at};
use super::power_bound::LocalBox;
use super::record::{
    ApertureHit, Bounds, NextEvent, NextEventSlices, RayPdf, RaySample, SampledEvent,
};
use super::slope::{aperture_point, direction, secant, slope_of, towards_light};

/// A light that a renderer can evaluate and sample, without allocation.
///
/// All points and vectors are in world coordinates. The light shines from the aperture plane into
/// the half-space that its axis points to; points behind that plane receive nothing.
///
/// There are two ways to light a surface, which belong to different path spaces and must not be
/// added up:
///
/// - [`next_event`](Self::next_event) takes the mean direction of the energy flow, a *delta* light:
///   `L = f · |n·wi| · V · e_perp`. No other technique can find that direction.
/// - [`next_event_sampled`](Self::next_event_sampled), [`hit`](Self::hit),
///   [`sample_ray`](Self::sample_ray), [`ray_pdf`](Self::ray_pdf) and
///   [`radiance`](Self::radiance) share the phase-space density of
///   the light and may be combined by multiple importance sampling.
///
/// Light beyond the cut-off (the field `cutoff`, in beam radii, 4 by default) is dropped by
/// [`irradiance`](Self::irradiance), [`flux`](Self::flux) and both next-event forms, which loses
/// the fraction exp(−2 · cutoff²) of the power of a spot, 1e−14 by default. The power is not raised
/// to make up for it. Rays are not cut off.
///
/// Uniform variates are expected in [0, 1). A variate of 0 acts as half the spacing of such
/// variates.
///
/// # Validity
///
/// The irradiance carries the rounding of the coordinates, which is large if they are stored as
/// `f32`. Within two beam radii of the axis its relative error is then usually below the value
/// `4 ε (1 + |p| / w)` and below five times this bound at any position of the light. Here ε =
/// 1.2e−7, `|p|` is the larger of the distances of the point and of the light from the world's
/// origin, and `w` is the smaller beam radius. In a line the half-length of the fan and the width
/// of its roll-off count as radii too; at an abrupt end there is no bound.
///
/// The batch forms give the bits of single calls, with and without the feature `simd`, which
/// compiles their loops for the widest vector instructions that the processor supports.
///
/// The trait is sealed. [`SpotLight`](crate::SpotLight), [`LineLight`](crate::LineLight) and
/// [`TabulatedLineLight`](crate::TabulatedLineLight) implement it.
///
/// # Examples
///
/// ```
/// use tem00_beam::{DVec3, Emitter, GaussianBeam, Placement, SpotLight};
///
/// let placement = Placement {
///     origin: DVec3::new(0.0, 0.0, 0.5),
///     direction: DVec3::NEG_Z,
///     fan_axis: DVec3::X,
/// };
/// let beam = GaussianBeam::from_waist(650e-9, 0.2e-3)?;
/// let light = SpotLight::place(&beam, 0.5, &placement, 5e-3)?;
///
/// // A surface through the world's origin, tilted by 60°.
/// let event = light.next_event([0.0, 0.0, 0.0]).expect("the point is lit");
/// let normal = DVec3::new(60_f64.to_radians().sin(), 0.0, 60_f64.to_radians().cos());
/// let irradiance = event.e_perp * DVec3::from(event.wi).dot(normal);
///
/// let upright = light.irradiance([0.0, 0.0, 0.0]);
/// assert!((irradiance / upright - 0.5).abs() < 1e-12);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// A scene holds lights of several kinds as trait objects:
///
/// ```
/// # use tem00_beam::{DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight};
/// # use tem00_beam::{LineProfile, Placement, SpotLight};
/// # let placement = Placement {
/// #     origin: DVec3::new(0.0, 0.0, 0.5),
/// #     direction: DVec3::NEG_Z,
/// #     fan_axis: DVec3::X,
/// # };
/// # let red = GaussianBeam::from_waist(650e-9, 0.2e-3)?;
/// # let fan = FanGeometry {
/// #     fan_angle: 0.5,
/// #     apex_offset: 3e-3,
/// #     focus_distance: 0.5,
/// #     focus_curve: FocusCurve::EqualDistance,
/// # };
/// # let green = GaussianBeam::from_waist(532e-9, 0.1e-3)?;
/// # let green = LaserLine::new(green, fan, LineProfile::GaussianTan)?;
/// let lights: Vec<Box<dyn Emitter>> = vec![
///     Box::new(SpotLight::place(&red, 0.5, &placement, 5e-3)?),
///     Box::new(LineLight::place(&green, &placement, 1e-3)?),
/// ];
/// let p = [0.1e-3, 0.0, 0.0];
/// let brightest = lights.iter().max_by(|a, b| a.irradiance(p).total_cmp(&b.irradiance(p)));
/// let brightest = brightest.expect("there are lights");
/// assert!((brightest.power() - 5e-3).abs() < 1e-18);
/// assert!((brightest.wavelength() - 650e-9).abs() < 1e-18);
/// assert!(brightest.axis()[2] < -0.999_999);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
pub trait Emitter: PhaseSpace {
    /// Returns the power, in watts.
    fn power(&self) -> f64;

    /// Returns the wavelength in the medium, in metres.
    fn wavelength(&self) -> f64;

    /// Returns the centre of the aperture, in metres.
    fn origin(&self) -> [f64; 3] {
        self.frame().origin
    }

    /// Returns the unit vector along the direction of travel.
    fn axis(&self) -> [f64; 3] {
        self.frame().ez
    }

    /// Returns the irradiance, in W/m², of a plane through `p` perpendicular to the axis.
    #[inline]
    fn irradiance(&self, p: [f64; 3]) -> f64 {
        irradiance_at(self, p)
    }

    /// Returns the energy-flow vector at `p`, in W/m².
    ///
    /// A surface whose normal `n` lies on the lit side receives the irradiance `max(0, −F·n)`.
    fn flux(&self, p: [f64; 3]) -> [f64; 3] {
        let frame = self.frame();
        match self.lit_flow(frame.local_from_world_point(p)) {
            Some(flow) => {
                let [x, y] = flow.slope;
                let e = flow.irradiance;
                frame.world_from_local_vector([e * x, e * y, e])
            }
            None => [0.0; 3],
        }
    }

    /// Returns the light at `p` as one direction, the direction of the mean energy flow.
    ///
    /// A surface of normal `n` receives the irradiance `e_perp · |n·wi|`, and reflects
    /// `f · |n·wi| · V · e_perp`. Returns `None` outside the cut-off and behind the aperture, where
    /// no shadow ray is needed.
    #[inline]
    fn next_event(&self, p: [f64; 3]) -> Option<NextEvent> {
        Some(event_at(self, p)).filter(|event| event.e_perp > 0.0)
    }

    /// Returns the light at `p` as one direction, drawn from the phase-space density at `p`.
    ///
    /// The estimate of the reflected radiance is `f · |n·wi| · V · value`: `value` is already
    /// divided by the density. Its mean over `u` equals the estimate of
    /// [`next_event`](Self::next_event). Returns `None` outside the cut-off and behind the
    /// aperture.
    #[inline]
    fn next_event_sampled(&self, p: [f64; 3], u: [f64; 2]) -> Option<SampledEvent> {
        let frame = self.frame();
        let local = frame.local_from_world_point(p);
        self.lit_flow(local)?;
        let drawn = self.sample_slope(local, u);
        Some(SampledEvent {
            point: frame.world_from_aperture(aperture_point(local, drawn.slope)),
            distance: local[2] * secant(drawn.slope),
            wi: towards_light(frame.world_from_local_vector(direction(drawn.slope))),
            value: drawn.value,
            pdf: drawn.pdf,
        })
    }

    /// Returns the density, per steradian, with which
    /// [`next_event_sampled`](Self::next_event_sampled) draws the unit vector `wi` towards the
    /// light at `p`; 0 outside the cut-off, behind the aperture and for a `wi` along the axis.
    ///
    /// Multiple importance sampling needs this density for a direction that another technique has
    /// drawn. Its product with the `value` of the event in this direction is the radiance along the
    /// direction.
    #[inline]
    fn next_event_pdf(&self, p: [f64; 3], wi: [f64; 3]) -> f64 {
        let frame = self.frame();
        let local = frame.local_from_world_point(p);
        let slope = slope_of(frame.local_from_world_vector(towards_light(wi)));
        match (self.lit_flow(local), slope) {
            (Some(_), Some(slope)) => self.slope_pdf(local, slope),
            _ => 0.0,
        }
    }

    /// Returns the light that a ray from `p` along the unit vector `wi` meets: the second
    /// technique, which complements [`next_event_sampled`](Self::next_event_sampled).
    ///
    /// A material has drawn `wi` with the density `q`, per steradian. The light it reflects is
    /// estimated by `f · |n·wi| · V · radiance / q`, which multiple importance sampling weighs by
    /// `q / (q + pdf)`; the sampled event then has the weight `pdf / (pdf + q)`. The aperture
    /// occludes nothing: only a hit nearer than `distance` hides it.
    ///
    /// Returns `None` where [`next_event_sampled`](Self::next_event_sampled) does, for a ray that
    /// runs with the light or along its aperture, and for a ray that meets no light.
    fn hit(&self, p: [f64; 3], wi: [f64; 3]) -> Option<ApertureHit> {
        let frame = self.frame();
        let local = frame.local_from_world_point(p);
        self.lit_flow(local)?;
        let slope = slope_of(frame.local_from_world_vector(towards_light(wi)))?;
        let position = aperture_point(local, slope);
        let hit = ApertureHit {
            point: frame.world_from_aperture(position),
            distance: local[2] * secant(slope),
            radiance: radiance_of(self, position, slope),
            pdf: self.slope_pdf(local, slope),
        };
        Some(hit).filter(|hit| hit.radiance > 0.0)
    }

    /// Draws a ray that leaves the aperture.
    ///
    /// Every ray carries the same power, so straight rays reproduce the irradiance at every
    /// distance:
    ///
    /// ```text
    /// radiance · cos = power · pdf.direction · pdf.position_given_direction
    /// ```
    #[inline]
    fn sample_ray(&self, u: [f64; 4]) -> RaySample {
        let frame = self.frame();
        let (position, slope) = self.draw(u);
        RaySample {
            origin: frame.world_from_aperture(position),
            flux: self.power(),
            direction: frame.world_from_local_vector(direction(slope)),
            cos: 1.0 / secant(slope),
            pdf: self.densities(position, slope),
        }
    }

    /// Returns the densities with which [`sample_ray`](Self::sample_ray) draws the ray through `o`
    /// along the unit vector `d`; 0 for a ray against the axis.
    ///
    /// Any point `o` of the ray gives the same result: the densities of position refer to the ray's
    /// point on the aperture plane. Coordinates that were rounded to `f32` must still resolve the
    /// source, which for a line is about a micrometre wide.
    fn ray_pdf(&self, o: [f64; 3], d: [f64; 3]) -> RayPdf {
        let frame = self.frame();
        match slope_of(frame.local_from_world_vector(d)) {
            Some(slope) => {
                let position = aperture_point(frame.local_from_world_point(o), slope);
                self.densities(position, slope)
            }
            None => RayPdf::from_position(0.0, || 0.0),
        }
    }

    /// Returns the radiance, in W/(m² sr), of the ray through `o` along the unit vector `d`, the
    /// direction of travel; 0 for a ray against the axis.
    ///
    /// Radiance is constant along a ray in free space, so any point `o` of the ray gives the same
    /// result. The integral of the radiance over direction, weighted with the cosine to the axis,
    /// is the irradiance at `o`.
    fn radiance(&self, o: [f64; 3], d: [f64; 3]) -> f64 {
        let frame = self.frame();
        match slope_of(frame.local_from_world_vector(d)) {
            Some(slope) => {
                let position = aperture_point(frame.local_from_world_point(o), slope);
                radiance_of(self, position, slope)
            }
            None => 0.0,
        }
    }

    /// Returns bounds of the light between the aperture and the distance `l`, in metres, along its
    /// axis.
    ///
    /// The box holds all points within the cut-off. The cone holds the mean energy flow at all of
    /// them; a sampled ray is outside it with a probability of about exp(−2 · cutoff²).
    fn bounds(&self, l: f64) -> Bounds {
        let frame = self.frame();
        let reach = self.reach(l);
        let mut bounds = Bounds {
            min: frame.origin,
            max: frame.origin,
            axis: frame.ez,
            half_angle: reach.slope.atan(),
        };
        for i in 0..3 {
            let across =
                reach.half_width[0] * frame.ex[i].abs() + reach.half_width[1] * frame.ey[i].abs();
            let far = frame.origin[i] + l * frame.ez[i];
            bounds.min[i] = frame.origin[i].min(far) - across;
            bounds.max[i] = frame.origin[i].max(far) + across;
        }
        bounds
    }

    /// Returns a bound of the power, in watts, that reaches the axis-aligned box from `min` to
    /// `max`, whose coordinates are finite; 0 if the box is behind the aperture, beyond the cut-off
    /// or empty.
    ///
    /// A light hierarchy that holds surfaces in boxes visits no light whose bound is 0, and chooses
    /// among the others by their bounds. The bound ignores occlusion: it counts all light within
    /// the cut-off that is directed through the box.
    ///
    /// # Validity
    ///
    /// The bound is never less than the power. For a box within the beam, as long as it is wide,
    /// the bound is less than four times the power, plus the additional power that an equally wide
    /// box turned into the axes of the light receives. Half of the rods along the axis, up to a
    /// thousand times as long as wide, have a bound within 10 % of the power; next to a focus that
    /// the rod passes it is up to some twenty times the power.
    fn power_bound(&self, min: [f64; 3], max: [f64; 3]) -> f64 {
        match LocalBox::around(&self.frame(), min, max) {
            Some(target) => {
                let bound = self.power() * self.fraction_bound(&target);
                // Larger than any rounding on the way.
                (bound * (1.0 + 1e-6)).min(self.power())
            }
            None => 0.0,
        }
    }

    /// Writes the [`irradiance`](Self::irradiance) at the points `(x[i], y[i], z[i])` to `out[i]`.
    ///
    /// # Panics
    ///
    /// Panics unless `x.len() == y.len() == z.len() == out.len()`.
    fn irradiance_batch(&self, x: &[f64], y: &[f64], z: &[f64], out: &mut [f64]) {
        check_lengths([x, y, z], [out.len()]);
        self.run(Batch::Irradiance([x, y, z], out));
    }

    /// Writes the [`next_event`](Self::next_event) at the points `(x[i], y[i], z[i])` to
    /// `out.…[i]`. Where no light arrives, all five numbers are 0.
    ///
    /// # Panics
    ///
    /// Panics unless `x`, `y`, `z` and the five slices of `out` are of equal length.
    fn next_event_batch(&self, x: &[f64], y: &[f64], z: &[f64], out: NextEventSlices<'_>) {
        let [wi_x, wi_y, wi_z] = &out.wi;
        let lengths = [wi_x, wi_y, wi_z, &out.distance, &out.e_perp].map(|slice| slice.len());
        check_lengths([x, y, z], lengths);
        self.run(Batch::NextEvents([x, y, z], out));
    }

    /// Writes the [`next_event_sampled`](Self::next_event_sampled) at the points `p[i]` with the
    /// uniforms `u[i]` to `out[i]`. Where no light arrives, all fields are 0.
    ///
    /// # Panics
    ///
    /// Panics unless `p.len() == u.len() == out.len()`.
    fn next_event_sampled_batch(&self, p: &[[f64; 3]], u: &[[f64; 2]], out: &mut [SampledEvent]) {
        let (points, uniforms, events) = (p.len(), u.len(), out.len());
        assert!(
            points == uniforms && points == events,
            "p, u and out must be of equal length, got {points}, {uniforms} and {events}",
        );
        for ((&p, &u), out) in p.iter().zip(u).zip(out) {
            *out = self.next_event_sampled(p, u).unwrap_or(SampledEvent::DARK);
        }
    }

    /// Writes the [`sample_ray`](Self::sample_ray) of the uniforms `u[i]` to `out[i]`.
    ///
    /// # Panics
    ///
    /// Panics unless `u.len() == out.len()`.
    fn sample_ray_batch(&self, u: &[[f64; 4]], out: &mut [RaySample]) {
        let (uniforms, rays) = (u.len(), out.len());
        assert!(
            uniforms == rays,
            "u and out must be of equal length, got {uniforms} and {rays}",
        );
        for (&u, out) in u.iter().zip(out) {
            *out = self.sample_ray(u);
        }
    }
}

/// Returns the radiance of a ray from a point of the aperture plane.
fn radiance_of(light: &(impl Emitter + ?Sized), position: [f64; 2], slope: [f64; 2]) -> f64 {
    let pdf = light.densities(position, slope);
    light.power() * pdf.position_given_direction * pdf.direction * secant(slope)
}

/// Panics unless all slices of a batch have equal length.
fn check_lengths<const N: usize>(points: [&[f64]; 3], out: [usize; N]) {
    let [x, y, z] = points.map(<[f64]>::len);
    assert!(
        [y, z].iter().chain(&out).all(|&len| len == x),
        "x, y, z and out must be of equal length, got {x}, {y}, {z} and {out:?}",
    );
}
