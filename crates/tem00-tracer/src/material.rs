mod ggx;

use core::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

use self::ggx::Ggx;
use crate::{Metal, TracerError, metal::fresnel_reflectance};

/// How a surface reflects light.
///
/// Directions are unit vectors in a [local frame](crate::LocalFrame) whose z axis is the normal, and
/// point away from the surface: `wo` to where the light goes, `wi` to where it comes from.
/// Materials are isotropic, opaque and alike on both sides: what holds above the surface holds
/// mirrored below it, and no light passes from one side to the other. Wavelengths are in metres, in
/// vacuum.
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
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    reflection: Reflection,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Reflection {
    Lambertian { reflectance: f64 },
    Conductor { metal: Metal, facets: Ggx },
}

/// A direction drawn from a material, with what an estimator needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The drawn direction, of unit length, in the local frame.
    pub wi: DVec3,
    /// The BRDF times |cos θ| of `wi`, divided by `pdf`.
    pub weight: f64,
    /// The density with which `wi` is drawn, per steradian.
    pub pdf: f64,
}

impl Material {
    /// Creates a material that looks equally bright from every side and reflects the fraction
    /// `reflectance` of the power that falls on it, at every wavelength.
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1.
    pub fn lambertian(reflectance: f64) -> Result<Self, TracerError> {
        if !(0.0..=1.0).contains(&reflectance) {
            return Err(TracerError::OutOfRange {
                parameter: "reflectance",
                value: reflectance,
                allowed: "between 0 and 1",
            });
        }
        Ok(Self {
            reflection: Reflection::Lambertian { reflectance },
        })
    }

    /// Creates a rough metal: microfacets with the GGX distribution of slopes.
    ///
    /// `roughness` is the parameter α: facets over half of the surface are inclined by less than
    /// arctan α. The reflectance of each facet is Fresnel's, without approximation. Light that would
    /// meet a second facet is lost, as in all single-scattering models.
    ///
    /// # Errors
    ///
    /// Returns an error if the roughness is not between 0.01 and 1, or if the index of a custom
    /// metal is impossible. A smoother surface is a mirror with a lobe of about 1°, too narrow for
    /// light and camera to meet in it by chance.
    ///
    /// # References
    ///
    /// - B. Walter et al., *Microfacet Models for Refraction through Rough Surfaces*, 2007, eq. 33.
    /// - E. Heitz, *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*, 2014,
    ///   eq. 72 and 99.
    /// - E. Heitz, *Sampling the GGX Distribution of Visible Normals*, 2018.
    pub fn conductor(metal: Metal, roughness: f64) -> Result<Self, TracerError> {
        metal.check_index()?;
        if !(0.01..=1.0).contains(&roughness) {
            return Err(TracerError::OutOfRange {
                parameter: "roughness",
                value: roughness,
                allowed: "between 0.01 and 1",
            });
        }
        Ok(Self {
            reflection: Reflection::Conductor {
                metal,
                facets: Ggx { alpha: roughness },
            },
        })
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
        match self.reflection {
            Reflection::Lambertian { .. } => Ok(()),
            Reflection::Conductor { metal, .. } => metal.check_wavelength(wavelength),
        }
    }

    /// Returns the bidirectional reflectance distribution function, in 1/sr.
    ///
    /// The cosine of `wi` is not included. The value is 0 where `wo` and `wi` are on different
    /// sides of the surface.
    pub fn evaluate(&self, wo: DVec3, wi: DVec3, wavelength: f64) -> f64 {
        let Some((wo, wi)) = same_side(wo, wi) else {
            return 0.0;
        };
        match self.reflection {
            Reflection::Lambertian { reflectance } => reflectance * FRAC_1_PI,
            Reflection::Conductor { metal, facets } => {
                let facet = (wo + wi).normalize();
                let index = metal.nearest_refractive_index(wavelength);
                let reflectance = fresnel_reflectance(wi.dot(facet).min(1.0), index);
                reflectance * facets.density(facet) * facets.visibility(wo, wi)
            }
        }
    }

    /// Draws a direction from two uniform numbers in [0, 1).
    ///
    /// Lambertian materials draw in proportion to the cosine, conductors from the facets that `wo`
    /// sees. Returns `None` where the drawn facet reflects to the other side of the surface: such a
    /// path carries nothing.
    pub fn sample(&self, wo: DVec3, u: [f64; 2], wavelength: f64) -> Option<BsdfSample> {
        let above = facing_up(wo)?;
        let mut sample = match self.reflection {
            Reflection::Lambertian { reflectance } => sample_cosine(reflectance, u),
            Reflection::Conductor { metal, facets } => {
                let facet = facets.sample_visible(above, u);
                let wi = 2.0 * above.dot(facet) * facet - above;
                same_side(above, wi)?;
                let index = metal.nearest_refractive_index(wavelength);
                let reflectance = fresnel_reflectance(wi.dot(facet).clamp(0.0, 1.0), index);
                BsdfSample {
                    wi,
                    weight: reflectance * facets.masking_ratio(above, wi),
                    pdf: facets.reflected_pdf(above, facet),
                }
            }
        };
        if wo.z < 0.0 {
            sample.wi = -sample.wi;
        }
        Some(sample)
    }

    /// Returns the density with which [`sample`](Self::sample) draws `wi`, per steradian.
    pub fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some((wo, wi)) = same_side(wo, wi) else {
            return 0.0;
        };
        match self.reflection {
            Reflection::Lambertian { .. } => wi.z * FRAC_1_PI,
            Reflection::Conductor { facets, .. } => facets.reflected_pdf(wo, (wo + wi).normalize()),
        }
    }
}

fn sample_cosine(reflectance: f64, [u, v]: [f64; 2]) -> BsdfSample {
    let radius = u.sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    let cosine = (1.0 - u).sqrt();
    BsdfSample {
        wi: DVec3::new(radius * cos, radius * sin, cosine),
        weight: reflectance,
        pdf: cosine * FRAC_1_PI,
    }
}

/// Returns both directions as if seen from above, or `None` unless they are on one side.
fn same_side(wo: DVec3, wi: DVec3) -> Option<(DVec3, DVec3)> {
    (wo.z * wi.z > 0.0).then(|| if wo.z > 0.0 { (wo, wi) } else { (-wo, -wi) })
}

/// Returns the direction as if seen from above, or `None` for one along the surface.
fn facing_up(wo: DVec3) -> Option<DVec3> {
    (wo.z != 0.0).then(|| if wo.z > 0.0 { wo } else { -wo })
}

#[cfg(test)]
mod tests;
