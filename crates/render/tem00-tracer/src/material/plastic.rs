use core::f64::consts::{FRAC_1_PI, FRAC_PI_4};

use glam::DVec3;
use tem00_numerics::Refusal;
use tem00_translucence::{LineSpread, Medium, Walk};

use super::{
    BsdfSample,
    albedo::Albedo,
    dielectric::refraction,
    diffuse::{choose_first, cosine_pdf, sample_cosine},
    ggx::{Ggx, half_vector},
};

/// A clear coat with a rough surface over a diffuse base. All directions are above the surface.
///
/// Light that the coat does not reflect enters it, is reflected diffusely by the base, and leaves
/// or is thrown back by the coat's inner side, again and again. With E the albedo of the coat, Ē
/// its mean over all directions and ρ the reflectance of the base:
///
/// ```text
/// f = R D G₂ / (4 cos θo cos θi) + (κ / π) (1 − E(θo)) (1 − E(θi)) / (1 − Ē)
/// κ = ρ (1 − R_in) / (1 − ρ R_in)        1 − R_in = (1 − Ē) / n²
/// ```
///
/// `R_in`, the fraction of diffuse light that the inner side of the coat throws back, follows from
/// reciprocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plastic {
    facets: Ggx,
    index: f64,
    albedo: Albedo,
    /// The fraction κ of the light entering the coat that comes out again.
    returned: f64,
    /// κ / (π (1 − Ē)).
    base: f64,
    /// The body below the coat, where light leaves beside the place of its entry.
    below: Option<Medium>,
}

impl Plastic {
    pub(super) fn new(reflectance: f64, index: f64, facets: Ggx) -> Self {
        let coat = Self::coat(index, facets);
        let leaving = (1.0 - coat.albedo.mean()) / (index * index);
        coat.returning(reflectance * leaving / (1.0 - reflectance * (1.0 - leaving)))
    }

    /// The boundary of a body that lets light in.
    pub(super) fn over(medium: Medium, facets: Ggx) -> Result<Self, Refusal> {
        // The albedo depends little on the anisotropy and on the angle.
        let n = medium.refractive_index();
        let isotropic = Medium::new(n, 1.0 / medium.transport_length(), medium.absorption())?;
        let walk = Walk {
            incidence: FRAC_PI_4,
            exits: vec![0.0],
            photons: 20_000,
            seed: 0,
        };
        let returned = LineSpread::simulate(&isotropic, &walk)?[0].albedo();
        Ok(Self {
            below: Some(medium),
            ..Self::coat(n, facets).returning(returned)
        })
    }

    fn coat(index: f64, facets: Ggx) -> Self {
        Self {
            facets,
            index,
            albedo: Albedo::new(facets, |cosine| refraction(cosine, index).reflectance),
            returned: 0.0,
            base: 0.0,
            below: None,
        }
    }

    /// Returns a fraction of the light that enters the coat.
    fn returning(self, returned: f64) -> Self {
        let base = returned * FRAC_1_PI / (1.0 - self.albedo.mean());
        Self {
            returned,
            base,
            ..self
        }
    }

    pub(super) const fn below(&self) -> Option<&Medium> {
        self.below.as_ref()
    }

    /// Returns the roughness α of the coat.
    pub(super) const fn roughness(&self) -> f64 {
        self.facets.alpha
    }

    pub(super) fn evaluate(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.evaluate_coat(wo, wi)
            + self.base * (1.0 - self.albedo.at_cosine(wo.z)) * (1.0 - self.albedo.at_cosine(wi.z))
    }

    pub(super) fn evaluate_coat(&self, wo: DVec3, wi: DVec3) -> f64 {
        let facet = half_vector(wo, wi);
        let cosine = wi.dot(facet).clamp(0.0, 1.0);
        refraction(cosine, self.index).reflectance
            * self.facets.density(facet)
            * self.facets.visibility(wo, wi)
    }

    pub(super) fn sample(&self, wo: DVec3, [u, v]: [f64; 2]) -> Option<BsdfSample> {
        let (coat, u) = choose_first(self.coat_probability(wo), u);
        let wi = if coat {
            self.facets.reflect(wo, [u, v])
        } else {
            sample_cosine([u, v])
        };
        (wo.z * wi.z > 0.0).then(|| {
            let pdf = self.pdf(wo, wi);
            BsdfSample::rough(wi, self.evaluate(wo, wi) * wi.z / pdf, pdf)
        })
    }

    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let coat = self.coat_probability(wo);
        coat * self.facets.reflected_pdf(wo, half_vector(wo, wi)) + (1.0 - coat) * cosine_pdf(wi)
    }

    /// Returns the fraction of the light reflected towards `wo` that the coat itself reflects.
    fn coat_probability(&self, wo: DVec3) -> f64 {
        let coat = self.albedo.at_cosine(wo.z);
        coat / (coat + self.returned * (1.0 - coat))
    }
}
