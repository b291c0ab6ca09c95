use super::emitter::{Emitter, larger};
use super::frame::Frame;
use super::phase_space::{Flow, PhaseSpace, Reach, SlopeSample};
use super::record::RayPdf;
use super::{
    Axis, DEFAULT_CUTOFF, Placement, check_digits, checked_power, first_three, row, to_single,
};
use crate::normal::{normal_density, standard_normal};
use crate::profile::SlopeDensity;
use crate::real::Real;
use crate::{BeamError, LaserLine};

/// A laser line in a scene, prepared for a renderer.
///
/// A plain struct of 24 scalars, six rows of four as a GPU buffer wants them. Its fields are
/// public: [`place`](LineLight::place) checks its arguments, whoever writes the fields keeps them
/// meaningful. All lengths share one unit, metres unless the caller uses another throughout.
///
/// With the local coordinates `(x, y, z) = (e · (p − origin))`, `Z = z + apex_offset`, the slope
/// `u = x / Z` and the slant distance `r = √(x² + Z²)` from the virtual apex:
///
/// ```text
/// E = P g(u) / Z · √(2/π) / w · exp(−2 y² / w²)     with w = w(r)
/// F = E · (u, y √(1 + u²) w'/w, 1)
/// ```
///
/// `g` is uniform on [−flat, flat], convolved with a normal density of standard deviation `sigma`.
/// The cut-off is `|y| ≤ cutoff · w` and `|u| ≤ flat + 2 cutoff · sigma`.
///
/// A ray has the slope `u ~ g` in the fan plane and passes the virtual apex at the distance
/// `b ~ N(0, source_radius / 2)`. Across the fan it has the offset `y₀ ~ N(0, w₀ / 2)` at the waist
/// and the slope `s ~ N(0, δ / 2)` per slant distance. With the elevation `β = atan s` out of the
/// fan plane:
///
/// ```text
/// L = P f(θ) G(b) G(s) G(y₀) / cos⁴ β     with f(θ) = g(tan θ) / cos² θ
/// ```
///
/// # Examples
///
/// ```
/// use tem00_beam::{
///     DVec3, Emitter, FanGeometry, GaussianBeam, LaserLine, LineLight, LineProfile, Placement,
/// };
///
/// let fan = FanGeometry {
///     fan_angle: 30_f64.to_radians(),
///     apex_offset: 2e-3,
///     focus_distance: 0.2,
/// };
/// let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
/// let line = LaserLine::new(focus, fan, LineProfile::GaussianTan)?;
/// let placement = Placement {
///     origin: DVec3::new(0.0, 0.0, 0.2),
///     direction: DVec3::NEG_Z,
///     fan_axis: DVec3::X,
/// };
/// let light = LineLight::place(&line, &placement, 5e-3)?;
///
/// assert!(light.next_event([0.03, 0.0, 0.0]).is_some());
/// assert!(light.next_event([0.0, 0.03, 0.0]).is_none());
/// # Ok::<(), tem00_beam::BeamError>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineLight<T> {
    /// Centre of the lens, in metres.
    pub origin: [T; 3],
    /// Power, in watts.
    pub power: T,
    /// Unit vector along which the fan opens.
    pub ex: [T; 3],
    /// Distance from the fan plane, in beam radii, beyond which no light arrives.
    pub cutoff: T,
    /// Unit vector of the normal of the fan plane.
    pub ey: [T; 3],
    /// Distance of the virtual apex behind the lens, in metres.
    pub apex_offset: T,
    /// Unit vector along the direction of travel.
    pub ez: [T; 3],
    /// Radius of the virtual apex, in metres: the diffraction-limited width of the fan's source.
    pub source_radius: T,
    /// Beam radius across the fan; its `z0` is the slant distance from the virtual apex to the
    /// waist.
    pub y: Axis<T>,
    /// Half-width of the uniform part of the profile, as a slope; 0 for a Gaussian profile.
    pub flat: T,
    /// Standard deviation of the Gaussian part of the profile, as a slope.
    pub sigma: T,
    /// Unused, 0. Completes a row of four.
    pub pad: [T; 2],
}

impl LineLight<f64> {
    /// Places a laser line in a scene, with the lens at the placement's origin and a power in watts.
    ///
    /// # Errors
    ///
    /// Returns an error if the placement's origin is not finite or beyond 1e30 m, if `power` is
    /// negative or not finite, or if the placement's axes are not finite, have no length, or are
    /// parallel.
    pub fn place(line: &LaserLine, placement: &Placement, power: f64) -> Result<Self, BeamError> {
        let power = checked_power(power)?;
        let frame = placement.frame()?;
        let SlopeDensity { flat, sigma } = line.slope_density();
        Ok(Self {
            origin: frame.origin,
            power,
            ex: frame.ex,
            cutoff: DEFAULT_CUTOFF,
            ey: frame.ey,
            apex_offset: line.fan().apex_offset,
            ez: frame.ez,
            source_radius: line.source_radius(),
            y: Axis::new(line.focus(), line.waist_slant_distance()),
            flat,
            sigma,
            pad: [0.0; 2],
        })
    }

    /// Returns the light in single precision.
    ///
    /// # Errors
    ///
    /// Returns an error if a field overflows, or if the squared waist or divergence, the source
    /// radius, the slope deviation or the peak irradiance is outside the range of normal `f32`
    /// numbers.
    pub fn to_f32(&self) -> Result<LineLight<f32>, BeamError> {
        let across = normal_density(0.0, 0.5 * self.y.w0_sq.sqrt());
        let peak = self.power * self.slope_density().at(0.0) / self.apex_offset * across;
        let (y, source) = (self.y, self.source_radius);
        check_digits([y.w0_sq, y.theta_sq, source, self.sigma, peak])?;
        Ok(LineLight::from_rows(to_single(self.to_rows())?))
    }
}

impl<T: Real> LineLight<T> {
    /// Returns the fields in the order of memory, as six rows of four.
    pub fn to_rows(&self) -> [[T; 4]; 6] {
        [
            row(self.origin, self.power),
            row(self.ex, self.cutoff),
            row(self.ey, self.apex_offset),
            row(self.ez, self.source_radius),
            self.y.to_row(),
            [self.flat, self.sigma, self.pad[0], self.pad[1]],
        ]
    }

    /// Creates a light from its fields in the order of memory, as six rows of four.
    pub fn from_rows([origin, ex, ey, ez, y, profile]: [[T; 4]; 6]) -> Self {
        Self {
            origin: first_three(origin),
            power: origin[3],
            ex: first_three(ex),
            cutoff: ex[3],
            ey: first_three(ey),
            apex_offset: ey[3],
            ez: first_three(ez),
            source_radius: ez[3],
            y: Axis::from_row(y),
            flat: profile[0],
            sigma: profile[1],
            pad: [profile[2], profile[3]],
        }
    }

    fn slope_density(&self) -> SlopeDensity<T> {
        SlopeDensity {
            flat: self.flat,
            sigma: self.sigma,
        }
    }

    /// Returns `T = tan(α/2)`, the slope of the edges of the fan.
    pub fn half_slope(&self) -> T {
        if self.flat > T::ZERO {
            self.flat
        } else {
            T::of(2.0) * self.sigma
        }
    }

    /// Returns the largest slope within the cut-off.
    pub(super) fn largest_slope(&self) -> T {
        self.flat + T::of(2.0) * self.cutoff * self.sigma
    }
}

impl<T: Real> Emitter<T> for LineLight<T> {}

impl<T: Real> PhaseSpace<T> for LineLight<T> {
    fn frame(&self) -> Frame<T> {
        Frame {
            origin: self.origin,
            ex: self.ex,
            ey: self.ey,
            ez: self.ez,
        }
    }

    fn power(&self) -> T {
        self.power
    }

    fn flow(&self, [x, y, z]: [T; 3]) -> Option<Flow<T>> {
        let z = z + self.apex_offset;
        let u = x / z;
        if u.abs() > self.largest_slope() {
            return None;
        }
        let sec = secant(u);
        let r = z * sec;
        let w_sq = self.y.radius_sq_at(r);
        if y * y > self.cutoff * self.cutoff * w_sq {
            return None;
        }
        let across = normal_density(y, T::of(0.5) * w_sq.sqrt());
        Some(Flow {
            irradiance: self.power * self.slope_density().at(u) / z * across,
            slope: [u, y * self.y.growth_at(r) * sec],
        })
    }

    /// Draws the impact parameter, which fixes the ray in the fan plane, then the slope across it.
    fn sample_slope(&self, [x, y, z]: [T; 3], u: [T; 2]) -> SlopeSample<T> {
        let z = z + self.apex_offset;
        let sigma_b = T::of(0.5) * self.source_radius;
        let b = sigma_b * standard_normal(u[0]);
        // The foot of the perpendicular from the apex is at distance b: r' = √(r² − b²) from there.
        let r = z * secant(x / z);
        let along = ((r - b) * (r + b)).sqrt();
        // sin(θ_p − θ) = b / r, with θ_p the angle of the point.
        let slope_x = (x * along - z * b) / (z * along + x * b);
        let (mean, sigma_s) = self.y.conditional_slope(y, along);
        let deviation = sigma_s * standard_normal(u[1]);
        let s = mean + deviation;
        let (sec_fan, sec_elevation) = (secant(slope_x), secant(s));

        let f = self.slope_density().at(slope_x) * sec_fan * sec_fan;
        let across = normal_density(y, T::of(0.5) * self.y.radius_sq_at(along).sqrt());
        let density = normal_density(b, sigma_b) * along * normal_density(deviation, sigma_s);
        SlopeSample {
            slope: [slope_x, s * sec_fan],
            pdf: density * sec_elevation * sec_elevation * sec_elevation,
            value: self.power * f / along * across * sec_elevation,
        }
    }

    fn draw(&self, u: [T; 4]) -> ([T; 2], [T; 2]) {
        let (sigma_y, sigma_s) = self.y.deviations();
        let slope_x = self.slope_density().sample(u[2]);
        let b = T::of(0.5) * self.source_radius * standard_normal(u[0]);
        let y_waist = sigma_y * standard_normal(u[1]);
        let s = sigma_s * standard_normal(u[3]);
        let sec = secant(slope_x);
        let along = self.apex_offset * sec + b * slope_x;
        let x = self.apex_offset * slope_x + b * sec;
        let y = y_waist + s * (along - self.y.z0);
        ([x, y], [slope_x, s * sec])
    }

    /// A ray leaves the aperture at `x = z_a u + b sec θ`, so that `dx dy = sec θ db dy₀`.
    fn densities(&self, [x, y]: [T; 2], slope: [T; 2]) -> RayPdf<T> {
        let (sigma_y, sigma_s) = self.y.deviations();
        let sec_fan = secant(slope[0]);
        let s = slope[1] / sec_fan;
        let sec_elevation = secant(s);
        let b = (x - self.apex_offset * slope[0]) / sec_fan;
        let along = (x * slope[0] + self.apex_offset) / sec_fan;
        let y_waist = y - s * (along - self.y.z0);

        let source = normal_density(b, T::of(0.5) * self.source_radius);
        let f = self.slope_density().at(slope[0]) * sec_fan * sec_fan;
        let elevation = normal_density(s, sigma_s) * sec_elevation * sec_elevation * sec_elevation;
        RayPdf {
            position: source * normal_density(y_waist, sigma_y) / sec_fan,
            direction: f * elevation,
        }
    }

    fn reach(&self, l: T) -> Reach<T> {
        let slope = self.largest_slope();
        let sec = secant(slope);
        let far = (l + self.apex_offset) * sec;
        // w² is convex in r, so it is largest at one of the ends.
        let w_sq = larger(
            self.y.radius_sq_at(self.apex_offset),
            self.y.radius_sq_at(far),
        );
        let elevation = self.cutoff * self.y.theta_sq.sqrt() * sec;
        Reach {
            half_width: [slope * (l + self.apex_offset), self.cutoff * w_sq.sqrt()],
            slope: (slope * slope + elevation * elevation).sqrt(),
        }
    }
}

/// Returns `√(1 + u²)`.
fn secant<T: Real>(u: T) -> T {
    (T::ONE + u * u).sqrt()
}
