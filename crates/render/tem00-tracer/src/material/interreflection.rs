use core::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::{
    BsdfSample,
    albedo::Albedo,
    conductor::Conductor,
    diffuse::{choose_first, cosine_pdf, sample_cosine},
};
use crate::{Metal, metal::fresnel_reflectance};

/// Facets of a metal that pass light on to each other. All directions are above the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interreflection {
    pub(super) facets: Conductor,
    /// The albedo of the facets if they absorbed nothing.
    white: Albedo,
}

impl Interreflection {
    pub(super) fn new(facets: Conductor) -> Self {
        Self {
            facets,
            white: Albedo::new(facets.facets, |_| 1.0),
        }
    }

    pub(super) fn evaluate(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        let lost = (1.0 - self.white.at_cosine(wo.z)) * (1.0 - self.white.at_cosine(wi.z));
        self.facets.evaluate(wo, wi, wavelength) + self.many(wavelength) * lost
    }

    pub(super) fn sample(
        &self,
        wo: DVec3,
        [u, v]: [f64; 2],
        wavelength: f64,
    ) -> Option<BsdfSample> {
        let (once, u) = choose_first(self.white.at_cosine(wo.z), u);
        let wi = if once {
            self.facets.facets.reflect(wo, [u, v])
        } else {
            sample_cosine([u, v])
        };
        (wo.z * wi.z > 0.0).then(|| {
            let pdf = self.pdf(wo, wi);
            BsdfSample::rough(wi, self.evaluate(wo, wi, wavelength) * wi.z / pdf, pdf)
        })
    }

    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let once = self.white.at_cosine(wo.z);
        once * self.facets.pdf(wo, wi) + (1.0 - once) * cosine_pdf(wi)
    }

    /// Returns the factor of what is lost in both directions.
    fn many(&self, wavelength: f64) -> f64 {
        let (metal, kept) = (
            mean_reflectance(self.facets.metal, wavelength),
            self.white.mean(),
        );
        let many = metal * metal * kept / (1.0 - metal * (1.0 - kept));
        many * FRAC_1_PI / (1.0 - kept)
    }
}

/// Returns the mean `∫ 2 F(μ) μ dμ` of the reflectance of a smooth metal over all directions.
///
/// Gauss's rule with three points for the weight μ errs by 2e-3 at most for the metals here.
fn mean_reflectance(metal: Metal, wavelength: f64) -> f64 {
    const POINTS: [(f64, f64); 3] = [
        (0.212_340_538_239_153, 0.139_653_959_802_908_1),
        (0.590_533_135_559_266_2, 0.458_482_212_719_172),
        (0.911_412_040_487_297_1, 0.401_863_827_477_919_3),
    ];
    let index = metal.nearest_refractive_index(wavelength);
    POINTS
        .iter()
        .map(|&(cosine, weight)| weight * fresnel_reflectance(cosine, index))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_reflectance_is_the_integral_over_all_directions() {
        const RINGS: u32 = 20_000;
        for metal in [
            Metal::Aluminium,
            Metal::Silver,
            Metal::Gold,
            Metal::Iron,
            Metal::Tungsten,
        ] {
            let index = metal.nearest_refractive_index(650e-9);
            let mean: f64 = (0..RINGS)
                .map(|i| (f64::from(i) + 0.5) / f64::from(RINGS))
                .map(|cosine| 2.0 * cosine * fresnel_reflectance(cosine, index) / f64::from(RINGS))
                .sum();
            let got = mean_reflectance(metal, 650e-9);
            // The smooth metals' dip at grazing incidence is narrower than the points are apart.
            assert!((got - mean).abs() < 2e-3, "{metal:?}: {got}, not {mean}");
        }
    }
}
