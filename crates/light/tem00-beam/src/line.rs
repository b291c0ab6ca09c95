use core::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use tem00_numerics::check;

use crate::normal::normal_density;
use crate::profile::{SlopeDensity, SlopeProfile};
use crate::{GaussianBeam, LineProfile, Refusal};

/// Smallest apex offset in source radii, so that the fan has a sharp apex.
const MIN_SOURCE_RADII: f64 = 100.0;

/// Curve of best focus: the position of the waist of a laser line as a function of the fan angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FocusCurve {
    /// The waist lies on a circle about the virtual apex, at the same slant distance from it at
    /// every angle.
    ///
    /// ```text
    /// r_w = focus_distance + z_a
    /// ```
    #[default]
    EqualDistance,
    /// The waist lies on a plane perpendicular to the axis: the line is equally thin along a flat
    /// screen there.
    ///
    /// ```text
    /// r_w = (focus_distance + z_a) / cos θ
    /// ```
    EqualPlane,
}

/// The geometry of a laser fan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FanGeometry {
    /// Full fan angle `α`, in radians, between the edges of the line: the 1/e² points of a Gaussian
    /// profile, the half-value points of a Powell profile.
    pub fan_angle: f64,
    /// Distance `z_a` of the virtual apex behind the lens, in metres.
    ///
    /// A beam that is `w_in` wide (half-width at 1/e²) on the lens has its apex at `w_in / T`
    /// behind it, `T = tan(α/2)`.
    pub apex_offset: f64,
    /// Distance from the lens along the axis to the point where the line is thinnest, in metres;
    /// negative for a line that diverges from a waist before the lens.
    pub focus_distance: f64,
    /// Curve on which the line is thinnest off the axis.
    pub focus_curve: FocusCurve,
}

/// A laser line: a Gaussian beam fanned out in one plane by a cylinder or Powell lens.
///
/// The light travels along +z, z = 0 is the lens, the fan opens along x and its plane has the
/// normal y. All rays seem to come from a virtual apex at `z = −z_a`, so nothing is singular at the
/// lens. With the slant distance `r = √(x² + (z + z_a)²)` from the apex, the fan angle
/// `θ = atan(x / (z + z_a))` and the power density `f(θ)` per fan angle, the energy flow is
///
/// ```text
/// F / P = f(θ) / r · G(y; w) · (sin θ, y w'/w, cos θ)
/// G(y; w) = √(2/π) / w · exp(−2 y² / w²)
/// w = w(r − r_w)     with r_w = focus_distance + z_a, or that over cos θ (see FocusCurve)
/// ```
///
/// The flow is divergence-free, so that any surface that cuts the whole fan receives the full
/// power. In the cylindrical coordinates (r, θ, y) the flow has no component along θ, and `f` and
/// `r_w`, which depend on θ alone, are constant along a streamline:
///
/// ```text
/// ∇·F / P = ∂(r F_r)/∂r / r + ∂F_y/∂y = f/r · [∂G/∂r + ∂(G y w'/w)/∂y] = 0
/// ```
///
/// because `G` only scales with `w`. Points at z < 0 receive nothing.
///
/// # Validity
///
/// The beam across the fan is paraxial; the fan itself may be wide. Diffraction in the fan plane is
/// neglected: it widens the apex to the radius [`source_radius`](Self::source_radius), about one
/// micrometre, which changes the energy flow by the square of its ratio to `r`. The constructor
/// keeps this change below 1e−4 everywhere; at working distances it is about 1e−11.
///
/// # Examples
///
/// A 650 nm module with a 30° fan and a line 0.2 mm thick at 200 mm:
///
/// ```
/// use tem00_beam::{FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};
///
/// let line = LaserLine::new(
///     GaussianBeam::from_waist(650e-9, 0.1e-3)?,
///     FanGeometry {
///         fan_angle: 30_f64.to_radians(),
///         apex_offset: 2e-3,
///         focus_distance: 0.2,
///         focus_curve: FocusCurve::EqualDistance,
///     },
///     LineProfile::GaussianTan,
/// )?;
///
/// assert!((line.half_length_at(0.2) - 54.1e-3).abs() < 0.1e-3);
/// assert!((line.half_thickness_at(0.2) - 0.1e-3).abs() < 1e-9);
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
///
/// # References
///
/// - S. Bergmann et al., 2016, section 4. Their scaling of x gives the power `T z / w` instead of
///   1; it is normalised here.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLine {
    focus: GaussianBeam,
    fan: FanGeometry,
    profile: LineProfile,
    half_slope: f64,
    density: SlopeDensity,
}

impl LaserLine {
    /// Creates a line from the beam across the fan, the fan's geometry and the profile along it.
    ///
    /// # Errors
    ///
    /// Returns an error if the fan angle is not in (0, π), if a Powell profile's edge is not in
    /// [1e−6, 1], if the focus distance is not finite or beyond 1e30 m, or if the apex offset is
    /// beyond 1e30 m or below 100 times the [`source_radius`](Self::source_radius): diffraction
    /// would fan out so narrow a beam on the lens by a larger angle.
    pub fn new(
        focus: GaussianBeam,
        fan: FanGeometry,
        profile: LineProfile,
    ) -> Result<Self, Refusal> {
        check::that(
            fan.fan_angle > 0.0 && fan.fan_angle < PI,
            "fan_angle",
            fan.fan_angle,
            "rad",
            "in (0, π) rad",
        )?;
        check::coordinate("focus_distance", fan.focus_distance)?;
        let density = profile.slope_density(fan.fan_angle)?;
        let line = Self {
            focus,
            fan,
            profile,
            half_slope: (0.5 * fan.fan_angle).tan(),
            density,
        };
        let minimum = MIN_SOURCE_RADII * line.source_radius();
        check::range("apex_offset", fan.apex_offset, [minimum, 1e30], "m")?;
        Ok(line)
    }

    /// Returns the beam across the fan.
    pub const fn focus(&self) -> &GaussianBeam {
        &self.focus
    }

    /// Returns the geometry of the fan.
    pub const fn fan(&self) -> &FanGeometry {
        &self.fan
    }

    /// Returns the profile along the line.
    pub const fn profile(&self) -> &LineProfile {
        &self.profile
    }

    /// Returns `T = tan(α/2)`, the slope of the edges of the fan.
    pub const fn half_slope(&self) -> f64 {
        self.half_slope
    }

    /// Returns the slant distance `r_w` from the virtual apex to the waist on the axis, in metres.
    pub const fn waist_slant_distance(&self) -> f64 {
        self.fan.focus_distance + self.fan.apex_offset
    }

    /// Returns the slant distance `r_w` from the virtual apex to the waist, in metres, in the
    /// direction of the slope `tan θ` in the fan plane.
    pub fn waist_slant_distance_at(&self, slope: f64) -> f64 {
        match self.fan.focus_curve {
            FocusCurve::EqualDistance => self.waist_slant_distance(),
            FocusCurve::EqualPlane => self.waist_slant_distance() * 1.0_f64.hypot(slope),
        }
    }

    /// Returns the diffraction-limited radius of the virtual apex, in metres.
    ///
    /// ```text
    /// w_b = M² λ / (π T)
    /// ```
    ///
    /// It is the waist radius of a beam that diverges as the fan does. It makes the radiance of the
    /// line finite.
    pub fn source_radius(&self) -> f64 {
        self.focus.waist_radius() * self.focus.divergence() / self.half_slope
    }

    /// Returns the half-length of the line, in metres, on the plane at the distance `z` from the
    /// lens: `T (z + z_a)`.
    pub fn half_length_at(&self, z: f64) -> f64 {
        self.half_slope * (z + self.fan.apex_offset)
    }

    /// Returns the half-thickness of the line on the axis (1/e² radius across the fan), in metres,
    /// at the distance `z` from the lens.
    pub fn half_thickness_at(&self, z: f64) -> f64 {
        self.focus.radius_at(z - self.fan.focus_distance)
    }

    /// Returns the half-thickness of the line (1/e² radius across the fan), in metres, on the plane
    /// at the distance `z` from the lens, where the fan angle is `theta`, in radians within (−π/2,
    /// π/2).
    ///
    /// It is measured along the normal of the fan plane. On the axis, `theta = 0`, it is
    /// [`half_thickness_at`](Self::half_thickness_at).
    pub fn half_thickness_at_angle(&self, z: f64, theta: f64) -> f64 {
        let slope = theta.tan();
        let slant = (z + self.fan.apex_offset) * 1.0_f64.hypot(slope);
        self.focus
            .radius_at(slant - self.waist_slant_distance_at(slope))
    }

    /// Returns the fraction of the power between two fan angles, in radians, in either order.
    ///
    /// ```text
    /// |∫ f(θ) dθ| from a to b
    /// ```
    ///
    /// There is no power beyond ±π/2.
    ///
    /// # Examples
    ///
    /// A Gaussian fan has all but 4.6 % of its power between its edges:
    ///
    /// ```
    /// # use tem00_beam::{FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};
    /// # let fan = FanGeometry {
    /// #     fan_angle: 0.5,
    /// #     apex_offset: 2e-3,
    /// #     focus_distance: 0.2,
    /// #     focus_curve: FocusCurve::EqualDistance,
    /// # };
    /// # let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
    /// let line = LaserLine::new(focus, fan, LineProfile::GaussianTan)?;
    /// assert!((line.power_between_angles(-0.25, 0.25) - 0.9545).abs() < 1e-4);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn power_between_angles(&self, a: f64, b: f64) -> f64 {
        let [a, b] = [a, b].map(|angle| angle.clamp(-FRAC_PI_2, FRAC_PI_2).tan());
        self.power_between_slopes(a, b)
    }

    /// Returns the fraction of the power that falls between `x_min` and `x_max`, in metres, in
    /// either order, on the plane at the distance `z` from the lens. A window transmits this
    /// fraction, or a sensor receives it, if it is high enough for the thickness of the line. It is
    /// 0 for z < 0.
    ///
    /// # Examples
    ///
    /// A window of 40 mm in front of a line of 102 mm:
    ///
    /// ```
    /// # use tem00_beam::{FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};
    /// # let fan = FanGeometry {
    /// #     fan_angle: 0.5,
    /// #     apex_offset: 2e-3,
    /// #     focus_distance: 0.2,
    /// #     focus_curve: FocusCurve::EqualDistance,
    /// # };
    /// # let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
    /// let line = LaserLine::new(focus, fan, LineProfile::UniformTan)?;
    /// let fraction = line.power_on_length(-20e-3, 20e-3, 0.198);
    /// assert!((fraction - 20e-3 / line.half_length_at(0.198)).abs() < 1e-15);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn power_on_length(&self, x_min: f64, x_max: f64, z: f64) -> f64 {
        if z < 0.0 {
            return 0.0;
        }
        let depth = z + self.fan.apex_offset;
        self.power_between_slopes(x_min / depth, x_max / depth)
    }

    fn power_between_slopes(&self, a: f64, b: f64) -> f64 {
        self.along(|profile| profile.between(a.min(b), a.max(b)))
    }

    /// Returns the fraction of the power per fan angle `f(θ)`, in rad⁻¹, at the signed angle
    /// `theta` from the axis, in radians; 0 at right angles to the axis and behind it.
    ///
    /// ```text
    /// f(θ) = g(tan θ) / cos² θ
    /// ```
    pub fn power_per_angle(&self, theta: f64) -> f64 {
        if theta.abs() >= FRAC_PI_2 {
            return 0.0;
        }
        self.along(|profile| profile.per_angle(theta.tan()))
    }

    /// Returns the irradiance per watt, in m⁻², of a plane of constant z at `point`.
    ///
    /// It is the z-component of [`flux_per_watt`](Self::flux_per_watt).
    pub fn irradiance_per_watt(&self, point: DVec3) -> f64 {
        self.flux_per_watt(point).z
    }

    /// Returns the energy-flow vector per watt of laser power, in m⁻², at `point`.
    ///
    /// A surface whose normal `n` lies on the lit side receives the irradiance `max(0, −F·n)`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::{DVec3, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};
    ///
    /// let fan = FanGeometry {
    ///     fan_angle: 0.5,
    ///     apex_offset: 2e-3,
    ///     focus_distance: 0.2,
    ///     focus_curve: FocusCurve::EqualDistance,
    /// };
    /// let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
    /// let line = LaserLine::new(focus, fan, LineProfile::Powell { edge: 0.05 })?;
    ///
    /// // In the fan plane the energy flows straight away from the virtual apex.
    /// let flux = line.flux_per_watt(DVec3::new(0.03, 0.0, 0.198));
    /// assert!((flux.x / flux.z - 0.03 / 0.2).abs() < 1e-12);
    /// # Ok::<(), tem00_beam::Refusal>(())
    /// ```
    pub fn flux_per_watt(&self, point: DVec3) -> DVec3 {
        if point.z < 0.0 {
            return DVec3::ZERO;
        }
        let z = point.z + self.fan.apex_offset;
        let slope = point.x / z;
        let from_waist = point.x.hypot(z) - self.waist_slant_distance_at(slope);
        let w = self.focus.radius_at(from_waist);
        // f(θ) / r · cos θ = g(tan θ) / z
        let across = normal_density(point.y, 0.5 * w);
        let irradiance = self.along(|profile| profile.per_slope(slope)) / z * across;
        if irradiance > 0.0 {
            let slope_y = point.y * self.focus.curvature_at(from_waist) * 1.0_f64.hypot(slope);
            irradiance * DVec3::new(slope, slope_y, 1.0)
        } else {
            DVec3::ZERO
        }
    }

    /// Evaluates a query on the profile along the fan.
    fn along(&self, query: impl Fn(&dyn SlopeProfile) -> f64) -> f64 {
        match &self.profile {
            LineProfile::Tabulated(profile) => query(&profile.table()),
            _ => query(&self.density),
        }
    }

    /// Returns the density of the slope along the fan; dark if the profile is tabulated.
    pub(crate) const fn slope_density(&self) -> &SlopeDensity {
        &self.density
    }
}

#[cfg(test)]
mod tests;
