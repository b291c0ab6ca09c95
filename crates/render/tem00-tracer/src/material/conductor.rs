use glam::DVec3;

use super::{
    BsdfSample,
    ggx::{Ggx, half_vector},
};
use crate::{Metal, metal::fresnel_reflectance};

/// Facets of a metal. All directions are above the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Conductor {
    pub(super) metal: Metal,
    pub(super) facets: Ggx,
}

impl Conductor {
    pub(super) fn evaluate(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        let facet = half_vector(wo, wi);
        self.reflectance(wi, facet, wavelength)
            * self.facets.density(facet)
            * self.facets.visibility(wo, wi)
    }

    pub(super) fn sample(&self, wo: DVec3, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        let facet = self.facets.sample_visible(wo, u);
        let wi = 2.0 * wo.dot(facet) * facet - wo;
        (wo.z * wi.z > 0.0).then(|| {
            let reflectance = self.reflectance(wi, facet, wavelength);
            BsdfSample::rough(
                wi,
                reflectance * self.facets.masking_ratio(wo, wi),
                self.facets.reflected_pdf(wo, facet),
            )
        })
    }

    pub(super) fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.facets.reflected_pdf(wo, half_vector(wo, wi))
    }

    /// Returns the weight of a drawn direction: the density of the facets cancels.
    pub(super) fn weight(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        self.reflectance(wi, half_vector(wo, wi), wavelength) * self.facets.masking_ratio(wo, wi)
    }

    fn reflectance(&self, wi: DVec3, facet: DVec3, wavelength: f64) -> f64 {
        let index = self.metal.nearest_refractive_index(wavelength);
        fresnel_reflectance(wi.dot(facet).clamp(0.0, 1.0), index)
    }
}
