mod albedo;
mod conductor;
mod dielectric;
mod diffuse;
mod ggx;
mod optical_roughness;
mod oren_nayar;
mod plastic;

use core::{
    f64::consts::{FRAC_1_PI, FRAC_PI_2},
    ops::RangeInclusive,
};

use glam::DVec3;

pub use self::optical_roughness::{OpticalRoughness, OpticalRoughnessQuery};
use self::{
    conductor::Conductor,
    dielectric::Dielectric,
    diffuse::{cosine_pdf, sample_cosine},
    ggx::Ggx,
    oren_nayar::OrenNayar,
    plastic::Plastic,
};
use crate::{Metal, TracerError, metal::fresnel_reflectance};

/// How a surface scatters light.
///
/// Directions are unit vectors in a [local frame](crate::LocalFrame) whose z axis is the normal, and
/// point away from the surface: `wo` to where the light goes, `wi` to where it comes from. What is
/// carried from `wi` to `wo` is radiance. Wavelengths are in metres, in vacuum; directions are drawn
/// alike for every wavelength, only what they carry differs.
///
/// Materials are isotropic. All but glass are opaque and alike on both sides: what holds above the
/// surface holds mirrored below it, unless the material is [`one_sided`](Self::one_sided).
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
    reason = "scenes have few materials, and a pointer would slow down every evaluation"
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

/// A direction drawn from a material, with what an estimator needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The drawn direction, of unit length, in the local frame.
    pub wi: DVec3,
    /// The BSDF times |cos θ| of `wi`, divided by `pdf`.
    pub weight: f64,
    /// The density with which `wi` is drawn, per steradian. For specular materials it is the
    /// probability of the choice between reflection and refraction.
    pub pdf: f64,
    /// Whether the material sends light into single directions only.
    pub specular: bool,
    /// The square of the index on the side of `wi`, relative to that on the side of `wo`; 1 for
    /// reflection. `weight` is that of radiance carried from `wi` to `wo`; `weight · eta_squared` is
    /// that of power carried from `wo` to `wi`, for paths that start at a light.
    pub eta_squared: f64,
}

impl BsdfSample {
    fn rough(wi: DVec3, weight: f64, pdf: f64) -> Self {
        Self {
            wi,
            weight,
            pdf,
            specular: false,
            eta_squared: 1.0,
        }
    }

    fn mirrored(wo: DVec3, weight: f64, pdf: f64) -> Self {
        Self {
            wi: DVec3::new(-wo.x, -wo.y, wo.z),
            weight,
            pdf,
            specular: true,
            eta_squared: 1.0,
        }
    }
}

impl Material {
    /// Creates a material that looks equally bright from every side and reflects the fraction
    /// `reflectance` of the power that falls on it, at every wavelength.
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1.
    pub fn lambertian(reflectance: f64) -> Result<Self, TracerError> {
        check_reflectance(reflectance)?;
        Ok(Self::new(Scattering::Lambertian { reflectance }))
    }

    /// Creates a rough diffuse material, such as plaster, clay or a sandblasted casting: Lambertian
    /// facets of the given `reflectance` whose slopes have the rms angle `sigma`, in radians.
    ///
    /// Seen from where the light comes from, it is as bright at its edge as in its middle. Light is
    /// followed over any number of facets: white ones lose nothing. A `sigma` of 0 is
    /// [`lambertian`](Self::lambertian).
    ///
    /// # Validity
    ///
    /// The model fits facets in V-shaped grooves; the ratio of retro-reflection to even reflection
    /// is the published fit to them, for one reflection. Facets of any other reflectance than 1
    /// reflect less in all than a flat surface would, as light meets several of them.
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1 or `sigma` not between 0 and π/2.
    ///
    /// # References
    ///
    /// - M. Oren and S. K. Nayar, *Generalization of Lambert's Reflectance Model*, 1994, eq. 30.
    /// - J. Portsmouth, P. Kutz and S. Hill, *EON: A Practical Energy-Preserving Rough Diffuse BRDF*,
    ///   2025.
    pub fn oren_nayar(reflectance: f64, sigma: f64) -> Result<Self, TracerError> {
        check_reflectance(reflectance)?;
        check("sigma", sigma, 0.0..=FRAC_PI_2, "between 0 and π/2")?;
        Ok(Self::new(Scattering::OrenNayar(OrenNayar::new(
            reflectance,
            sigma,
        ))))
    }

    /// Creates a rough metal: microfacets with the GGX distribution of slopes.
    ///
    /// `roughness` is the parameter α: facets over half of the surface are inclined by less than
    /// arctan α. The reflectance of each facet is Fresnel's, without approximation. Light that would
    /// meet a second facet is lost, as in all single-scattering models.
    ///
    /// # Validity
    ///
    /// A metal that absorbs nothing would lose, to second facets, of light from everywhere:
    ///
    /// ```text
    /// α      0.1    0.2    0.3    0.5    0.7    1
    /// lost   3 %    9 %    15 %   30 %   43 %   59 %
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the roughness is not between 0.01 and 1, or if the index of a custom
    /// metal is impossible. A smoother surface has a lobe of about 1°, too narrow for light and
    /// camera to meet in it by chance: take [`polished`](Self::polished).
    ///
    /// # References
    ///
    /// - B. Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007, eq. 33.
    /// - E. Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, 2014,
    ///   eq. 72 and 99.
    /// - E. Heitz, *Sampling the GGX Distribution of Visible Normals*, 2018.
    pub fn conductor(metal: Metal, roughness: f64) -> Result<Self, TracerError> {
        metal.check_index()?;
        let facets = rough_facets(roughness)?;
        Ok(Self::new(Scattering::Conductor(Conductor {
            metal,
            facets,
        })))
    }

    /// Creates a plastic, lacquer or glaze: a clear coat of the given `index` with a rough surface
    /// over a diffuse base that reflects the fraction `reflectance` of what reaches it.
    ///
    /// `roughness` is that of [`conductor`](Self::conductor). Light that the first facet does not
    /// reflect enters the coat; the base and the inner side of the coat pass it to and fro until it
    /// is absorbed or leaves. A white base loses nothing. A grey one looks darker than it is: with an
    /// index of 1.5 and a nearly smooth coat, a base of 0.5 returns 0.29 of the light that enters.
    ///
    /// # Validity
    ///
    /// The coat absorbs nothing and is thin beside what the image resolves. Energy is kept to 2e-4.
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1, the index not between 1.1 and 3,
    /// or the roughness not between 0.01 and 1.
    ///
    /// # References
    ///
    /// - C. Kelemen and L. Szirmay-Kalos, *A Microfacet Based Coupled Specular-Matte BRDF Model with
    ///   Importance Sampling*, 2001.
    pub fn plastic(reflectance: f64, index: f64, roughness: f64) -> Result<Self, TracerError> {
        check_reflectance(reflectance)?;
        check("index", index, 1.1..=3.0, "between 1.1 and 3")?;
        let facets = rough_facets(roughness)?;
        Ok(Self::new(Scattering::Plastic(Plastic::new(
            reflectance,
            index,
            facets,
        ))))
    }

    /// Creates a mirror that reflects the same fraction of power at every angle and wavelength.
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1.
    pub fn mirror(reflectance: f64) -> Result<Self, TracerError> {
        check_reflectance(reflectance)?;
        Ok(Self::new(Scattering::Mirror { reflectance }))
    }

    /// Creates a mirror of smooth metal, whose reflectance is Fresnel's for unpolarised light.
    ///
    /// # Errors
    ///
    /// Returns an error if the index of a custom metal is impossible.
    pub fn polished(metal: Metal) -> Result<Self, TracerError> {
        metal.check_index()?;
        Ok(Self::new(Scattering::Polished { metal }))
    }

    /// Creates the smooth surface of glass or another clear medium, which lies below the surface;
    /// above is air or vacuum.
    ///
    /// Reflectance is Fresnel's for unpolarised light, refraction follows Snell's law, and nothing
    /// is absorbed. The index is the same at every wavelength: a path then takes one way for all
    /// lasers of a scene, and every light costs one path. Take the index at the laser's wavelength;
    /// from 450 nm to 650 nm that of crown glass falls by 0.7 %.
    ///
    /// # Errors
    ///
    /// Returns an error if the index is not between 1 and 4.
    pub fn dielectric(index: f64) -> Result<Self, TracerError> {
        check("index", index, 1.0..=4.0, "between 1 and 4")?;
        Ok(Self::new(Scattering::Dielectric(Dielectric { index })))
    }

    /// Makes the back black: light that arrives or leaves below the surface is lost.
    #[must_use]
    pub const fn one_sided(self) -> Self {
        Self {
            one_sided: true,
            ..self
        }
    }

    /// Returns whether light goes into single directions only, which [`sample`](Self::sample) finds.
    pub const fn is_specular(&self) -> bool {
        matches!(
            self.scattering,
            Scattering::Mirror { .. } | Scattering::Polished { .. } | Scattering::Dielectric(_)
        )
    }

    /// Checks that the material is known at a wavelength, in metres.
    ///
    /// Whoever brings a material and a light together does so once; the other methods take the
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
    /// The cosine of `wi` is not included. The value is 0 for specular materials, and where `wo` and
    /// `wi` are on different sides of the surface.
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

    const fn new(scattering: Scattering) -> Self {
        Self {
            scattering,
            one_sided: false,
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
    /// one-sided one.
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

fn rough_facets(roughness: f64) -> Result<Ggx, TracerError> {
    check("roughness", roughness, 0.01..=1.0, "between 0.01 and 1")?;
    Ok(Ggx { alpha: roughness })
}

fn check_reflectance(reflectance: f64) -> Result<(), TracerError> {
    check("reflectance", reflectance, 0.0..=1.0, "between 0 and 1")
}

fn check(
    parameter: &'static str,
    value: f64,
    range: RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), TracerError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(TracerError::OutOfRange {
        parameter,
        value,
        allowed,
    })
}

#[cfg(test)]
mod tests;
