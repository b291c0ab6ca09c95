use glam::DVec3;
use tem00_numerics::check;

use crate::Refusal;

/// The sine of the smallest accepted angle between the fan axis and the direction.
const MIN_FAN_AXIS_SINE: f64 = 1e-6;

/// Position and orientation of a light, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Centre of the aperture (the lens of a laser line), in metres.
    pub origin: DVec3,
    /// Direction of travel, of any length.
    pub direction: DVec3,
    /// Any vector that is not parallel to `direction`. Its component perpendicular to `direction`
    /// is the x axis of the light, along which a fan opens.
    pub fan_axis: DVec3,
}

impl Placement {
    /// Returns the frame of the light.
    pub(super) fn frame(&self) -> Result<Frame, Refusal> {
        for x in self.origin.to_array() {
            check::coordinate("origin", x)?;
        }
        let refused =
            |parameter, vector: DVec3, allowed| Refusal::new(parameter, vector.to_array(), allowed);
        let ez = self
            .direction
            .try_normalize()
            .ok_or_else(|| refused("direction", self.direction, "finite and of some length"))?;
        let allowed = "finite, of some length and not parallel to the direction";
        let across = self
            .fan_axis
            .try_normalize()
            .map(|fan_axis| fan_axis.reject_from_normalized(ez))
            .filter(|across| across.length() >= MIN_FAN_AXIS_SINE)
            .ok_or_else(|| refused("fan_axis", self.fan_axis, allowed))?;
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
pub struct Frame {
    pub(super) origin: [f64; 3],
    pub(super) ex: [f64; 3],
    pub(super) ey: [f64; 3],
    pub(super) ez: [f64; 3],
}

impl Frame {
    /// Returns the frame with x and y turned by `angle`, in radians, right-handed about z.
    pub(super) fn turned(self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let [ex, ey] = [self.ex, self.ey].map(DVec3::from);
        Self {
            ex: (cos * ex + sin * ey).to_array(),
            ey: (cos * ey - sin * ex).to_array(),
            ..self
        }
    }

    /// Transforms a point of the world into the frame.
    #[inline(always)]
    pub(crate) fn local_from_world_point(&self, p: [f64; 3]) -> [f64; 3] {
        // Subtract first, then rotate: the difference is exact where the light is near.
        self.local_from_world_vector([
            p[0] - self.origin[0],
            p[1] - self.origin[1],
            p[2] - self.origin[2],
        ])
    }

    /// Rotates a vector of the world into the frame.
    #[inline(always)]
    pub(crate) fn local_from_world_vector(&self, v: [f64; 3]) -> [f64; 3] {
        [dot(v, self.ex), dot(v, self.ey), dot(v, self.ez)]
    }

    /// Rotates a vector of the frame into the world.
    #[inline(always)]
    pub(crate) fn world_from_local_vector(&self, v: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|i| v[0] * self.ex[i] + v[1] * self.ey[i] + v[2] * self.ez[i])
    }

    /// Transforms a point of the aperture plane into the world.
    pub(crate) fn world_from_aperture(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let offset = self.world_from_local_vector([x, y, 0.0]);
        core::array::from_fn(|i| self.origin[i] + offset[i])
    }
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACEMENT: Placement = Placement {
        origin: DVec3::new(0.1, -0.2, 0.3),
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    };

    #[test]
    fn axes_are_right_handed_and_orthonormal() {
        let frame = PLACEMENT.frame().unwrap();
        let [ex, ey, ez] = [frame.ex, frame.ey, frame.ez].map(DVec3::from);
        // Three rounded operations per component.
        let same = |a: DVec3, b: DVec3| a.distance(b) < 4.0 * f64::EPSILON;
        assert!(
            same(ex.cross(ey), ez) && same(ey.cross(ez), ex),
            "{frame:?}"
        );
        assert!(same(ez, PLACEMENT.direction.normalize()), "{frame:?}");
        let normal = PLACEMENT.direction.cross(PLACEMENT.fan_axis).normalize();
        assert!(same(ey, normal), "the fan axis lies in the fan plane");
        assert!(
            ex.dot(PLACEMENT.fan_axis) > 0.0,
            "x points along the fan axis"
        );
    }

    #[test]
    fn world_and_local_coordinates_are_inverse() {
        let frame = PLACEMENT.frame().unwrap();
        let v = [0.3, -0.7, 0.2];
        let back = frame.local_from_world_vector(frame.world_from_local_vector(v));
        let p = frame.local_from_world_point(frame.world_from_aperture([0.3, -0.7]));
        assert!(DVec3::from(back).distance(v.into()) < 1e-15, "{back:?}");
        assert!(
            DVec3::from(p).distance(DVec3::new(0.3, -0.7, 0.0)) < 1e-15,
            "{p:?}"
        );
    }
}
