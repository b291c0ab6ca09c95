use glam::DVec3;

/// A direction drawn from a material, with its weight and density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The drawn direction, of unit length, in the local frame.
    pub wi: DVec3,
    /// The BSDF times |cos θ| of `wi`, divided by `pdf`.
    pub weight: f64,
    /// The density with which `wi` is drawn, per steradian. For specular materials it is the
    /// probability of the choice between reflection and refraction.
    pub pdf: f64,
    /// True if the material sends light into single directions only.
    pub specular: bool,
    /// The square of the index on the side of `wi`, relative to the index on the side of `wo`; 1
    /// for reflection. `weight` is for radiance carried from `wi` to `wo`; `weight · eta_squared`
    /// is for power carried from `wo` to `wi`, on paths that start at a light.
    pub eta_squared: f64,
}

impl BsdfSample {
    pub(super) fn rough(wi: DVec3, weight: f64, pdf: f64) -> Self {
        Self {
            wi,
            weight,
            pdf,
            specular: false,
            eta_squared: 1.0,
        }
    }

    pub(super) fn mirrored(wo: DVec3, weight: f64, pdf: f64) -> Self {
        Self {
            wi: DVec3::new(-wo.x, -wo.y, wo.z),
            weight,
            pdf,
            specular: true,
            eta_squared: 1.0,
        }
    }
}
