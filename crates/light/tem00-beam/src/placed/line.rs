use tem00_numerics::cast::to_f32;

use super::axis::Axis;
use super::frame::Placement;
use super::rows::{DEFAULT_CUTOFF, checked_power, first_three, row};
use crate::profile::SlopeDensity;
use crate::{FocusCurve, LaserLine, LineProfile, Refusal};

/// A laser line in a scene, prepared for a renderer.
///
/// A plain struct of 28 scalars in seven rows of four, the layout of a GPU buffer. Its fields are
/// public: [`place`](LineLight::place) checks its arguments, and a caller who writes the fields is
/// responsible for their values. All lengths share one unit, metres unless the caller uses another
/// throughout.
///
/// With the local coordinates `(x, y, z) = (e · (p − origin))`, `Z = z + apex_offset`, the slope
/// `u = x / Z` and the slant distance `r = √(x² + Z²)` from the virtual apex:
///
/// ```text
/// E = P g(u) / Z · √(2/π) / w · exp(−2 y² / w²)     with w = w(r)
/// F = E · (u, y √(1 + u²) w'/w, 1)
/// ```
///
/// The waist lies at `r = y.z0`, or at `r = y.z0 √(1 + u²)` if `focus_on_plane` is 1.
///
/// The density along the fan is given in the variable `v` that `variable` selects: uniform on
/// [−flat, flat], convolved with a normal density of standard deviation `sigma` (the normal alone
/// if `flat` is 0, a top hat if `sigma` is 0), and divided by `mass`, its fraction inside
/// `|θ| < π/2`. Per slope it is `g = g_v(v) dv/du`.
///
/// | `variable` | v | dv/du |
/// |---|---|---|
/// | 0 | u = tan θ | 1 |
/// | 1 | θ | 1 / (1 + u²) |
/// | 2 | sin θ | 1 / √(1 + u²)³ |
/// | 3 | tabulated, elsewhere | |
///
/// The cut-off is `|y| ≤ cutoff · w` and `|v| ≤ flat + 2 cutoff · sigma`.
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
///     DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile,
///     Placement,
/// };
///
/// let fan = FanGeometry {
///     fan_angle: 30_f64.to_radians(),
///     apex_offset: 2e-3,
///     focus_distance: 0.2,
///     focus_curve: FocusCurve::EqualDistance,
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
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineLight {
    /// Centre of the lens, in metres.
    pub origin: [f64; 3],
    /// Power, in watts.
    pub power: f64,
    /// Unit vector along which the fan opens.
    pub ex: [f64; 3],
    /// Distance from the fan plane, in beam radii, beyond which no light arrives.
    pub cutoff: f64,
    /// Unit vector of the normal of the fan plane.
    pub ey: [f64; 3],
    /// Distance of the virtual apex behind the lens, in metres.
    pub apex_offset: f64,
    /// Unit vector along the direction of travel.
    pub ez: [f64; 3],
    /// Radius of the virtual apex, in metres: the diffraction-limited width of the fan's source.
    pub source_radius: f64,
    /// Beam radius across the fan; its `z0` is the slant distance from the virtual apex to the
    /// waist, on the axis.
    pub y: Axis,
    /// Half-width of the uniform part of the profile, in its variable; 0 for a Gaussian profile.
    pub flat: f64,
    /// Standard deviation of the Gaussian part of the profile, in its variable; 0 for a top hat.
    pub sigma: f64,
    /// The variable of the profile: 0 for tan θ, 1 for θ, 2 for sin θ, 3 for a table kept
    /// elsewhere, without which the light is dark.
    pub variable: f64,
    /// Fraction of the untruncated profile inside `|θ| < π/2`; 1 in tan θ.
    pub mass: f64,
    /// `T = tan(α/2)`, the slope of the edges of the fan.
    pub half_slope: f64,
    /// 1 if the waist lies on a plane square to the axis, 0 if on a circle about the virtual apex.
    pub focus_on_plane: f64,
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
    /// Unused, 0. Completes a row of four.
    pub pad: f64,
}

impl LineLight {
    /// Places a laser line in a scene, with the lens at the placement's origin and a power in
    /// watts.
    ///
    /// # Errors
    ///
    /// Returns an error if the placement's origin is not finite or beyond 1e30 m, if `power` does
    /// not lie between 0 and 1e100 W, if the placement's axes are not finite, have no length, or
    /// are parallel, or if the profile of the line is tabulated: such a line needs a
    /// [`TabulatedLineLight`](crate::TabulatedLineLight).
    pub fn place(line: &LaserLine, placement: &Placement, power: f64) -> Result<Self, Refusal> {
        match line.profile() {
            LineProfile::Tabulated(_) => Err(Refusal::new(
                "line",
                "a tabulated profile",
                "placed as a TabulatedLineLight where its profile is a table",
            )),
            _ => Self::prepare(line, placement, power),
        }
    }

    /// Places a line with any profile.
    pub(super) fn prepare(
        line: &LaserLine,
        placement: &Placement,
        power: f64,
    ) -> Result<Self, Refusal> {
        let power = checked_power(power)?;
        let frame = placement.frame()?;
        let profile = line.slope_density();
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
            flat: profile.flat,
            sigma: profile.sigma,
            variable: profile.variable,
            mass: profile.mass,
            half_slope: line.half_slope(),
            focus_on_plane: match line.fan().focus_curve {
                FocusCurve::EqualDistance => 0.0,
                FocusCurve::EqualPlane => 1.0,
            },
            wavelength: line.focus().wavelength(),
            pad: 0.0,
        })
    }

    /// Returns the fields in the order of memory, as seven rows of four.
    pub fn to_rows(&self) -> [[f64; 4]; 7] {
        [
            row(self.origin, self.power),
            row(self.ex, self.cutoff),
            row(self.ey, self.apex_offset),
            row(self.ez, self.source_radius),
            self.y.to_row(),
            [self.flat, self.sigma, self.variable, self.mass],
            [
                self.half_slope,
                self.focus_on_plane,
                self.wavelength,
                self.pad,
            ],
        ]
    }

    /// Returns the fields as [`to_rows`](Self::to_rows) does, rounded to `f32` for a kernel.
    pub fn to_rows_f32(&self) -> [[f32; 4]; 7] {
        self.to_rows().map(|row| row.map(to_f32))
    }

    /// Creates a light from its fields in the order of memory, as seven rows of four.
    pub fn from_rows([origin, ex, ey, ez, y, profile, fan]: [[f64; 4]; 7]) -> Self {
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
            variable: profile[2],
            mass: profile[3],
            half_slope: fan[0],
            focus_on_plane: fan[1],
            wavelength: fan[2],
            pad: fan[3],
        }
    }

    /// Returns the beam radius across the fan along the rays whose angle has the secant `sec`.
    #[inline(always)]
    pub(super) fn axis_towards(&self, sec: f64) -> Axis {
        if self.focus_on_plane > 0.0 {
            Axis {
                z0: self.y.z0 * sec,
                ..self.y
            }
        } else {
            self.y
        }
    }

    /// Returns the density of the slope along the fan.
    #[inline(always)]
    pub(super) fn slope_density(&self) -> SlopeDensity {
        SlopeDensity {
            variable: self.variable,
            flat: self.flat,
            sigma: self.sigma,
            mass: self.mass,
        }
    }
}
