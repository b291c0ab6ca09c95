//! Laser lines.

use pyo3::prelude::*;
use tem00_beam as physics;
use tem00_beam::DVec3;

use super::{
    arguments::{coordinates, map, map_inner},
    gaussian::GaussianBeam,
    profile::LineProfile,
};
use crate::{
    arrays::{Array, Numbers, Values},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

/// The geometry of a laser fan.
///
/// Parameters
/// ----------
/// fan_angle : float
///     Full angle, in radians in (0, π), between the edges of the line.
/// apex_offset : float
///     Distance of the virtual apex behind the lens, in metres. A beam that is ``w_in`` wide
///     (half-width at 1/e²) on the lens has its apex at ``w_in / tan(fan_angle / 2)`` behind it.
/// focus_distance : float
///     Distance from the lens along the axis to where the line is thinnest, in metres; negative for
///     a line that diverges from a waist before the lens.
/// focus_curve : {"equal_distance", "equal_plane"}, optional
///     Where the line is thinnest off the axis: on the circle about the virtual apex, or on the
///     plane square to the axis.
///
/// Notes
/// -----
/// The values are checked where a line is made.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FanGeometry(pub(super) physics::FanGeometry);

#[pymethods]
impl FanGeometry {
    #[new]
    #[pyo3(signature = (fan_angle, apex_offset, focus_distance, focus_curve = FocusCurve::default()))]
    fn new(fan_angle: f64, apex_offset: f64, focus_distance: f64, focus_curve: FocusCurve) -> Self {
        Self(physics::FanGeometry {
            fan_angle,
            apex_offset,
            focus_distance,
            focus_curve: focus_curve.0,
        })
    }

    fn __repr__(&self) -> String {
        let (fan_angle, apex_offset, focus_distance, curve) = self.__getnewargs__();
        format!(
            "FanGeometry(fan_angle={fan_angle:?}, apex_offset={apex_offset:?}, \
             focus_distance={focus_distance:?}, focus_curve='{curve}')"
        )
    }

    fn __getnewargs__(&self) -> (f64, f64, f64, &'static str) {
        let fan = &self.0;
        let curve = self.focus_curve();
        (fan.fan_angle, fan.apex_offset, fan.focus_distance, curve)
    }
}

methods! {
    impl FanGeometry as this: this.0;

    /// Surface on which the line is thinnest off the axis, ``"equal_distance"`` or ``"equal_plane"``.
    get focus_curve -> &'static str = match this.0.focus_curve {
        physics::FocusCurve::EqualDistance => EQUAL_DISTANCE,
        physics::FocusCurve::EqualPlane => EQUAL_PLANE,
    };

    /// Full angle between the edges of the line, in radians.
    field fan_angle -> f64;

    /// Distance of the virtual apex behind the lens, in metres.
    field apex_offset -> f64;

    /// Distance from the lens along the axis to where the line is thinnest, in metres.
    field focus_distance -> f64;
}

const EQUAL_DISTANCE: &str = "equal_distance";
const EQUAL_PLANE: &str = "equal_plane";

/// A curve by its name.
#[derive(Clone, Copy, Debug, Default)]
struct FocusCurve(physics::FocusCurve);

impl<'py> FromPyObject<'_, 'py> for FocusCurve {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.extract::<String>()?.as_str() {
            EQUAL_DISTANCE => Ok(Self(physics::FocusCurve::EqualDistance)),
            EQUAL_PLANE => Ok(Self(physics::FocusCurve::EqualPlane)),
            other => {
                let message = format!(
                    "focus_curve must be '{EQUAL_DISTANCE}' or '{EQUAL_PLANE}', got '{other}'"
                );
                Err(refused("focus_curve", message))
            }
        }
    }
}

/// A laser line: a Gaussian beam, fanned out in one plane by a cylinder or Powell lens.
///
/// The light travels along +z, z = 0 is the lens, the fan opens along x and its plane has the normal
/// y. The fan diverges from a virtual apex behind the lens. Points at z < 0 receive nothing.
///
/// Parameters
/// ----------
/// focus : GaussianBeam
///     The beam across the fan.
/// fan : FanGeometry
/// profile : LineProfile
///     How the power is spread along the fan.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LaserLine(pub(super) physics::LaserLine);

#[pymethods]
impl LaserLine {
    #[new]
    fn new(focus: &GaussianBeam, fan: &FanGeometry, profile: &LineProfile) -> PyResult<Self> {
        let line = physics::LaserLine::new(focus.0, fan.0, profile.0.clone());
        Ok(Self(line.or_raise()?))
    }

    /// Return the half-thickness of the line (1/e²), in metres, at a fan angle.
    ///
    /// Parameters
    /// ----------
    /// z, theta : float or array_like
    ///     Distance from the lens, in metres, and angle from the axis, in radians in (-π/2, π/2);
    ///     they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Half-thickness in metres, along the normal of the fan plane, in the common shape.
    fn half_thickness_at_angle<'py>(
        &self,
        py: Python<'py>,
        z: Numbers<'py>,
        theta: Numbers<'py>,
    ) -> PyResult<Values<'py>> {
        check_theta(&theta)?;
        map(py, [("z", &z), ("theta", &theta)], |[z, theta]| {
            self.0.half_thickness_at_angle(z, theta)
        })
    }

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
    fn flux_per_watt<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Array<'py>> {
        let points = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        map_inner(py, points, &[3], |p| {
            self.0.flux_per_watt(DVec3::from(p)).to_array()
        })
    }

    fn __repr__(&self) -> String {
        let [focus, fan] = [self.focus().__repr__(), self.fan().__repr__()];
        let profile = self.profile().__repr__();
        format!("LaserLine(focus={focus}, fan={fan}, profile={profile})")
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Recipe<'py>> {
        by_constructor::<Self>(py, "__call__", (self.focus(), self.fan(), self.profile()))
    }
}

methods! {
    impl LaserLine as this: this.0;

    /// The beam across the fan.
    get focus -> GaussianBeam = GaussianBeam(*this.0.focus());

    /// The geometry of the fan.
    get fan -> FanGeometry = FanGeometry(*this.0.fan());

    /// The profile along the line.
    get profile -> LineProfile = LineProfile(this.0.profile().clone());

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
    ///     Angles from the axis, in radians; they broadcast together. There is no power beyond ±π/2.
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
}

/// Checks that angles of a fan lie in front of the lens.
fn check_theta(theta: &Numbers<'_>) -> PyResult<()> {
    let behind = |angle: &&f64| angle.abs() >= std::f64::consts::FRAC_PI_2;
    match theta.values()?.iter().find(behind) {
        Some(angle) => {
            let message = format!("theta must lie in (-π/2, π/2) rad, got {angle:e} rad");
            Err(refused("theta", message))
        }
        None => Ok(()),
    }
}
