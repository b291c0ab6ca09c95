use core::f64::consts::{FRAC_1_PI, PI, TAU};

use glam::DVec3;

use super::{
    BsdfSample,
    diffuse::{choose_first, cosine_pdf, sample_cosine, sample_hemisphere},
};

/// `½ − 2/(3π)`: the albedo that retro-reflection adds at grazing incidence, per ratio.
const GRAZING: f64 = 0.5 - 2.0 / (3.0 * PI);

/// `6/(5π) − 1/6`: the mean over all directions of the albedo that is
/// [missing](OrenNayar::missing), per ratio.
const MEAN_MISSING: f64 = 6.0 / (5.0 * PI) - 1.0 / 6.0;

/// Lambertian facets that shadow and light each other. All directions are above the surface.
///
/// One reflection follows Fujii's form of the Oren–Nayar model, many reflections the compensation
/// of Portsmouth et al. With s = wo·wi − cos θo cos θi, t = max(cos θo, cos θi) for s > 0 and 1
/// else, and ρ the reflectance of the facets:
///
/// ```text
/// f = (ρ A / π) (1 + r s / t) + (ρ_m / π) (1 − E(θo)) (1 − E(θi)) / (1 − Ē)
/// A = 1 / (1 + r (½ − 2/(3π)))             E(θ) = A (1 + r G(θ) / π)
/// ρ_m = ρ² Ē / (1 − ρ (1 − Ē))             G(θ) = ∫ (s / t) cos θi dωi
/// ```
///
/// E is the albedo of one reflection by white facets and Ē its mean over all directions. Both
/// 1 − E and 1 − Ē are proportional to A r, which is taken out: nothing is divided by zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OrenNayar {
    /// The ratio r of retro-reflection to even reflection, below 1.
    ratio: f64,
    /// ρ A / π.
    single: f64,
    /// The factor of the albedo that is missing in both directions.
    multiple: f64,
}

impl OrenNayar {
    /// Creates facets from their reflectance and the rms angle of their slopes, in radians.
    ///
    /// The ratio follows the qualitative model of Oren and Nayar (1994, eq. 30):
    ///
    /// ```text
    /// r = (0.45 σ² / (σ² + 0.09)) / (1 − 0.5 σ² / (σ² + 0.33))
    /// ```
    pub(super) fn new(reflectance: f64, sigma: f64) -> Self {
        let square = sigma * sigma;
        let ratio = 0.45 * square / (square + 0.09) / (1.0 - 0.5 * square / (square + 0.33));
        let even = (1.0 + ratio * GRAZING).recip();
        let mean = 1.0 - even * ratio * MEAN_MISSING;
        let many = reflectance * reflectance * mean / (1.0 - reflectance * (1.0 - mean));
        Self {
            ratio,
            single: reflectance * FRAC_1_PI * even,
            multiple: many * FRAC_1_PI * even * ratio / MEAN_MISSING,
        }
    }

    pub(super) fn evaluate(&self, wo: DVec3, wi: DVec3) -> f64 {
        let s = wo.x * wi.x + wo.y * wi.y;
        let t = if s > 0.0 { wo.z.max(wi.z) } else { 1.0 };
        self.single * (1.0 + self.ratio * s / t) + self.multiple * missing(wo.z) * missing(wi.z)
    }

    pub(super) fn sample(&self, wo: DVec3, [u, v]: [f64; 2]) -> BsdfSample {
        let (even, u) = choose_first(self.even_probability(wo), u);
        let wi = if even {
            sample_hemisphere([u, v])
        } else {
            sample_cosine([u, v])
        };
        let pdf = self.pdf(wo, wi);
        BsdfSample::rough(wi, self.evaluate(wo, wi) * wi.z / pdf, pdf)
    }

    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let even = self.even_probability(wo);
        even / TAU + (1.0 - even) * cosine_pdf(wi)
    }

    /// Returns how often to draw without regard to the cosine: seen at grazing incidence, light
    /// that grazes as well is retro-reflected as strongly as light from above.
    fn even_probability(&self, wo: DVec3) -> f64 {
        0.5 * self.ratio * (1.0 - wo.z).max(0.0)
    }
}

/// Returns `(1 − E(θ)) / (A r) = ½ − 2/(3π) − G(θ)/π` at the cosine of θ.
///
/// With c = cos θ and s = sin θ:
///
/// ```text
/// G = s (θ − s c) + ⅔ s ((1 − s³) / c − 1)        (1 − s³) / c = c (1 + s + s²) / (1 + s)
/// ```
fn missing(cosine: f64) -> f64 {
    let c = cosine.min(1.0);
    let s = ((1.0 - c) * (1.0 + c)).sqrt();
    let far = c * (1.0 + s + s * s) / (1.0 + s) - 1.0;
    let retro = s * (libm::acos(c) - s * c) + 2.0 / 3.0 * s * far;
    (GRAZING - retro * FRAC_1_PI).max(0.0)
}
