use core::f64::consts::PI;

use tem00_numerics::cast::to_f32;

use super::axis::Axis;
use super::emitter::Emitter;
use super::frame::{Frame, Placement};
use super::phase_space::{Flow, PhaseSpace, Reach, SlopeSample};
use super::power_bound::{LocalBox, chance};
use super::record::RayPdf;
use super::rows::{DEFAULT_CUTOFF, checked_power, first_three, row};
use super::slope::{only_if, secant};
use crate::exponential::exponential;
use crate::normal::{joint_normal_density, standard_normal};
use crate::{AstigmaticBeam, GaussianBeam, LocatedBeam, Refusal};

/// A Gaussian beam in a scene, circular or elliptic, prepared for a renderer.
///
/// A plain struct of 24 scalars in six rows of four, the layout of a GPU buffer. Its fields are
/// public: [`place`](SpotLight::place) checks its arguments, and a caller who writes the fields is
/// responsible for their values. All lengths share one unit, metres unless the caller uses another
/// throughout.
///
/// With the local coordinates `(x, y, z) = (e · (p − origin))`:
///
/// ```text
/// E = 2 P / (π w_x w_y) · exp(−2 (x²/w_x² + y²/w_y²))     if x²/w_x² + y²/w_y² ≤ cutoff², z ≥ 0
/// F = E · (x w_x'/w_x, y w_y'/w_y, 1)
/// ```
///
/// A ray crosses the waist at x₀ ~ N(0, w₀/2) with the slope s ~ N(0, δ/2), likewise along y: the
/// Wigner function of a Gaussian Schell-model beam, which is nowhere negative. Its radiance is
///
/// ```text
/// L = 4 P / (π² w₀² δ²) · exp(−2 |x₀|²/w₀² − 2 |s|²/δ²) / cos⁴ θ
/// ```
///
/// # Examples
///
/// ```
/// use tem00_beam::{DVec3, Emitter, GaussianBeam, Placement, SpotLight};
///
/// let beam = GaussianBeam::from_waist(650e-9, 50e-6)?;
/// let placement = Placement {
///     origin: DVec3::ZERO,
///     direction: DVec3::Z,
///     fan_axis: DVec3::X,
/// };
/// let light = SpotLight::place(&beam, 0.1, &placement, 1e-3)?;
///
/// let waist = light.irradiance([0.0, 0.0, 0.1]);
/// assert!((waist / 254.6e3 - 1.0).abs() < 1e-3); // W/m²
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Centre of the aperture, in metres.
    pub origin: [f64; 3],
    /// Power, in watts.
    pub power: f64,
    /// Unit vector of the local x axis.
    pub ex: [f64; 3],
    /// Distance from the axis, in beam radii, beyond which no light arrives.
    pub cutoff: f64,
    /// Unit vector of the local y axis.
    pub ey: [f64; 3],
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
    /// Unit vector along the direction of travel.
    pub ez: [f64; 3],
    /// Unused, 0. Completes a row of four.
    pub pad_ez: f64,
    /// Beam radius along x; its `z0` is the distance from the aperture to the waist.
    pub x: Axis,
    /// Beam radius along y; its `z0` is the distance from the aperture to the waist.
    pub y: Axis,
}

impl SpotLight {
    /// Places a beam in a scene, with its waist at the signed distance `waist_distance`, in metres,
    /// from the aperture along the axis, and a power in watts.
    ///
    /// # Errors
    ///
    /// Returns an error if `waist_distance` or the placement's origin is not finite or beyond
    /// 1e30 m, if `power` does not lie between 0 and 1e100 W, or if the placement's axes are not
    /// finite, have no length, or are parallel.
    pub fn place(
        beam: &GaussianBeam,
        waist_distance: f64,
        placement: &Placement,
        power: f64,
    ) -> Result<Self, Refusal> {
        let located = LocatedBeam::new(*beam, waist_distance)?;
        Self::place_astigmatic(&AstigmaticBeam::stigmatic(located), placement, power)
    }

    /// Places an elliptic beam in a scene, with its reference plane as the aperture and a power in
    /// watts.
    ///
    /// The local x axis is the first principal axis of the beam: the fan axis of the placement,
    /// turned by the rotation of the beam about the direction of travel.
    ///
    /// # Errors
    ///
    /// Returns an error if the placement's origin is not finite or beyond 1e30 m, if `power` does
    /// not lie between 0 and 1e100 W, or if the placement's axes are not finite, have no length, or
    /// are parallel.
    pub fn place_astigmatic(
        beam: &AstigmaticBeam,
        placement: &Placement,
        power: f64,
    ) -> Result<Self, Refusal> {
        let power = checked_power(power)?;
        let frame = placement.frame()?.turned(beam.rotation());
        let [x, y] = beam
            .axes()
            .map(|axis| Axis::new(axis.beam(), axis.waist_distance()));
        Ok(Self {
            origin: frame.origin,
            power,
            ex: frame.ex,
            cutoff: DEFAULT_CUTOFF,
            ey: frame.ey,
            wavelength: beam.wavelength(),
            ez: frame.ez,
            pad_ez: 0.0,
            x,
            y,
        })
    }

    /// Returns the fields in the order of memory, as six rows of four.
    pub fn to_rows(&self) -> [[f64; 4]; 6] {
        [
            row(self.origin, self.power),
            row(self.ex, self.cutoff),
            row(self.ey, self.wavelength),
            row(self.ez, self.pad_ez),
            self.x.to_row(),
            self.y.to_row(),
        ]
    }

    /// Returns the fields as [`to_rows`](Self::to_rows) does, rounded to `f32` for a kernel.
    pub fn to_rows_f32(&self) -> [[f32; 4]; 6] {
        self.to_rows().map(|row| row.map(to_f32))
    }

    /// Creates a light from its fields in the order of memory, as six rows of four.
    pub fn from_rows([origin, ex, ey, ez, x, y]: [[f64; 4]; 6]) -> Self {
        Self {
            origin: first_three(origin),
            power: origin[3],
            ex: first_three(ex),
            cutoff: ex[3],
            ey: first_three(ey),
            wavelength: ey[3],
            ez: first_three(ez),
            pad_ez: ez[3],
            x: Axis::from_row(x),
            y: Axis::from_row(y),
        }
    }
}

impl Emitter for SpotLight {
    fn power(&self) -> f64 {
        self.power
    }

    fn wavelength(&self) -> f64 {
        self.wavelength
    }
}

impl PhaseSpace for SpotLight {
    #[inline(always)]
    fn frame(&self) -> Frame {
        Frame {
            origin: self.origin,
            ex: self.ex,
            ey: self.ey,
            ez: self.ez,
        }
    }

    #[inline(always)]
    fn flow(&self, [x, y, z]: [f64; 3]) -> Flow {
        let (wx_sq, wy_sq) = (self.x.radius_sq_at(z), self.y.radius_sq_at(z));
        let rho_sq = x * x / wx_sq + y * y / wy_sq;
        let peak = (2.0 / PI) * self.power / (wx_sq.sqrt() * wy_sq.sqrt());
        Flow {
            irradiance: only_if(
                rho_sq <= self.cutoff * self.cutoff,
                peak * exponential(-2.0 * rho_sq),
            ),
            slope: [x * self.x.growth_at(z), y * self.y.growth_at(z)],
        }
    }

    fn sample_slope(&self, local: [f64; 3], u: [f64; 2]) -> SlopeSample {
        let [x, y, z] = local;
        let (mean_x, sigma_x) = self.x.conditional_slope(x, z);
        let (mean_y, sigma_y) = self.y.conditional_slope(y, z);
        let deviation = [
            sigma_x * standard_normal(u[0]),
            sigma_y * standard_normal(u[1]),
        ];
        let slope = [mean_x + deviation[0], mean_y + deviation[1]];
        let sec = secant(slope);
        let density = joint_normal_density(deviation, [sigma_x, sigma_y]);
        SlopeSample {
            slope,
            pdf: density * sec * sec * sec,
            value: self.flow(local).irradiance * sec,
        }
    }

    fn slope_pdf(&self, [x, y, z]: [f64; 3], slope: [f64; 2]) -> f64 {
        let (mean_x, sigma_x) = self.x.conditional_slope(x, z);
        let (mean_y, sigma_y) = self.y.conditional_slope(y, z);
        let deviation = [slope[0] - mean_x, slope[1] - mean_y];
        let sec = secant(slope);
        joint_normal_density(deviation, [sigma_x, sigma_y]) * sec * sec * sec
    }

    fn draw(&self, u: [f64; 4]) -> ([f64; 2], [f64; 2]) {
        let along = |axis: &Axis, u_position: f64, u_slope: f64| {
            let (sigma_position, sigma_slope) = axis.deviations();
            let slope = sigma_slope * standard_normal(u_slope);
            let waist = sigma_position * standard_normal(u_position);
            (waist - slope * axis.z0, slope)
        };
        let (x, slope_x) = along(&self.x, u[0], u[2]);
        let (y, slope_y) = along(&self.y, u[1], u[3]);
        ([x, y], [slope_x, slope_y])
    }

    fn densities(&self, position: [f64; 2], slope: [f64; 2]) -> RayPdf {
        let waist = [
            position[0] + slope[0] * self.x.z0,
            position[1] + slope[1] * self.y.z0,
        ];
        let ((waist_x, slope_x), (waist_y, slope_y)) = (self.x.deviations(), self.y.deviations());
        // dω = cos³ ds_x ds_y
        let sec = secant(slope);
        let radius_sq = [&self.x, &self.y].map(|axis| axis.radius_sq_at(0.0));
        let deviations = radius_sq.map(|w_sq| 0.5 * w_sq.sqrt());
        let [x, y] = position;
        RayPdf {
            direction: joint_normal_density(slope, [slope_x, slope_y]) * sec * sec * sec,
            position_given_direction: joint_normal_density(waist, [waist_x, waist_y]),
            ..RayPdf::from_position(joint_normal_density(position, deviations), || {
                self.slope_pdf([x, y, 0.0], slope)
            })
        }
    }

    fn fraction_bound(&self, target: &LocalBox) -> f64 {
        let along = |axis: &Axis, range: [f64; 2]| {
            let dz = target.z.map(|z| z - axis.z0);
            chance(axis, dz, range, self.cutoff)
        };
        along(&self.x, target.x) * along(&self.y, target.y)
    }

    fn reach(&self, l: f64) -> Reach {
        // w² is convex in z, so it is largest at one of the ends.
        let radius = |axis: &Axis| axis.radius_sq_at(0.0).max(axis.radius_sq_at(l)).sqrt();
        Reach {
            half_width: [self.cutoff * radius(&self.x), self.cutoff * radius(&self.y)],
            slope: self.cutoff * self.x.theta_sq.max(self.y.theta_sq).sqrt(),
        }
    }
}
