use core::f64::consts::FRAC_2_PI;

use glam::DMat2;

use super::axis::Axis;
use super::ellipse::{Ellipse, Factors};
use super::emitter::Emitter;
use super::frame::{Frame, Placement};
use super::phase_space::{Flow, PhaseSpace, Reach, SlopeSample};
use super::power_bound::{LocalBox, chance};
use super::record::RayPdf;
use super::rows::{DEFAULT_CUTOFF, check_digits, checked_power, first_three, row, to_single};
use super::slope::secant;
use crate::normal::standard_normal;
use crate::real::Real;
use crate::{BeamError, GeneralAstigmaticBeam};

/// A beam with general astigmatism in a scene, prepared for a renderer.
///
/// Its ellipse may turn on the way, and its rays may be twisted about the axis. A plain struct of 28
/// scalars, seven rows of four as a GPU buffer wants them. Its fields are public:
/// [`place`](AstigmaticLight::place) checks its arguments, whoever writes the fields keeps them
/// meaningful. All lengths share one unit, metres unless the caller uses another throughout.
///
/// A ray has the slope `s ~ N(0, S/4)` and crosses the aperture plane at `K s + e`, with an
/// independent `e ~ N(0, W/4)`. With the local coordinates `x = (x, y)` and `z`, and
/// `M = K + z · 1`:
///
/// ```text
/// V = W + M S Mᵀ                                   squared radii of the beam at z
/// E = 2 P / (π √det V) · exp(−2 xᵀ V⁻¹ x)          if xᵀ V⁻¹ x ≤ cutoff², z ≥ 0
/// F = E · (S Mᵀ V⁻¹ x, 1)                          the bracket is the mean slope at x
/// L = 4 P / (π² √(det W det S)) · exp(−2 eᵀ W⁻¹ e − 2 sᵀ S⁻¹ s) / cos⁴ θ
/// ```
///
/// V is a sum of positive parts on purpose: multiplied out into powers of z it loses all digits of
/// `f32` near a focus. So is its determinant,
///
/// ```text
/// det V = det W + tr(adj(W) M S Mᵀ) + det S (det M)²
/// ```
///
/// # Validity
///
/// In `f32` the ellipses W and S lose digits where they are long, thin and oblique to x and y: the
/// relative error of the irradiance is `ε` times the square of their ratio of axes, besides that of
/// the coordinates. Placing the x axis along the ellipse avoids it.
///
/// # Examples
///
/// A cylinder lens at 45° to an elliptic beam makes a spot that turns on its way:
///
/// ```
/// use core::f64::consts::FRAC_PI_4;
/// use tem00_beam::{AstigmaticBeam, AstigmaticLight, DVec3, Emitter, GeneralAstigmaticBeam, Placement};
/// use tem00_beam::optics::AstigmaticSystem;
///
/// let elliptic = AstigmaticBeam::from_divergences(650e-9, [0.5e-3, 1e-3])?;
/// let lens = AstigmaticSystem::cylinder_lens(0.1, FRAC_PI_4)?;
/// let beam = GeneralAstigmaticBeam::from(elliptic).through(&lens)?;
///
/// let placement = Placement {
///     origin: DVec3::ZERO,
///     direction: DVec3::Z,
///     fan_axis: DVec3::X,
/// };
/// let light = AstigmaticLight::place(&beam, &placement, 5e-3)?;
/// let diagonals = [1e-4, -1e-4].map(|x| light.irradiance([x, 1e-4, 0.1]));
/// assert!(diagonals[0] < 0.2 * diagonals[1]);
/// # Ok::<(), tem00_beam::BeamError>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AstigmaticLight<T> {
    /// Centre of the aperture, in metres.
    pub origin: [T; 3],
    /// Power, in watts.
    pub power: T,
    /// Unit vector of the local x axis.
    pub ex: [T; 3],
    /// Distance from the axis, in beam radii, beyond which no light arrives.
    pub cutoff: T,
    /// Unit vector of the local y axis.
    pub ey: [T; 3],
    /// Wavelength in the medium, in metres.
    pub wavelength: T,
    /// Unit vector along the direction of travel.
    pub ez: [T; 3],
    /// Unused, 0. Completes a row of four.
    pub pad_ez: T,
    /// W: squared radii of the position on the aperture plane of rays with a given slope, in m².
    pub position: Ellipse<T>,
    /// S: squared radii of the slope, in rad².
    pub slope: Ellipse<T>,
    /// K: mean position on the aperture plane per slope, in metres, in rows. A circular beam with
    /// its waist at the distance `z0` has −z0 on the diagonal.
    pub position_per_slope: [[T; 2]; 2],
}

impl AstigmaticLight<f64> {
    /// Places a beam in a scene, with its reference plane as the aperture and a power in watts.
    ///
    /// # Errors
    ///
    /// Returns an error if the placement's origin is not finite or beyond 1e30 m, if `power` does not
    /// lie between 0 and 1e100 W, or if the placement's axes are not finite, have no length, or are
    /// parallel.
    pub fn place(
        beam: &GeneralAstigmaticBeam,
        placement: &Placement,
        power: f64,
    ) -> Result<Self, BeamError> {
        let power = checked_power(power)?;
        let frame = placement.frame()?;
        // The radius to 1/e² is twice the standard deviation.
        let ellipse = |covariance: DMat2| {
            let DMat2 { x_axis, y_axis } = 4.0 * covariance;
            Ellipse::new(x_axis.x, x_axis.y, y_axis.y)
        };
        let k = beam.position_per_slope().transpose();
        Ok(Self {
            origin: frame.origin,
            power,
            ex: frame.ex,
            cutoff: DEFAULT_CUTOFF,
            ey: frame.ey,
            wavelength: beam.wavelength(),
            ez: frame.ez,
            pad_ez: 0.0,
            position: ellipse(beam.position_spread()),
            slope: ellipse(beam.moments_at(0.0).slope),
            position_per_slope: [k.x_axis.to_array(), k.y_axis.to_array()],
        })
    }

    /// Returns the light in single precision.
    ///
    /// # Errors
    ///
    /// Returns an error if a field overflows, if the determinant of W or S or the peak irradiance is
    /// outside the range of normal `f32` numbers, or if rounding the elements of W or S changes its
    /// determinant by more than 1 %.
    pub fn to_f32(&self) -> Result<AstigmaticLight<f32>, BeamError> {
        let areas = [self.position, self.slope].map(|ellipse| ellipse.determinant());
        let peak = FRAC_2_PI * self.power / areas[0].sqrt();
        check_digits([areas[0], areas[1], peak])?;
        let light = AstigmaticLight::from_rows(to_single(self.to_rows())?);
        for (ellipse, area) in [light.position, light.slope].iter().zip(areas) {
            let [xx, xy, yy] = [ellipse.xx, ellipse.xy, ellipse.yy].map(f64::from);
            let rounded = Ellipse::new(xx, xy, yy).determinant();
            if (rounded / area - 1.0).abs() > 0.01 {
                return Err(BeamError::single_precision(area));
            }
        }
        Ok(light)
    }
}

impl<T: Real> AstigmaticLight<T> {
    /// Returns the fields in the order of memory, as seven rows of four.
    pub fn to_rows(&self) -> [[T; 4]; 7] {
        let [[xx, xy], [yx, yy]] = self.position_per_slope;
        [
            row(self.origin, self.power),
            row(self.ex, self.cutoff),
            row(self.ey, self.wavelength),
            row(self.ez, self.pad_ez),
            self.position.to_row(),
            self.slope.to_row(),
            [xx, xy, yx, yy],
        ]
    }

    /// Creates a light from its fields in the order of memory, as seven rows of four.
    pub fn from_rows([origin, ex, ey, ez, position, slope, k]: [[T; 4]; 7]) -> Self {
        Self {
            origin: first_three(origin),
            power: origin[3],
            ex: first_three(ex),
            cutoff: ex[3],
            ey: first_three(ey),
            wavelength: ey[3],
            ez: first_three(ez),
            pad_ez: ez[3],
            position: Ellipse::from_row(position),
            slope: Ellipse::from_row(slope),
            position_per_slope: [[k[0], k[1]], [k[2], k[3]]],
        }
    }

    /// Returns `M = K + z · 1`, the mean position at the distance `z` per slope.
    #[inline(always)]
    fn position_per_slope_at(&self, z: T) -> [[T; 2]; 2] {
        let [[xx, xy], [yx, yy]] = self.position_per_slope;
        [[xx + z, xy], [yx, yy + z]]
    }

    /// Returns the radii of the beam along x and along y, each with the distance to where it is
    /// smallest.
    ///
    /// ```text
    /// V_xx(z) = W_xx + K_xy² det S / S_xx + S_xx (z + (K S)_xx / S_xx)²
    /// ```
    fn axes(&self) -> [Axis<T>; 2] {
        let [[xx, xy], [yx, yy]] = self.position_per_slope;
        let (w, s, determinant) = (self.position, self.slope, self.slope.determinant());
        let axis = |w: T, s: T, along: T, across: T| Axis {
            w0_sq: w + across * across * determinant / s,
            theta_sq: s,
            z0: -(along + across * self.slope.xy / s),
            pad: T::ZERO,
        };
        [axis(w.xx, s.xx, xx, xy), axis(w.yy, s.yy, yy, yx)]
    }

    /// Returns the squared radii V of the beam, and their determinant.
    #[inline(always)]
    fn radii_sq(&self, m: [[T; 2]; 2]) -> (Ellipse<T>, T) {
        let spread = self.slope.mapped(m);
        let det_m = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        let determinant = self.position.determinant()
            + self.position.mixed_determinant(&spread)
            + self.slope.determinant() * det_m * det_m;
        (self.position.plus(&spread), determinant)
    }

    /// Returns the inverse of the squared radii of the slope at a point, and its determinant.
    ///
    /// ```text
    /// A = S⁻¹ + Mᵀ W⁻¹ M     det A = det V / (det W det S)
    /// ```
    fn conditional_slope(&self, m: [[T; 2]; 2], determinant: T) -> Factors<T> {
        let transposed = [[m[0][0], m[1][0]], [m[0][1], m[1][1]]];
        let spread = self.position.inverse().mapped(transposed);
        let determinant = determinant / self.position.determinant() / self.slope.determinant();
        self.slope.inverse().plus(&spread).factors_with(determinant)
    }
}

impl<T: Real> Emitter<T> for AstigmaticLight<T> {
    fn power(&self) -> T {
        self.power
    }

    fn wavelength(&self) -> T {
        self.wavelength
    }
}

impl<T: Real> PhaseSpace<T> for AstigmaticLight<T> {
    #[inline(always)]
    fn frame(&self) -> Frame<T> {
        Frame {
            origin: self.origin,
            ex: self.ex,
            ey: self.ey,
            ez: self.ez,
        }
    }

    #[inline(always)]
    fn flow(&self, [x, y, z]: [T; 3]) -> Flow<T> {
        let m = self.position_per_slope_at(z);
        let (radii_sq, determinant) = self.radii_sq(m);
        let factors = radii_sq.factors_with(determinant);
        let lit = (factors.norm_sq([x, y]) <= self.cutoff * self.cutoff) & (factors.y > T::ZERO);
        let [tx, ty] = factors.solve([x, y]);
        let [sx, sy] = self.slope.times_transposed(m);
        Flow {
            irradiance: (self.power * factors.density([x, y])).only_if(lit),
            slope: [sx[0] * tx + sx[1] * ty, sy[0] * tx + sy[1] * ty],
        }
    }

    fn sample_slope(&self, local: [T; 3], u: [T; 2]) -> SlopeSample<T> {
        let m = self.position_per_slope_at(local[2]);
        let (_, determinant) = self.radii_sq(m);
        let factors = self.conditional_slope(m, determinant);
        let normals = u.map(standard_normal);
        let deviation = factors.spread_inverse(normals);
        let flow = self.flow(local);
        let slope = [flow.slope[0] + deviation[0], flow.slope[1] + deviation[1]];
        let sec = secant(slope);
        let radius_sq = normals[0] * normals[0] + normals[1] * normals[1];
        let density =
            T::of(FRAC_2_PI) * factors.root_determinant() * (T::of(-0.5) * radius_sq).exp();
        SlopeSample {
            slope,
            pdf: density * sec * sec * sec,
            value: flow.irradiance * sec,
        }
    }

    fn slope_pdf(&self, local: [T; 3], slope: [T; 2]) -> T {
        let m = self.position_per_slope_at(local[2]);
        let (_, determinant) = self.radii_sq(m);
        let mean = self.flow(local).slope;
        let deviation = [slope[0] - mean[0], slope[1] - mean[1]];
        let factors = self.conditional_slope(m, determinant);
        let radius_sq = factors.norm_sq_inverse(deviation);
        let sec = secant(slope);
        let density =
            T::of(FRAC_2_PI) * factors.root_determinant() * (T::of(-2.0) * radius_sq).exp();
        density * sec * sec * sec
    }

    fn draw(&self, u: [T; 4]) -> ([T; 2], [T; 2]) {
        let [ux, uy, ux_slope, uy_slope] = u.map(standard_normal);
        let slope = self.slope.factors().spread([ux_slope, uy_slope]);
        let deviation = self.position.factors().spread([ux, uy]);
        let k = self.position_per_slope;
        let position = [0, 1].map(|i| k[i][0] * slope[0] + k[i][1] * slope[1] + deviation[i]);
        (position, slope)
    }

    fn densities(&self, position: [T; 2], slope: [T; 2]) -> RayPdf<T> {
        let k = self.position_per_slope;
        let deviation = [0, 1].map(|i| position[i] - (k[i][0] * slope[0] + k[i][1] * slope[1]));
        // dω = cos³ ds_x ds_y
        let sec = secant(slope);
        let (radii_sq, determinant) = self.radii_sq(k);
        let [x, y] = position;
        let density = radii_sq.factors_with(determinant).density(position);
        RayPdf {
            direction: self.slope.factors().density(slope) * sec * sec * sec,
            position_given_direction: self.position.factors().density(deviation),
            ..RayPdf::from_position(density, || self.slope_pdf([x, y, T::ZERO], slope))
        }
    }

    /// The smallest of the bounds for x alone, for y alone, and for the middle of the box: no more than
    /// the largest density there times the area that rays of the box pass, `d` off their mean slope.
    ///
    /// ```text
    /// E[(a_x + 2 h |d_x|) (a_y + 2 h |d_y|)] ≤ (a_x + 2 h σ_x) (a_y + 2 h σ_y)
    /// ```
    fn fraction_bound(&self, target: &LocalBox) -> f64 {
        let light = AstigmaticLight::from_rows(self.to_rows().map(|row| row.map(T::wide)));
        let [along_x, along_y] = light
            .axes()
            .map(|axis| (axis, target.z.map(|z| z - axis.z0)));
        let x = chance(&along_x.0, along_x.1, target.x, light.cutoff);
        let y = chance(&along_y.0, along_y.1, target.y, light.cutoff);
        let [near, far] = target.z;
        let m = light.position_per_slope_at(0.5 * (near + far));
        let (radii_sq, determinant) = light.radii_sq(m);
        let peak = radii_sq.factors_with(determinant).density([0.0; 2]);
        let conditional = light.conditional_slope(m, determinant).inverse_diagonal();
        let steepest = light.cutoff * light.slope.largest().sqrt();
        let sides = [target.x, target.y].into_iter().zip(conditional);
        let sides = sides.map(|([low, high], slope_sq)| {
            high - low + (far - near) * (steepest + 0.5 * slope_sq.sqrt())
        });
        x.min(y).min(peak * sides.product::<f64>())
    }

    /// The mean slope s̄ = S Mᵀ V⁻¹ x is within the cut-off of S: s̄ᵀ S⁻¹ s̄ ≤ xᵀ V⁻¹ x, as
    /// M S Mᵀ ≤ V.
    fn reach(&self, l: T) -> Reach<T> {
        let at = |z| self.radii_sq(self.position_per_slope_at(z)).0;
        let (near, far) = (at(T::ZERO), at(l));
        // Both elements are convex in z, so they are largest at one of the ends.
        Reach {
            half_width: [
                self.cutoff * near.xx.larger(far.xx).sqrt(),
                self.cutoff * near.yy.larger(far.yy).sqrt(),
            ],
            slope: self.cutoff * self.slope.largest().sqrt(),
        }
    }
}

#[cfg(test)]
mod tests;
