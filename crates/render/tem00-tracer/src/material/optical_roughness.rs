use core::{
    f64::consts::{PI, TAU},
    fmt,
    ops::RangeInclusive,
};

use super::{Material, Scattering};
use crate::{TracerError, error::check};

/// The conditions under which a surface has to be rough for speckle theory to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalRoughnessQuery {
    /// The vacuum wavelength, in metres.
    pub wavelength: f64,
    /// The angle between the surface normal and the light, in radians.
    pub incidence: f64,
    /// The angle between the surface normal and the camera, in radians.
    pub viewing: f64,
    /// The diameter of the resolution cell of the camera on the surface, in metres.
    pub resolution_cell: f64,
    /// The rms height of the surface, in metres, where it is known.
    pub rms_height: Option<f64>,
}

/// Optical roughness of a surface for light that is scattered from one direction into another.
///
/// Speckle is fully developed where two things hold: heights spread the phase over more than a
/// turn, so that no light is left in step, and a resolution cell of the camera has many patches
/// whose phases are independent.
///
/// With `c = cos θi + cos θo`, the rms height `σ_h`, and the height correlation `exp(−r²/ℓ²)` of a
/// Gaussian surface with the roughness α:
///
/// ```text
/// σ_φ = 2π c σ_h / λ                 rms phase
/// exp(−σ_φ²)                         fraction of the light that stays in step
/// ℓ   = 2 σ_h / α                    correlation length of the heights, from the rms slope α/√2
/// r_c = ℓ / σ_φ = λ / (π α c)        correlation length of the light, for σ_φ well above 1
/// N   = (d / r_c)² / 2               independent patches in a resolution cell of diameter d
/// ```
///
/// The light's correlation length does not depend on the height: where only α is known, it alone
/// determines the number of patches, provided that the surface is high enough.
///
/// # Validity
///
/// GGX has no rms slope: its roughness is taken as the roughness of Beckmann's facets, whose lobe
/// has the same height, and whose light is therefore correlated over the same area. The relations
/// hold for Gaussian surfaces without shadowing. For N patches the variance of the intensity
/// departs from its value for fully developed speckle by the order of 1/N.
///
/// # Examples
///
/// ```
/// use tem00_tracer::{Material, Metal, OpticalRoughnessQuery};
///
/// let plate = Material::conductor(Metal::Iron, 0.02)?;
/// let roughness = plate
///     .optical_roughness(&OpticalRoughnessQuery {
///         wavelength: 650e-9,
///         incidence: 0.0,
///         viewing: 0.0,
///         resolution_cell: 9e-6,
///         rms_height: None,
///     })?
///     .ok_or("not a mirror")?;
///
/// // Too smooth: 1.5 patches in what the camera resolves.
/// assert!((roughness.correlation_length() - 5.17e-6).abs() < 0.01e-6);
/// assert!((roughness.patches() - 1.51).abs() < 0.01);
/// assert!(!roughness.is_fully_developed());
/// assert_eq!(
///     roughness.to_string(),
///     "roughness 0.02: light decorrelates within 5.17 µm at 650 nm, a resolution cell of 9.00 µm \
///      has 1.5 patches of the 20 it needs",
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
///
/// - P. Beckmann and A. Spizzichino, *The Scattering of Electromagnetic Waves from Rough Surfaces*,
///   1963, ch. 5.
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalRoughness {
    query: OpticalRoughnessQuery,
    roughness: f64,
    cosines: f64,
}

impl OpticalRoughness {
    /// The patches that a resolution cell needs: with 20 the contrast is right to some 3 %.
    pub const MINIMUM_PATCHES: f64 = 20.0;

    /// The largest fraction of light in step that leaves speckle fully developed.
    pub const MAXIMUM_COHERENT_FRACTION: f64 = 0.01;

    /// Returns the roughness α that the surface was judged by.
    pub const fn roughness(&self) -> f64 {
        self.roughness
    }

    /// Returns the rms deviation `σ_φ` of the phase of scattered light, in radians, if the rms
    /// height is known.
    pub fn phase_deviation(&self) -> Option<f64> {
        let turns_per_height = self.cosines / self.query.wavelength;
        self.query
            .rms_height
            .map(|height| TAU * turns_per_height * height)
    }

    /// Returns the fraction `exp(−σ_φ²)` of the scattered light that stays in step, as from a
    /// mirror, if the rms height is known.
    pub fn coherent_fraction(&self) -> Option<f64> {
        self.phase_deviation()
            .map(|deviation| (-deviation * deviation).exp())
    }

    /// Returns the distance `r_c`, in metres, at which the correlation of the scattered light along
    /// the surface has fallen to 1/e.
    pub fn correlation_length(&self) -> f64 {
        self.query.wavelength / (PI * self.roughness * self.cosines)
    }

    /// Returns the number N of independent patches in a resolution cell.
    pub fn patches(&self) -> f64 {
        let ratio = self.query.resolution_cell / self.correlation_length();
        0.5 * ratio * ratio
    }

    /// Returns whether speckle theory holds: enough [patches](Self::patches), and hardly any light
    /// [in step](Self::coherent_fraction) if the rms height is known.
    pub fn is_fully_developed(&self) -> bool {
        self.patches() >= Self::MINIMUM_PATCHES
            && self
                .coherent_fraction()
                .is_none_or(|fraction| fraction <= Self::MAXIMUM_COHERENT_FRACTION)
    }
}

impl fmt::Display for OpticalRoughness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "roughness {}: light decorrelates within {:.2} µm at {:.0} nm, a resolution cell of \
             {:.2} µm has {:.1} patches of the {} it needs",
            self.roughness,
            self.correlation_length() * 1e6,
            self.query.wavelength * 1e9,
            self.query.resolution_cell * 1e6,
            self.patches(),
            Self::MINIMUM_PATCHES,
        )?;
        if let (Some(height), Some(fraction)) = (self.query.rms_height, self.coherent_fraction()) {
            write!(
                f,
                "; an rms height of {:.0} nm leaves {:.2} % of the light in step",
                height * 1e9,
                fraction * 100.0,
            )?;
        }
        Ok(())
    }
}

impl Material {
    /// Judges whether the surface is rough enough for the theory of speckle, or returns `None` for
    /// a specular material, which makes no speckle.
    ///
    /// Metals are judged by their roughness, plastics by the roughness of their coat, which matters
    /// where the camera sees it shine. Diffuse materials scatter everywhere and count as a
    /// roughness of 1.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 1 nm and 1 mm, an angle not between 0 and
    /// 1.57 rad, the resolution cell not between 1 nm and 1 km, or the rms height not between 0 and
    /// 1 m.
    pub fn optical_roughness(
        &self,
        query: &OpticalRoughnessQuery,
    ) -> Result<Option<OpticalRoughness>, TracerError> {
        query.check()?;
        let roughness = match &self.scattering {
            Scattering::Lambertian { .. } | Scattering::OrenNayar(_) => 1.0,
            Scattering::Conductor(metal) => metal.facets.alpha,
            Scattering::Plastic(plastic) => plastic.roughness(),
            Scattering::Mirror { .. } | Scattering::Polished { .. } | Scattering::Dielectric(_) => {
                return Ok(None);
            }
        };
        Ok(Some(OpticalRoughness {
            query: *query,
            roughness,
            cosines: query.incidence.cos() + query.viewing.cos(),
        }))
    }
}

impl OpticalRoughnessQuery {
    fn check(&self) -> Result<(), TracerError> {
        const ANGLES: RangeInclusive<f64> = 0.0..=1.57;
        let angles = "between 0 and 1.57 rad";
        check(
            "wavelength",
            self.wavelength,
            1e-9..=1e-3,
            "between 1e-9 m and 1e-3 m",
        )?;
        check("incidence", self.incidence, ANGLES, angles)?;
        check("viewing", self.viewing, ANGLES, angles)?;
        check(
            "resolution_cell",
            self.resolution_cell,
            1e-9..=1e3,
            "between 1e-9 m and 1e3 m",
        )?;
        let height = self.rms_height.unwrap_or(0.0);
        check("rms_height", height, 0.0..=1.0, "between 0 m and 1 m")
    }
}

#[cfg(test)]
mod tests;
