//! The laws of a laser line with any profile along the fan.
#![expect(unnameable_types, reason = "it belongs to a sealed trait")]

use core::f64::consts::FRAC_PI_2;

use tem00_numerics::vectorised;

use super::emitter::Emitter;
use super::frame::Frame;
use super::line::LineLight;
use super::phase_space::{Batch, Flow, PhaseSpace, Reach, SlopeSample};
use super::power_bound::{LocalBox, ROUNDING, chance};
use super::record::RayPdf;
use super::slope::secant;
use crate::normal::{HALF_SPACING, normal_density, standard_normal};
use crate::profile::{SlopeDensity, SlopeProfile, Variable};

/// A laser line with a profile along its fan.
pub trait Fan {
    type Profile: SlopeProfile;

    fn line(&self) -> &LineLight;
    fn profile(&self) -> Self::Profile;

    /// Answers a query at many points. A profile without tables and special functions overrides
    /// this method with a loop that fills the vector units.
    fn run_batch(&self, batch: Batch<'_>)
    where
        Self: Sized,
    {
        batch.over(self);
    }
}

/// Returns the marginal density of the position on the aperture plane, per m², over all directions.
///
/// ```text
/// ∫ δ(x − z_a tan θ − b sec θ) f(θ) G(b) dθ db = (f * G(σ_b/r)) cos² θ / z_a    at tan θ = x / z_a
/// ```
///
/// to second order in `σ_b/r`, the angular spread of the rays through a point, and to first order
/// within this angle of an abrupt end.
fn position_density(fan: &impl Fan, [x, y]: [f64; 2]) -> f64 {
    let line = fan.line();
    let u = x / line.apex_offset;
    let sec = secant([u]);
    let r = line.apex_offset * sec;
    let sigma = 0.5 * line.source_radius / r;
    let w_sq = line.axis_towards(sec).radius_sq_at(r);
    let across = normal_density(y, 0.5 * w_sq.sqrt());
    fan.profile().spread_per_angle(u, sigma) / (r * sec) * across
}

impl<F: Fan> PhaseSpace for F {
    #[inline(always)]
    fn frame(&self) -> Frame {
        let line = self.line();
        Frame {
            origin: line.origin,
            ex: line.ex,
            ey: line.ey,
            ez: line.ez,
        }
    }

    fn run(&self, batch: Batch<'_>) {
        self.run_batch(batch);
    }

    #[inline(always)]
    fn flow(&self, [x, y, z]: [f64; 3]) -> Flow {
        let (line, profile) = (self.line(), self.profile());
        let z = z + line.apex_offset;
        let u = x / z;
        let sec = secant([u]);
        let (axis, r) = (line.axis_towards(sec), z * sec);
        let w_sq = axis.radius_sq_at(r);
        let lit = profile.reaches(u, line.cutoff) & (y * y <= line.cutoff * line.cutoff * w_sq);
        let irradiance = if lit {
            let across = normal_density(y, 0.5 * w_sq.sqrt());
            line.power * profile.per_slope(u) / z * across
        } else {
            0.0
        };
        Flow {
            irradiance,
            slope: [u, y * axis.growth_at(r) * sec],
        }
    }

    /// Draws the impact parameter, which fixes the ray in the fan plane, then the slope across it.
    fn sample_slope(&self, [x, y, z]: [f64; 3], u: [f64; 2]) -> SlopeSample {
        let line = self.line();
        let z = z + line.apex_offset;
        let sigma_b = 0.5 * line.source_radius;
        let b = sigma_b * standard_normal(u[0]);
        // The foot of the perpendicular from the apex is at distance b: r' = √(r² − b²) from there.
        let slope = x / z;
        let r = z * secant([slope]);
        let along = (r - b).sqrt() * (r + b).sqrt();
        // tan(θ_p − θ) = b / r', with θ_p the angle of the point.
        let turn = b / along;
        let slope_x = (slope - turn) / (1.0 + slope * turn);
        let sec_fan = secant([slope_x]);
        let axis = line.axis_towards(sec_fan);
        let (mean, sigma_s) = axis.conditional_slope(y, along);
        let deviation = sigma_s * standard_normal(u[1]);
        let s = mean + deviation;
        let sec_elevation = secant([s]);

        let f = self.profile().per_angle(slope_x);
        let across = normal_density(y, 0.5 * axis.radius_sq_at(along).sqrt());
        let density = normal_density(b, sigma_b) * along * normal_density(deviation, sigma_s);
        SlopeSample {
            slope: [slope_x, s * sec_fan],
            pdf: density * sec_elevation * sec_elevation * sec_elevation,
            value: line.power * f / along * across * sec_elevation,
        }
    }

    fn slope_pdf(&self, [x, y, z]: [f64; 3], slope: [f64; 2]) -> f64 {
        let line = self.line();
        let z = z + line.apex_offset;
        let sec_fan = secant([slope[0]]);
        let s = slope[1] / sec_fan;
        let sec_elevation = secant([s]);
        // In the fan plane the ray passes the apex at the distance b, and the point lies `along`
        // behind the foot of the perpendicular.
        let b = (x - slope[0] * z) / sec_fan;
        let along = (x * slope[0] + z) / sec_fan;
        if along <= 0.0 {
            return 0.0;
        }
        let (mean, sigma_s) = line.axis_towards(sec_fan).conditional_slope(y, along);
        let density =
            normal_density(b, 0.5 * line.source_radius) * normal_density(s - mean, sigma_s);
        // Far away `along` overflows, and 0 · ∞ would be NaN.
        if density > 0.0 {
            density * along * sec_elevation * sec_elevation * sec_elevation
        } else {
            0.0
        }
    }

    fn draw(&self, u: [f64; 4]) -> ([f64; 2], [f64; 2]) {
        let line = self.line();
        let (sigma_y, sigma_s) = line.y.deviations();
        let slope_x = self.profile().quantile(u[2]);
        let b = 0.5 * line.source_radius * standard_normal(u[0]);
        let y_waist = sigma_y * standard_normal(u[1]);
        let s = sigma_s * standard_normal(u[3]);
        let sec = secant([slope_x]);
        let along = line.apex_offset * sec + b * slope_x;
        let x = line.apex_offset * slope_x + b * sec;
        let y = y_waist + s * (along - line.axis_towards(sec).z0);
        ([x, y], [slope_x, s * sec])
    }

    /// A ray leaves the aperture at `x = z_a u + b sec θ`, so that `dx dy = sec θ db dy₀`.
    fn densities(&self, [x, y]: [f64; 2], slope: [f64; 2]) -> RayPdf {
        let line = self.line();
        let (sigma_y, sigma_s) = line.y.deviations();
        let sec_fan = secant([slope[0]]);
        let s = slope[1] / sec_fan;
        let sec_elevation = secant([s]);
        let b = (x - line.apex_offset * slope[0]) / sec_fan;
        let along = (x * slope[0] + line.apex_offset) / sec_fan;
        let y_waist = y - s * (along - line.axis_towards(sec_fan).z0);

        let sigma_b = 0.5 * line.source_radius;
        let source = normal_density(b, sigma_b);
        let f = self.profile().per_angle(slope[0]);
        let elevation = normal_density(s, sigma_s) * sec_elevation * sec_elevation * sec_elevation;
        let given_direction = source * normal_density(y_waist, sigma_y) / sec_fan;
        // A ray whose terms overflow, so that 0 · ∞ is NaN, passes far from the light.
        let given_direction = if given_direction > 0.0 {
            given_direction
        } else {
            0.0
        };
        let direction = f * elevation;
        let position = position_density(self, [x, y]);
        RayPdf {
            direction,
            position_given_direction: given_direction,
            ..RayPdf::from_position(position, || direction * given_direction / position)
        }
    }

    /// The fraction of the fan that meets the box, times the fraction of the light across the fan
    /// that does.
    fn fraction_bound(&self, target: &LocalBox) -> f64 {
        let line = self.line();
        let [near, far] = target.z.map(|z| z + line.apex_offset);
        // Rays within the cut-off pass the apex at this distance or less.
        let source = line.cutoff * line.source_radius;
        let turn = (source / near).min(1.0).asin();
        let widest = self.profile().largest_slope(self.line().cutoff);
        let outwards = |x: f64| {
            let slope = if x > 0.0 { x / near } else { x / far };
            let angle = (slope.atan() + turn).min(FRAC_PI_2);
            let slope = angle.tan().min(widest);
            slope + 4.0 * HALF_SPACING * slope.abs()
        };
        let [low, high] = [-outwards(-target.x[0]), outwards(target.x[1])];
        if low > high || high < -widest || low > widest {
            return 0.0;
        }
        let along = self.profile().between(low, high) + ROUNDING;
        let steepest = low.abs().max(high.abs());
        let secants = [secant([low.max(-high).max(0.0)]), secant([steepest])];
        let dz = line.distances_from_waist([near, far], secants, source * steepest);
        along.min(1.0) * chance(&line.y, dz, target.y, line.cutoff)
    }

    fn reach(&self, l: f64) -> Reach {
        let slope = self.profile().largest_slope(self.line().cutoff);
        let line = self.line();
        let sec = secant([slope]);
        let (near, far) = (line.apex_offset, l + line.apex_offset);
        // w² is convex in the slant distance and in its secant, so it is largest at a corner.
        let corners = [(near, 1.0), (near * sec, sec), (far * sec, sec)];
        let w_sq = corners
            .map(|(r, sec)| line.axis_towards(sec).radius_sq_at(r))
            .into_iter()
            .fold(0.0, f64::max);
        let elevation = line.cutoff * line.y.theta_sq.sqrt() * sec;
        Reach {
            half_width: [slope * far, (line.cutoff * w_sq.sqrt())],
            slope: slope.hypot(elevation),
        }
    }
}

impl Emitter for LineLight {
    fn power(&self) -> f64 {
        self.power
    }

    fn wavelength(&self) -> f64 {
        self.wavelength
    }
}

impl Fan for LineLight {
    type Profile = SlopeDensity;

    #[inline(always)]
    fn line(&self) -> &Self {
        self
    }

    #[inline(always)]
    fn profile(&self) -> SlopeDensity {
        self.slope_density()
    }

    /// Writes the constants of a Gaussian into the loop, so that the compiler drops the branches to
    /// the other profiles.
    fn run_batch(&self, batch: Batch<'_>) {
        const TAN: f64 = Variable::Tan.code();
        const SIN: f64 = Variable::Sin.code();
        let is_gaussian_in = |code: f64| self.flat == 0.0 && (self.variable - code).abs() < 0.5;
        if is_gaussian_in(TAN) {
            vectorised(
                #[inline(always)]
                || batch.over(&self.gaussian_in(TAN)),
            );
        } else if is_gaussian_in(SIN) {
            vectorised(
                #[inline(always)]
                || batch.over(&self.gaussian_in(SIN)),
            );
        } else {
            batch.over(self);
        }
    }
}

impl LineLight {
    /// Returns the range of the distances from the waist, along rays whose secants are in a range,
    /// at distances from the plane of the apex in another range, each ±`slack`.
    fn distances_from_waist(
        &self,
        [near, far]: [f64; 2],
        secants: [f64; 2],
        slack: f64,
    ) -> [f64; 2] {
        let [near, far, slant] = if self.focus_on_plane > 0.0 {
            [near - self.y.z0, far - self.y.z0, 0.0]
        } else {
            [near, far, self.y.z0]
        };
        let [narrow, wide] = secants;
        let first = if near > 0.0 {
            near * narrow
        } else {
            near * wide
        };
        let last = if far > 0.0 { far * wide } else { far * narrow };
        [first - slant - slack, last - slant + slack]
    }

    /// Returns the light with the profile of a Gaussian in the variable of this code.
    #[inline(always)]
    fn gaussian_in(&self, code: f64) -> Self {
        Self {
            flat: 0.0,
            variable: code,
            ..*self
        }
    }
}
