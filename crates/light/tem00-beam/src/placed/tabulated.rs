use super::emitter::Emitter;
use super::fan::Fan;
use super::frame::Placement;
use super::line::LineLight;
use crate::profile::AngularTable;
use crate::{AngularKnot, LaserLine, LineProfile, Refusal};

/// A laser line in a scene whose power along the fan is tabulated.
///
/// A [`LineLight`] (its `variable` is 3, its `flat` and `sigma` are 0) and the table, borrowed from
/// an [`AngularProfile`](crate::AngularProfile) or from other storage of the renderer. The power
/// per angle `f(θ)` is linear between neighbouring knots and 0 outside them; per slope it is
/// `g(u) = f / (1 + u²)`. Everything else is as for the `LineLight`, except that the cut-off acts
/// across the fan only.
///
/// Fewer than two knots give no light.
///
/// # Examples
///
/// ```
/// use tem00_beam::{
///     AngularProfile, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine,
///     LineProfile, Placement, TabulatedLineLight,
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
/// let line = LaserLine::new(focus, fan, LineProfile::Tabulated(profile))?;
/// let placement = Placement {
///     origin: DVec3::new(0.0, 0.0, 0.2),
///     direction: DVec3::NEG_Z,
///     fan_axis: DVec3::X,
/// };
/// let light = TabulatedLineLight::place(&line, &placement, 5e-3)?;
/// assert!(light.next_event([0.1, 0.0, 0.0]).is_some());
/// assert!(light.next_event([0.12, 0.0, 0.0]).is_none());
/// # Ok::<(), tem00_beam::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabulatedLineLight<'a> {
    /// The line without its profile.
    pub line: LineLight,
    /// The profile, by ascending angle.
    pub knots: &'a [AngularKnot],
}

impl<'a> TabulatedLineLight<'a> {
    /// Places a laser line in a scene, with the lens at the placement's origin and a power in
    /// watts.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`LineLight::place`], except that the profile of the line must be
    /// tabulated.
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
}

impl Emitter for TabulatedLineLight<'_> {
    fn power(&self) -> f64 {
        self.line.power
    }

    fn wavelength(&self) -> f64 {
        self.line.wavelength
    }
}

impl<'a> Fan for TabulatedLineLight<'a> {
    type Profile = AngularTable<'a>;

    fn line(&self) -> &LineLight {
        &self.line
    }

    fn profile(&self) -> AngularTable<'a> {
        AngularTable(self.knots)
    }
}
