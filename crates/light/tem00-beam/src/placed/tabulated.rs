use super::emitter::Emitter;
use super::fan::Fan;
use super::frame::Placement;
use super::line::LineLight;
use super::rows::check_digits;
use crate::normal::normal_density;
use crate::profile::AngularTable;
use crate::real::Real;
use crate::{AngularKnot, LaserLine, LineProfile, Refusal};

/// A laser line in a scene whose power along the fan is a table.
///
/// A [`LineLight`] (its `variable` is 3, its `flat` and `sigma` are 0) and the table, borrowed from an
/// [`AngularProfile`](crate::AngularProfile) or from wherever the renderer keeps the knots. The power
/// per angle `f(θ)` is linear between neighbouring knots and 0 outside them; per slope it is
/// `g(u) = f / (1 + u²)`. All else is as for the `LineLight`, but that the cut-off acts across the fan
/// only.
///
/// Fewer than two knots give no light.
///
/// # Examples
///
/// ```
/// use tem00_beam::{
///     AngularProfile, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile,
///     Placement, TabulatedLineLight,
/// };
///
/// let fan = FanGeometry {
///     fan_angle: 60_f64.to_radians(),
///     apex_offset: 2e-3,
///     focus_distance: 0.2,
///     focus_curve: FocusCurve::EqualPlane,
/// };
/// let angles = [-30_f64, -20.0, 20.0, 30.0].map(f64::to_radians);
/// let profile = AngularProfile::new(&angles, &[0.0, 1.0, 0.9, 0.0])?;
/// let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
/// let line = LaserLine::new(focus, fan, LineProfile::Tabulated(profile.clone()))?;
/// let placement = Placement {
///     origin: DVec3::new(0.0, 0.0, 0.2),
///     direction: DVec3::NEG_Z,
///     fan_axis: DVec3::X,
/// };
/// let light = TabulatedLineLight::place(&line, &placement, 5e-3)?;
/// assert!(light.next_event([0.1, 0.0, 0.0]).is_some());
/// assert!(light.next_event([0.12, 0.0, 0.0]).is_none());
///
/// let knots = profile.to_f32()?;
/// let single = light.to_f32(&knots)?;
/// assert!(single.next_event([0.1, 0.0, 0.0]).is_some());
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabulatedLineLight<'a, T> {
    /// The line but for its profile.
    pub line: LineLight<T>,
    /// The profile, by ascending angle.
    pub knots: &'a [AngularKnot<T>],
}

impl<'a> TabulatedLineLight<'a, f64> {
    /// Places a laser line in a scene, with the lens at the placement's origin and a power in watts.
    ///
    /// # Errors
    ///
    /// As [`LineLight::place`], but an error if the profile of the line is not tabulated.
    pub fn place(line: &'a LaserLine, placement: &Placement, power: f64) -> Result<Self, Refusal> {
        match line.profile() {
            LineProfile::Tabulated(profile) => Ok(Self {
                line: LineLight::prepare(line, placement, power)?,
                knots: profile.knots(),
            }),
            _ => Err(Refusal::new(
                "line",
                "another profile",
                "placed as a LineLight where its profile is not a table",
            )),
        }
    }

    /// Returns the light in single precision, with the knots in single precision.
    ///
    /// # Errors
    ///
    /// As [`LineLight::to_f32`].
    pub fn to_f32<'b>(
        &self,
        knots: &'b [AngularKnot<f32>],
    ) -> Result<TabulatedLineLight<'b, f32>, Refusal> {
        let across = normal_density(0.0, 0.5 * self.line.y.w0_sq.sqrt());
        let peak = AngularTable(self.knots).peak();
        check_digits([self.line.power * peak / self.line.apex_offset * across])?;
        let line = self.line.to_f32()?;
        Ok(TabulatedLineLight { line, knots })
    }
}

impl<T: Real> Emitter<T> for TabulatedLineLight<'_, T> {
    fn power(&self) -> T {
        self.line.power
    }

    fn wavelength(&self) -> T {
        self.line.wavelength
    }
}

impl<'a, T: Real> Fan for TabulatedLineLight<'a, T> {
    type Scalar = T;
    type Profile = AngularTable<'a, T>;

    fn line(&self) -> &LineLight<T> {
        &self.line
    }

    fn profile(&self) -> AngularTable<'a, T> {
        AngularTable(self.knots)
    }
}
