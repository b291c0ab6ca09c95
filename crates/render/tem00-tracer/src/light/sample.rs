use glam::DVec3;

/// A direction from which a light illuminates a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// The direction to the light, of unit length.
    pub direction: DVec3,
    /// The distance to the light, in metres; infinite for an environment.
    pub distance: f64,
    /// The radiance divided by the density `pdf`, in W/m²; for a point, the irradiance across the
    /// direction.
    pub radiance_over_pdf: f64,
    /// The density with which the direction is drawn, per steradian; `None` for a point, which has
    /// no other direction.
    pub pdf: Option<f64>,
}
