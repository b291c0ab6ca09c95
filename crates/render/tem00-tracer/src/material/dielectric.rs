use glam::DVec3;

use super::BsdfSample;

/// A smooth boundary between the outside, of index 1, above and a clear medium below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dielectric {
    /// The index of the medium, at least 1.
    pub(super) index: f64,
}

impl Dielectric {
    /// Draws reflection or refraction by `choice`, uniform in [0, 1).
    ///
    /// Reflection is drawn with the probability R that light is reflected. Refracted light then has
    /// no loss, but radiance is per solid angle, which the boundary changes:
    ///
    /// ```text
    /// L_o = (1 − R) (n_o / n_i)² L_i
    /// ```
    ///
    /// `wo` must not lie in the surface.
    pub(super) fn sample(self, wo: DVec3, choice: f64) -> BsdfSample {
        let ratio = if wo.z > 0.0 {
            self.index
        } else {
            self.index.recip()
        };
        let Refraction {
            reflectance,
            cosine,
        } = refraction(wo.z.abs(), ratio);
        if choice < reflectance {
            return BsdfSample::mirrored(wo, 1.0, reflectance);
        }
        BsdfSample {
            wi: DVec3::new(-wo.x / ratio, -wo.y / ratio, -cosine.copysign(wo.z)),
            weight: (ratio * ratio).recip(),
            pdf: 1.0 - reflectance,
            specular: true,
            eta_squared: ratio * ratio,
        }
    }
}

/// Reflection and refraction of unpolarised light at a smooth boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refraction {
    /// The fraction of power that is reflected.
    pub(super) reflectance: f64,
    /// The cosine of the angle of refraction; 0 for total reflection.
    pub(super) cosine: f64,
}

/// Applies the laws of Snell and Fresnel to light that arrives at the positive `cosine`.
///
/// `ratio` is the index beyond the boundary divided by the index before it, η. With c = cos θ:
///
/// ```text
/// g = η cos θ_t = √(η² − 1 + c²)
/// R = ½ ((c − g) / (c + g))² + ½ ((η² c − g) / (η² c + g))²
/// ```
///
/// In this form nothing cancels at grazing incidence.
///
/// # References
///
/// - M. Born and E. Wolf, *Principles of Optics*, §1.5.2, eq. 21 and 33.
pub(super) fn refraction(cosine: f64, ratio: f64) -> Refraction {
    let square = ratio * ratio;
    let along_square = (square - 1.0) + cosine * cosine;
    if along_square <= 0.0 {
        return Refraction {
            reflectance: 1.0,
            cosine: 0.0,
        };
    }
    let along = along_square.sqrt();
    let perpendicular = (cosine - along) / (cosine + along);
    let parallel = (square * cosine - along) / (square * cosine + along);
    Refraction {
        reflectance: 0.5 * (perpendicular * perpendicular + parallel * parallel),
        cosine: along / ratio,
    }
}
