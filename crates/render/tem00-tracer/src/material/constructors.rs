use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use tem00_translucence::Medium;

use super::{
    Material, Scattering, conductor::Conductor, dielectric::Dielectric, ggx::Ggx,
    oren_nayar::OrenNayar, plastic::Plastic,
};
use crate::{Metal, TracerError, error::check};

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
    /// - J. Portsmouth, P. Kutz and S. Hill, *EON: A Practical Energy-Preserving Rough Diffuse
    ///   BRDF*, 2025.
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
    /// arctan α. The reflectance of each facet is Fresnel's, without approximation. Light that
    /// would meet a second facet is lost, as in all single-scattering models.
    ///
    /// # Validity
    ///
    /// A metal that absorbs nothing would lose this fraction of light from everywhere to second
    /// facets:
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
    /// over a diffuse base that reflects the fraction `reflectance` of the light that reaches it.
    ///
    /// `roughness` is the parameter α of [`conductor`](Self::conductor). Light that the first facet
    /// does not reflect enters the coat; the base and the inner side of the coat pass it to and fro
    /// until it is absorbed or leaves. A white base loses nothing. A grey one looks darker than it
    /// is: with an index of 1.5 and a nearly smooth coat, a base of 0.5 returns 0.29 of the light
    /// that enters.
    ///
    /// # Validity
    ///
    /// The coat absorbs nothing and is thin compared with the resolution of the image. Energy is
    /// kept to 3e-4.
    ///
    /// # Examples
    ///
    /// ```
    /// use glam::DVec3;
    /// use tem00_tracer::Material;
    ///
    /// let lacquer = Material::plastic(0.0, 1.5, 0.1)?;
    /// // Seen head-on, facets reflect 4 % into a lobe of the density 1 / (π α²): F D / 4.
    /// let highlight = lacquer.evaluate(DVec3::Z, DVec3::Z, 650e-9);
    /// assert!((highlight - 0.04 / (4.0 * core::f64::consts::PI * 0.01)).abs() < 1e-12);
    /// # Ok::<(), tem00_tracer::TracerError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the reflectance is not between 0 and 1, the index not between 1.1 and 3,
    /// or the roughness not between 0.01 and 1.
    ///
    /// # References
    ///
    /// - C. Kelemen and L. Szirmay-Kalos, *A Microfacet Based Coupled Specular-Matte BRDF Model
    ///   with Importance Sampling*, 2001.
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

    /// Creates a body that lets light in, such as plastic, ceramic, marble or skin: light of a
    /// laser that enters it leaves it beside the place of entry.
    ///
    /// `roughness` is the parameter α of the facets of its boundary, which reflect light as the
    /// coat of [`plastic`](Self::plastic) does, and refract it on its way in and out with normal
    /// slopes of the root mean square α/√2 along each axis.
    ///
    /// # Validity
    ///
    /// Light that a laser sends straight to the first rough surface before the camera is spread
    /// exactly, as on a plane: radii of curvature must be large against the transport length, and
    /// walls thick. All other light leaves where it entered, diffusely and in the same amount.
    ///
    /// # Errors
    ///
    /// Returns an error if the roughness is not between 0.01 and 0.7.
    pub fn translucent(medium: Medium, roughness: f64) -> Result<Self, TracerError> {
        check("roughness", roughness, 0.01..=0.7, "between 0.01 and 0.7")?;
        let medium = medium.with_matt_boundary(roughness * FRAC_1_SQRT_2)?;
        let facets = Ggx { alpha: roughness };
        let plastic = Plastic::over(medium, facets)?;
        Ok(Self::new(Scattering::Plastic(plastic)))
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
    /// # Examples
    ///
    /// ```
    /// use glam::DVec3;
    /// use tem00_tracer::{Material, Metal};
    ///
    /// let mirror = Material::polished(Metal::Silver)?;
    /// let sample = mirror.sample(DVec3::Z, [0.5, 0.5], 650e-9).ok_or("nothing to draw")?;
    /// assert!(sample.specular && sample.weight > 0.98);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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
    /// is absorbed. The index is the same at every wavelength: a path is then the same for all
    /// lasers of a scene, and every light costs one path. Take the index at the laser's wavelength;
    /// the index of crown glass falls by 0.7 % from 450 nm to 650 nm.
    ///
    /// # Examples
    ///
    /// Light that enters glass is bent towards the normal and its radiance rises by n²:
    ///
    /// ```
    /// use glam::DVec3;
    /// use tem00_tracer::Material;
    ///
    /// let glass = Material::dielectric(1.5)?;
    /// let (sin, cos) = 30_f64.to_radians().sin_cos();
    /// // Seen from inside, light comes from outside.
    /// let inside = DVec3::new(-sin, 0.0, -cos);
    /// let sample = glass.sample(inside, [0.9, 0.5], 650e-9).ok_or("nothing to draw")?;
    /// assert!((sample.wi.x - 0.75).abs() < 1e-15); // 1.5 sin 30°
    /// assert!((sample.weight - 2.25).abs() < 1e-15);
    /// // Power that leaves the glass this way keeps its amount.
    /// assert!((sample.weight * sample.eta_squared - 1.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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

    const fn new(scattering: Scattering) -> Self {
        Self {
            scattering,
            one_sided: false,
        }
    }
}

fn rough_facets(roughness: f64) -> Result<Ggx, TracerError> {
    check("roughness", roughness, 0.01..=1.0, "between 0.01 and 1")?;
    Ok(Ggx { alpha: roughness })
}

fn check_reflectance(reflectance: f64) -> Result<(), TracerError> {
    check("reflectance", reflectance, 0.0..=1.0, "between 0 and 1")
}
