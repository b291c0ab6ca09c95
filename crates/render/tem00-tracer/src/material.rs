mod albedo;
mod conductor;
mod constructors;
mod dielectric;
mod diffuse;
mod ggx;
mod optical_roughness;
mod oren_nayar;
mod plastic;
mod sample;

use core::f64::consts::FRAC_1_PI;

use glam::DVec3;
use tem00_translucence::Medium;

pub use self::optical_roughness::{OpticalRoughness, OpticalRoughnessQuery};
pub use self::sample::BsdfSample;
use self::{
    conductor::Conductor,
    dielectric::Dielectric,
    diffuse::{cosine_pdf, sample_cosine},
    oren_nayar::OrenNayar,
    plastic::Plastic,
};
use crate::{Metal, TracerError, metal::fresnel_reflectance};

/// Scattering of light by a surface.
///
/// Directions are unit vectors in a [local frame](crate::LocalFrame) whose z axis is the normal,
/// and point away from the surface: `wo` to where the light goes, `wi` to where it comes from. The
/// quantity carried from `wi` to `wo` is radiance. Wavelengths are in metres, in vacuum; directions
/// are drawn alike for every wavelength, and only their weights differ.
///
/// Materials are isotropic. All materials except glass are opaque and alike on both sides: the
/// properties above the surface hold mirrored below it, unless the material is
/// [`one_sided`](Self::one_sided).
///
/// A material is either rough or *specular*: [mirrors](Self::mirror), [polished
/// metal](Self::polished) and [glass](Self::dielectric) send light into single directions, which
/// only [`sample`](Self::sample) finds. Their BSDF and density are 0 elsewhere.
///
/// # Examples
///
/// ```
/// use glam::DVec3;
/// use tem00_tracer::Material;
///
/// let paper = Material::lambertian(0.8)?;
/// let f = paper.evaluate(DVec3::Z, DVec3::new(0.6, 0.0, 0.8), 650e-9);
/// assert!((f - 0.8 / core::f64::consts::PI).abs() < 1e-15);
///
/// // Window glass reflects 4 % of the light that meets it head-on.
/// let glass = Material::dielectric(1.5)?;
/// let reflected = glass.sample(DVec3::Z, [0.0, 0.5], 650e-9).ok_or("nothing to draw")?;
/// assert_eq!(reflected.wi, DVec3::Z);
/// assert!((reflected.pdf - 0.04).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    scattering: Scattering,
    one_sided: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "a scene has few materials, which are looked at where they are"
)]
enum Scattering {
    Lambertian { reflectance: f64 },
    OrenNayar(OrenNayar),
    Conductor(Conductor),
    Plastic(Plastic),
    Mirror { reflectance: f64 },
    Polished { metal: Metal },
    Dielectric(Dielectric),
}

impl Material {
    /// Returns whether light goes into single directions only, which [`sample`](Self::sample)
    /// finds.
    pub const fn is_specular(&self) -> bool {
        matches!(
            self.scattering,
            Scattering::Mirror { .. } | Scattering::Polished { .. } | Scattering::Dielectric(_)
        )
    }

    /// Returns whether only the side of the normal scatters light.
    pub const fn is_one_sided(&self) -> bool {
        self.one_sided
    }

    /// Checks that the material is known at a wavelength, in metres.
    ///
    /// Code that combines a material with a light makes this check once; the other methods take the
    /// nearest wavelength that was measured.
    ///
    /// # Errors
    ///
    /// Returns an error if the material is a metal that was not measured at the wavelength.
    pub fn check_wavelength(&self, wavelength: f64) -> Result<(), TracerError> {
        match self.scattering {
            Scattering::Conductor(Conductor { metal, .. }) | Scattering::Polished { metal } => {
                metal.check_wavelength(wavelength)
            }
            _ => Ok(()),
        }
    }

    /// Returns the bidirectional scattering distribution function, in 1/sr.
    ///
    /// The cosine of `wi` is not included. The value is 0 for specular materials, and where `wo`
    /// and `wi` are on different sides of the surface.
    pub fn evaluate(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        let Some((wo, wi)) = self.same_side(wo, wi) else {
            return 0.0;
        };
        match &self.scattering {
            Scattering::Lambertian { reflectance } => reflectance * FRAC_1_PI,
            Scattering::OrenNayar(facets) => facets.evaluate(wo, wi),
            Scattering::Conductor(metal) => metal.evaluate(wo, wi, wavelength),
            Scattering::Plastic(plastic) => plastic.evaluate(wo, wi),
            Scattering::Mirror { .. } | Scattering::Polished { .. } | Scattering::Dielectric(_) => {
                0.0
            }
        }
    }

    /// Returns the body below the boundary of a [translucent](Self::translucent) material.
    pub const fn below(&self) -> Option<&Medium> {
        match &self.scattering {
            Scattering::Plastic(plastic) => plastic.below(),
            _ => None,
        }
    }

    /// Returns the [BSDF](Self::evaluate) without light that comes from [below](Self::below) the
    /// boundary.
    pub fn evaluate_boundary(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        match &self.scattering {
            Scattering::Plastic(plastic) if plastic.below().is_some() => self
                .same_side(wo, wi)
                .map_or(0.0, |(wo, wi)| plastic.evaluate_coat(wo, wi)),
            _ => self.evaluate(wo, wi, wavelength),
        }
    }

    /// Draws the place where light from [below](Self::below) the boundary entered it, in local
    /// axes, and returns its radiance; see [`Medium::entry`].
    ///
    /// The light comes from a distant source in the direction `wi`, and reaches the surface from a
    /// `distance` on, in metres; `irradiance` is its irradiance at an offset from the point, on a
    /// plane that faces it.
    pub fn entry(
        &self,
        [wo, wi]: [DVec3; 2],
        distance: f64,
        seed: u64,
        mut irradiance: impl FnMut(DVec3) -> f64,
    ) -> Option<(DVec3, f64)> {
        // As seen from above, where x and y are reversed, too.
        let side = wo.z.signum();
        let on_surface = |[x, y]: [f64; 2]| DVec3::new(side * x, side * y, 0.0);
        let (wo, wi) = self.same_side(wo, wi)?;
        let directions = [wo, wi].map(|direction| direction.to_array());
        let medium = self.below()?;
        let entry = medium.entry(directions, distance, seed, |offset| {
            irradiance(on_surface(offset))
        })?;
        Some((on_surface(entry.offset), entry.radiance))
    }

    /// Draws a direction from two uniform numbers in [0, 1).
    ///
    /// The directions do not depend on the wavelength. Diffuse materials draw in proportion to the
    /// cosine or nearly so, metals and coats from the facets that `wo` sees, and specular materials
    /// the directions they have. Returns `None` where the drawn facet reflects to the other side of
    /// the surface, and for a `wo` along the surface: such a path carries nothing.
    pub fn sample(&self, wo: DVec3, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        let above = self.facing_up(wo)?;
        let mut sample = match &self.scattering {
            Scattering::Lambertian { reflectance } => {
                let wi = sample_cosine(u);
                BsdfSample::rough(wi, *reflectance, cosine_pdf(wi))
            }
            Scattering::OrenNayar(facets) => facets.sample(above, u),
            Scattering::Conductor(metal) => metal.sample(above, u, wavelength)?,
            Scattering::Plastic(plastic) => plastic.sample(above, u)?,
            Scattering::Mirror { reflectance } => BsdfSample::mirrored(above, *reflectance, 1.0),
            Scattering::Polished { metal } => {
                BsdfSample::mirrored(above, smooth_reflectance(*metal, above.z, wavelength), 1.0)
            }
            Scattering::Dielectric(glass) => {
                let sample = glass.sample(wo, u[0]);
                return (sample.wi.z > 0.0 || !self.one_sided).then_some(sample);
            }
        };
        if wo.z < 0.0 {
            sample.wi = -sample.wi;
        }
        Some(sample)
    }

    /// Returns the density with which [`sample`](Self::sample) draws `wi`, per steradian; 0 for
    /// specular materials.
    pub fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some((wo, wi)) = self.same_side(wo, wi) else {
            return 0.0;
        };
        match &self.scattering {
            Scattering::Lambertian { .. } => cosine_pdf(wi),
            Scattering::OrenNayar(facets) => facets.pdf(wo, wi),
            Scattering::Conductor(metal) => metal.pdf(wo, wi),
            Scattering::Plastic(plastic) => plastic.pdf(wo, wi),
            Scattering::Mirror { .. } | Scattering::Polished { .. } | Scattering::Dielectric(_) => {
                0.0
            }
        }
    }

    /// Returns the weight that a direction drawn for `wo` has at another `wavelength`.
    ///
    /// One path serves all lights of a scene: it is drawn once and weighted for each of them.
    pub fn reweighted(&self, wo: DVec3, sample: &BsdfSample, wavelength: f64) -> f64 {
        match &self.scattering {
            Scattering::Conductor(metal) => {
                let above = self.same_side(wo, sample.wi);
                above.map_or(0.0, |(wo, wi)| metal.weight(wo, wi, wavelength))
            }
            Scattering::Polished { metal } => smooth_reflectance(*metal, wo.z.abs(), wavelength),
            _ => sample.weight,
        }
    }

    /// Returns both directions as if seen from above, or `None` unless they are on one lit side.
    fn same_side(&self, wo: DVec3, wi: DVec3) -> Option<(DVec3, DVec3)> {
        if wo.z * wi.z > 0.0 {
            let above = self.facing_up(wo)?;
            return Some((above, if wo.z > 0.0 { wi } else { -wi }));
        }
        None
    }

    /// Returns the direction as if seen from above, or `None` for one along the surface or behind a
    /// one-sided material.
    fn facing_up(&self, wo: DVec3) -> Option<DVec3> {
        if wo.z > 0.0 {
            return Some(wo);
        }
        (wo.z < 0.0 && !self.one_sided).then_some(-wo)
    }
}

fn smooth_reflectance(metal: Metal, cosine: f64, wavelength: f64) -> f64 {
    fresnel_reflectance(cosine.min(1.0), metal.nearest_refractive_index(wavelength))
}

#[cfg(test)]
mod tests;
