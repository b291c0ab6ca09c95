//! Placements of lights, and the plain parts of placed lights.

use pyo3::prelude::*;
use tem00_beam as physics;
use tem00_beam::DVec3;

use super::arguments::map;
use crate::arrays::Vector;

/// Position and directions of a light, in world coordinates.
///
/// Parameters
/// ----------
/// origin : array_like, shape (3,)
///     Centre of the aperture (the lens of a laser line), in metres.
/// direction : array_like, shape (3,)
///     Direction of travel, of any length.
/// fan_axis : array_like, shape (3,)
///     Any vector that is not parallel to ``direction``. Its part at right angles to ``direction``
///     is the x axis of the light, along which a fan opens.
///
/// Notes
/// -----
/// The values are checked where a light is placed.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement(pub(super) physics::Placement);

#[pymethods]
impl Placement {
    #[new]
    fn new(origin: [f64; 3], direction: [f64; 3], fan_axis: [f64; 3]) -> Self {
        Self(physics::Placement {
            origin: DVec3::from(origin),
            direction: DVec3::from(direction),
            fan_axis: DVec3::from(fan_axis),
        })
    }

    fn __repr__(&self) -> String {
        let [origin, direction, fan_axis] = self.vectors();
        format!("Placement(origin={origin:?}, direction={direction:?}, fan_axis={fan_axis:?})")
    }

    fn __getnewargs__(&self) -> ([f64; 3], [f64; 3], [f64; 3]) {
        self.vectors().into()
    }
}

methods! {
    impl Placement as this: this.0;

    /// Centre of the aperture, in metres, shape (3,).
    field origin -> Vector<3>;

    /// Direction of travel, of any length, shape (3,).
    field direction -> Vector<3>;

    /// A vector in the plane of the fan, shape (3,).
    field fan_axis -> Vector<3>;
}

impl Placement {
    fn vectors(&self) -> [[f64; 3]; 3] {
        [self.0.origin, self.0.direction, self.0.fan_axis].map(Into::into)
    }
}

/// The squared beam radius along one principal axis of a placed light.
///
/// ``w²(z) = w0_sq + theta_sq (z − z0)²``. Keep the sum in this form: multiplied out into powers of z
/// it loses all digits of ``float32`` near a tight waist.
#[pyclass(frozen, eq, module = "tem00.beam")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis(pub(super) physics::Axis);

#[pymethods]
impl Axis {
    fn __repr__(&self) -> String {
        let physics::Axis {
            w0_sq,
            theta_sq,
            z0,
            ..
        } = self.0;
        format!("<Axis: w0_sq={w0_sq:?}, theta_sq={theta_sq:?}, z0={z0:?}>")
    }
}

methods! {
    impl Axis as this: this.0;

    unmade "SpotLight.x and SpotLight.y";

    /// Squared waist radius, in m².
    field w0_sq -> f64;

    /// Squared divergence half-angle, in rad².
    field theta_sq -> f64;

    /// Position of the waist, in metres, on the coordinate that the light says.
    field z0 -> f64;

    /// Return the squared beam radius in m².
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Coordinate along the beam, in metres.
    map radius_sq_at(z);
}
