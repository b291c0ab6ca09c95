use glam::DVec3;

/// A half-line along which light is traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The start of the ray, in metres.
    pub origin: DVec3,
    /// The direction of the ray, of unit length.
    pub direction: DVec3,
}
