//! Laser lines.

use pyo3::prelude::*;
use tem00_beam::{self as physics, DVec3, FocusCurve};

use super::{gaussian::GaussianBeam, map::LIMIT, profile::LineProfile};
use crate::arrays::Numbers;

class! {
    /// The geometry of a laser fan.
    ///
    /// Parameters
    /// ----------
    /// fan_angle : float
    ///     Full angle, in radians in (0, π), between the edges of the line.
    /// apex_offset : float
    ///     Distance of the virtual apex behind the lens, in metres. A beam that is ``w_in`` wide
    ///     (half-width at 1/e²) on the lens has its apex at ``w_in / tan(fan_angle / 2)`` behind
    ///     it.
    /// focus_distance : float
    ///     Distance from the lens along the axis to where the line is thinnest, in metres; negative
    ///     for a line that diverges from a waist before the lens.
    /// focus_curve : {"equal_distance", "equal_plane"}, optional
    ///     Where the line is thinnest off the axis: on the circle about the virtual apex, or on the
    ///     plane square to the axis.
    ///
    /// Notes
    /// -----
    /// The values are checked where a line is made.
    "tem00.beam" FanGeometry(physics::FanGeometry): Copy
}

crate::arguments::choices! {
    FocusCurve: "equal_distance" = Self::EqualDistance, "equal_plane" = Self::EqualPlane;
}

methods! {
    impl FanGeometry as this: this.0;

    #[new]
    #[pyo3(signature = (fan_angle, apex_offset, focus_distance, focus_curve = None))]
    build new(_py;
        fan_angle: f64, apex_offset: f64, focus_distance: f64,
        focus_curve: Option<Bound<'py, PyAny>>
    ) = {
        let focus_curve = crate::arguments::optional(focus_curve, "focus_curve")?;
        Ok(Self(physics::FanGeometry {
            fan_angle,
            apex_offset,
            focus_distance,
            focus_curve: focus_curve.unwrap_or_default(),
        }))
    };

    /// Surface on which the line is thinnest off the axis, ``"equal_distance"`` or
    /// ``"equal_plane"``.
    get focus_curve -> &'static str = match this.0.focus_curve {
        FocusCurve::EqualDistance => "equal_distance",
        FocusCurve::EqualPlane => "equal_plane",
    };

    /// Full angle between the edges of the line, in radians.
    field fan_angle -> f64;

    /// Distance of the virtual apex behind the lens, in metres.
    field apex_offset -> f64;

    /// Distance from the lens along the axis to where the line is thinnest, in metres.
    field focus_distance -> f64;

    made_by new(fan_angle, apex_offset, focus_distance, focus_curve);
}

class! {
    /// A laser line: a Gaussian beam, fanned out in one plane by a cylinder or Powell lens.
    ///
    /// The light travels along +z, z = 0 is the lens, the fan opens along x and its plane has the
    /// normal y. The fan diverges from a virtual apex behind the lens. Points at z < 0 receive
    /// nothing.
    ///
    /// Parameters
    /// ----------
    /// focus : GaussianBeam
    ///     The beam across the fan.
    /// fan : FanGeometry
    /// profile : LineProfile
    ///     How the power is spread along the fan.
    "tem00.beam" LaserLine(physics::LaserLine)
}

methods! {
    impl LaserLine as this: this.0;

    make new(
        focus: physics::GaussianBeam, fan: physics::FanGeometry, profile: physics::LineProfile
    );

    /// Return the half-thickness of the line (1/e²), in metres, along the normal of the fan plane.
    ///
    /// Parameters
    /// ----------
    /// z, theta : float or array_like
    ///     Distance from the lens, in metres, and angle from the axis, in radians in (-π/2, π/2);
    ///     they broadcast together.
    map half_thickness_at_angle(z, theta: in_front);

    /// Return the energy-flow vector per watt of laser power, in 1/m².
    ///
    /// A surface whose normal ``n`` lies on the lit side receives the irradiance ``max(0, -F·n)``.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates in the frame of the line, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 3)
    ///     Energy flow per watt, with its components in the last axis.
    over flux_per_watt(x, y, z) -> [3] =
        |[x, y, z]| this.0.flux_per_watt(DVec3::new(x, y, z)).to_array();

    /// The beam across the fan.
    get focus -> GaussianBeam = this.0.focus().to_owned();

    /// The geometry of the fan.
    get fan -> FanGeometry = this.0.fan().to_owned();

    /// The profile along the line.
    get profile -> LineProfile = this.0.profile().clone();

    /// Slope of the edges of the fan, the tangent of half the fan angle.
    get half_slope -> f64;

    /// Slant distance from the virtual apex to the waist on the axis, in metres.
    get waist_slant_distance -> f64;

    /// Diffraction-limited radius of the virtual apex, in metres.
    get source_radius -> f64;

    /// Return the slant distance from the virtual apex to the waist, in metres.
    ///
    /// Parameters
    /// ----------
    /// slope : float or array_like
    ///     Tangent of the fan angle.
    map waist_slant_distance_at(slope);

    /// Return the half-length of the line, in metres, on a plane square to the axis.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the lens, in metres.
    map half_length_at(z);

    /// Return the half-thickness of the line on the axis (1/e²), in metres.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the lens, in metres.
    map half_thickness_at(z);

    /// Return the fraction of the power between two fan angles, in either order.
    ///
    /// Parameters
    /// ----------
    /// a, b : float or array_like
    ///     Angles from the axis, in radians; they broadcast together. There is no power beyond
    ///     ±π/2.
    map power_between_angles(a, b);

    /// Return the fraction of the power between two places along the line, in either order.
    ///
    /// Parameters
    /// ----------
    /// x_min, x_max, z : float or array_like
    ///     The places, in metres, on the plane at the distance ``z`` from the lens, in metres; they
    ///     broadcast together.
    map power_on_length(x_min, x_max, z);

    /// Return the fraction of the power per fan angle, in 1/rad.
    ///
    /// Parameters
    /// ----------
    /// theta : float or array_like
    ///     Signed angle from the axis, in radians.
    map power_per_angle(theta);

    /// Return the irradiance per watt, in 1/m², on planes square to the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates in the frame of the line, in metres; they broadcast together.
    map irradiance_per_watt(x, y, z) = this.0.irradiance_per_watt(DVec3::new(x, y, z));

    made_by new(focus, fan, profile);
}

impl Numbers<'_> {
    /// Checks that angles of a fan lie in front of the lens.
    fn in_front(&self, name: &'static str) -> PyResult<()> {
        let limit = core::f64::consts::FRAC_PI_2;
        self.check(name, "in (-π/2, π/2) rad", |angle| angle.abs() < limit)
    }
}
