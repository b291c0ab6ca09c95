use glam::DVec3;

/// The axes in which a material sees a surface: z along the normal, x and y in the surface.
///
/// The axes are orthonormal and right-handed. The tangents follow from the normal alone, without a
/// seam that matters to isotropic materials.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_tracer::LocalFrame;
///
/// let frame = LocalFrame::from_normal(DVec3::Y);
/// assert!(frame.to_local(DVec3::Y).abs_diff_eq(DVec3::Z, 1e-15));
///
/// let direction = DVec3::new(0.6, 0.0, 0.8);
/// let there_and_back = frame.to_world(frame.to_local(direction));
/// assert!(there_and_back.abs_diff_eq(direction, 1e-15));
/// ```
///
/// # References
///
/// - T. Duff et al., *Building an Orthonormal Basis, Revisited*, 2017.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    tangent: DVec3,
    bitangent: DVec3,
    normal: DVec3,
}

impl LocalFrame {
    /// Creates the frame of a surface from its `normal`, of unit length.
    pub fn from_normal(normal: DVec3) -> Self {
        let DVec3 { x, y, z } = normal;
        let sign = 1.0_f64.copysign(z);
        // sign + z never falls below 1 in magnitude, so the division is safe for every unit normal.
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        Self {
            tangent: DVec3::new(1.0 + sign * x * x * a, sign * b, -sign * x),
            bitangent: DVec3::new(b, sign + y * y * a, -y),
            normal,
        }
    }

    /// Returns the local x axis, of unit length.
    pub const fn tangent(&self) -> DVec3 {
        self.tangent
    }

    /// Returns the local y axis, of unit length.
    pub const fn bitangent(&self) -> DVec3 {
        self.bitangent
    }

    /// Returns the local z axis, of unit length.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Returns the local components of a vector given in world components.
    pub fn to_local(&self, vector: DVec3) -> DVec3 {
        DVec3::new(
            vector.dot(self.tangent),
            vector.dot(self.bitangent),
            vector.dot(self.normal),
        )
    }

    /// Returns the world components of a vector given in local components.
    pub fn to_world(&self, vector: DVec3) -> DVec3 {
        vector.x * self.tangent + vector.y * self.bitangent + vector.z * self.normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_orthonormal(normal: DVec3) {
        let frame = LocalFrame::from_normal(normal);
        let (t, b, n) = (frame.tangent(), frame.bitangent(), frame.normal());
        // Each component is a handful of operations on numbers up to 1: some 10 roundings of
        // 1.1e−16, plus the rounding of the normal's own length.
        let tolerance = 4e-15;
        for (name, got, want) in [
            ("t·t", t.dot(t), 1.0),
            ("b·b", b.dot(b), 1.0),
            ("t·b", t.dot(b), 0.0),
            ("t·n", t.dot(n), 0.0),
            ("b·n", b.dot(n), 0.0),
            ("t×b·n", t.cross(b).dot(n), 1.0),
        ] {
            assert!(
                (got - want).abs() < tolerance,
                "{name} = {got} for n = {normal}"
            );
        }
    }

    proptest! {
        #[test]
        fn axes_are_orthonormal_and_right_handed(z in -1.0_f64..=1.0, azimuth in 0.0_f64..6.3) {
            let radius = ((1.0 - z) * (1.0 + z)).sqrt();
            let (sin, cos) = azimuth.sin_cos();
            assert_orthonormal(DVec3::new(radius * cos, radius * sin, z).normalize());
        }
    }

    #[test]
    fn axes_are_orthonormal_at_both_poles() {
        for z in [1.0, -1.0] {
            for tilt in [0.0, 1e-300, 1e-17, 1e-9, 1e-4] {
                assert_orthonormal(DVec3::new(tilt, -tilt, z).normalize());
            }
        }
        assert_orthonormal(DVec3::new(1.0, 0.0, -0.0));
    }
}
