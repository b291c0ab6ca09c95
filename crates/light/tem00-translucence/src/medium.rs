use core::array;

use tem00_numerics::{Refusal, check};

/// Homogeneous half space that scatters and absorbs light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    refractive_index: f64,
    reduced_scattering: f64,
    absorption: f64,
    anisotropy: f64,
    slope: f64,
}

impl Medium {
    /// Creates a medium that scatters isotropically.
    ///
    /// The reduced scattering coefficient µs′ = µs (1 − g) and the absorption coefficient µa are in
    /// 1/m.
    ///
    /// # Errors
    ///
    /// Returns an error unless the refractive index is from 1 to 3, µs′ from 1/m to 10⁸/m, and µa
    /// from a millionth of µs′ to a hundred times µs′: without absorption a path has no mean
    /// length.
    pub fn new(
        refractive_index: f64,
        reduced_scattering: f64,
        absorption: f64,
    ) -> Result<Self, Refusal> {
        let relative = [1e-6, 1e2].map(|factor| factor * reduced_scattering);
        Ok(Self {
            refractive_index: check::range("refractive_index", refractive_index, [1.0, 3.0], "")?,
            reduced_scattering: check::range(
                "reduced_scattering",
                reduced_scattering,
                [1.0, 1e8],
                "1/m",
            )?,
            absorption: check::range("absorption", absorption, relative, "1/m")?,
            anisotropy: 0.0,
            slope: 0.0,
        })
    }

    /// Returns the medium with the same µs′ and the mean cosine g of the scattering angle, by the
    /// phase function of Henyey and Greenstein.
    ///
    /// # Errors
    ///
    /// Returns an error unless g is from −0.95 to 0.95.
    pub fn with_anisotropy(self, g: f64) -> Result<Self, Refusal> {
        let anisotropy = check::range("anisotropy", g, [-0.95, 0.95], "")?;
        Ok(Self { anisotropy, ..self })
    }

    /// Returns the medium with a matt boundary: facets of normally distributed slopes, which light
    /// meets on its way in and out, without masking. The root mean square of the slopes along each
    /// axis is `slope`.
    ///
    /// # Errors
    ///
    /// Returns an error unless the slope is from 0 to 0.5: on steeper facets masking counts.
    pub fn with_matt_boundary(self, slope: f64) -> Result<Self, Refusal> {
        let slope = check::range("slope", slope, [0.0, 0.5], "")?;
        Ok(Self { slope, ..self })
    }

    /// Returns the root mean square slope of the facets of the boundary.
    pub(crate) const fn slope(&self) -> f64 {
        self.slope
    }

    /// Returns the refractive index n.
    pub const fn refractive_index(&self) -> f64 {
        self.refractive_index
    }

    /// Returns the transport length ℓ* = 1/µs′, in metres.
    pub fn transport_length(&self) -> f64 {
        1.0 / self.reduced_scattering
    }

    /// Returns the absorption coefficient µa, in 1/m.
    pub const fn absorption(&self) -> f64 {
        self.absorption
    }

    /// Returns the mean cosine g of the scattering angle.
    pub const fn anisotropy(&self) -> f64 {
        self.anisotropy
    }

    /// Returns the extinction coefficient µt = µs′/(1 − g) + µa, in 1/m.
    pub fn extinction(&self) -> f64 {
        self.reduced_scattering / (1.0 - self.anisotropy) + self.absorption
    }

    /// Returns the fraction of the light that a collision scatters: µs/µt.
    pub fn scattered_fraction(&self) -> f64 {
        1.0 - self.absorption / self.extinction()
    }

    /// Returns the shift of the centre of a line without absorption, in metres:
    /// ℓ* (sin θi + sin θo)/n.
    ///
    /// Positive along the direction in which the laser travels across the surface. Absorption makes
    /// the shift shorter.
    ///
    /// Wang and Jacques, Appl. Opt. 34, 2362 (1995), for the way in; reciprocity for the way out.
    pub fn shift_without_absorption(&self, incidence: f64, exit: f64) -> f64 {
        let sines = libm::sin(incidence) + libm::sin(exit);
        self.transport_length() * sines / self.refractive_index
    }

    /// Returns the reflectance of the boundary from inside, for the cosine of the angle there; both
    /// polarisations averaged, 1 beyond the critical angle.
    ///
    /// Fresnel's equations.
    pub fn reflectance_from_inside(&self, cosine: f64) -> f64 {
        let n = self.refractive_index;
        let outside = 1.0 - n * n * (1.0 - cosine * cosine);
        if outside <= 0.0 {
            return 1.0;
        }
        let outside = outside.sqrt();
        let across = (n * cosine - outside) / (n * cosine + outside);
        let along = (cosine - n * outside) / (cosine + n * outside);
        0.5 * (across * across + along * along)
    }

    /// Returns the direction below a facet of light that meets it, and the fraction of the light
    /// that takes it there, in units of what meets the boundary; `None` if none does.
    ///
    /// z is down, and the facet's normal is along (p, q, 1). A facet catches light in proportion
    /// to its area across the direction of the light.
    pub(crate) fn refracted(
        &self,
        direction: [f64; 3],
        [p, q]: [f64; 2],
    ) -> Option<([f64; 3], f64)> {
        let length = (1.0 + p * p + q * q).sqrt();
        let normal = [p / length, q / length, 1.0 / length];
        let cosine = dot(direction, normal);
        if cosine <= 0.0 {
            return None;
        }
        let n = self.refractive_index;
        let inside = (1.0 - (1.0 - cosine * cosine) / (n * n)).sqrt();
        let along = inside - cosine / n;
        let refracted = array::from_fn(|i| direction[i] / n + along * normal[i]);
        let caught = cosine * length / direction[2];
        let transmitted = 1.0 - self.reflectance_from_inside(inside);
        (refracted[2] > 0.0).then_some((refracted, caught * transmitted))
    }

    /// Returns the density of scattered directions in 1/sr, for the cosine of the scattering angle:
    /// Henyey and Greenstein, Astrophys. J. 93, 70 (1941).
    pub(crate) fn phase(&self, cosine: f64) -> f64 {
        let g = self.anisotropy;
        let base = 1.0 + g * g - 2.0 * g * cosine;
        (1.0 - g * g) / (4.0 * core::f64::consts::PI * base * base.sqrt())
    }

    /// Returns the cosine of a scattering angle, for a uniform number.
    pub(crate) fn scattering_cosine(&self, uniform: f64) -> f64 {
        let g = self.anisotropy;
        if g == 0.0 {
            return 1.0 - 2.0 * uniform;
        }
        let ratio = (1.0 - g * g) / (1.0 - g + 2.0 * g * uniform);
        ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0)
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
