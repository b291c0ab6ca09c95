use glam::DVec3;

use crate::BeamError;
use crate::gaussian::is_coordinate;
use crate::real::Real;

/// The sine of the smallest accepted angle between the fan axis and the direction.
const MIN_FAN_AXIS_SINE: f64 = 1e-6;

/// Where a light stands and where it points, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Centre of the aperture (the lens of a laser line), in metres.
    pub origin: DVec3,
    /// Direction of travel, of any length.
    pub direction: DVec3,
    /// Any vector that is not parallel to `direction`. Its part at right angles to `direction` is
    /// the x axis of the light, along which a fan opens.
    pub fan_axis: DVec3,
}

impl Placement {
    /// Returns the frame of the light.
    pub(super) fn frame(&self) -> Result<Frame<f64>, BeamError> {
        if !self.origin.to_array().into_iter().all(is_coordinate) {
            return Err(BeamError::Origin(self.origin));
        }
        let ez = self
            .direction
            .try_normalize()
            .ok_or(BeamError::Direction(self.direction))?;
        let fan_axis = self
            .fan_axis
            .try_normalize()
            .ok_or(BeamError::FanAxis(self.fan_axis))?;
        let across = fan_axis.reject_from_normalized(ez);
        if across.length() < MIN_FAN_AXIS_SINE {
            return Err(BeamError::FanAxis(self.fan_axis));
        }
        let ey = ez.cross(across).normalize();
        Ok(Frame {
            origin: self.origin.to_array(),
            ex: ey.cross(ez).normalize().to_array(),
            ey: ey.to_array(),
            ez: ez.to_array(),
        })
    }
}

/// An origin and three orthonormal axes: the frame of a placed light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(unnameable_types, reason = "it belongs to a sealed trait")]
pub struct Frame<T> {
    pub(super) origin: [T; 3],
    pub(super) ex: [T; 3],
    pub(super) ey: [T; 3],
    pub(super) ez: [T; 3],
}

impl<T: Real> Frame<T> {
    /// Transforms a point of the world into the frame.
    pub(crate) fn local_from_world_point(&self, p: [T; 3]) -> [T; 3] {
        // Subtract first, then rotate: the difference is exact where the light is near.
        self.local_from_world_vector([
            p[0] - self.origin[0],
            p[1] - self.origin[1],
            p[2] - self.origin[2],
        ])
    }

    /// Rotates a vector of the world into the frame.
    pub(crate) fn local_from_world_vector(&self, v: [T; 3]) -> [T; 3] {
        [dot(v, self.ex), dot(v, self.ey), dot(v, self.ez)]
    }

    /// Rotates a vector of the frame into the world.
    pub(crate) fn world_from_local_vector(&self, v: [T; 3]) -> [T; 3] {
        core::array::from_fn(|i| v[0] * self.ex[i] + v[1] * self.ey[i] + v[2] * self.ez[i])
    }

    /// Transforms a point of the aperture plane into the world.
    pub(crate) fn world_from_aperture(&self, [x, y]: [T; 2]) -> [T; 3] {
        let offset = self.world_from_local_vector([x, y, T::ZERO]);
        core::array::from_fn(|i| self.origin[i] + offset[i])
    }
}

fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
