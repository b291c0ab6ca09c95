use core::{
    f64::consts::{PI, TAU},
    fmt,
    ops::RangeInclusive,
};

use super::{Material, Scattering, check};
use crate::TracerError;

/// The circumstances in which a surface has to be rough for speckle theory to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpticalRoughnessQuery {
    /// The vacuum wavelength, in metres.
    pub wavelength: f64,
    /// The angle between the surface normal and the light, in radians.
    pub incidence: f64,
    /// The angle between the surface normal and the camera, in radians.
    pub viewing: f64,
    /// The diameter of what the camera resolves on the surface, in metres.
    pub resolution_cell: f64,
    /// The rms height of the surface, in metres, where it is known.
    pub rms_height: Option<f64>,
}

/// How rough a surface is for light that is scattered from one direction into another.
///
/// Speckle is fully developed where two things hold: heights spread the phase over more than a
/// turn, so that no light is left in step, and what the camera resolves has many patches whose
/// phases are independent.
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
/// says how many patches there are, provided that the surface is high enough.
///
/// # Validity
///
/// The roughness of GGX facets is taken for that of Beckmann's, which has the same slope at the peak
/// of the lobe; GGX has no rms slope of its own. The relations hold for Gaussian surfaces without
/// shadowing. For N patches the variance of the intensity departs from that of fully developed
/// speckle by the order of 1/N.
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

    /// Returns the rms deviation `σ_φ` of the phase of scattered light, in radians, if the rms height
    /// is known.
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

    /// Returns the rms height λ/c, in metres, that spreads the phase by 2π.
    pub fn height_of_a_turn(&self) -> f64 {
        self.query.wavelength / self.cosines
    }

    /// Returns the correlation length 2λ/(αc), in metres, that heights of [this
    /// size](Self::height_of_a_turn) must have for the slope of the surface.
    pub fn height_correlation_length_of_a_turn(&self) -> f64 {
        2.0 * self.height_of_a_turn() / self.roughness
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
    /// Judges whether the surface is rough enough for the theory of speckle, or returns `None` for a
    /// specular material, which makes no speckle.
    ///
    /// Metals are judged by their roughness, plastics by that of their coat, which matters where the
    /// camera sees it shine. Diffuse materials scatter everywhere and count as a roughness of 1.
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
mod tests {
    use super::*;
    use crate::Metal;

    const RED: f64 = 650e-9;

    fn query() -> OpticalRoughnessQuery {
        OpticalRoughnessQuery {
            wavelength: RED,
            incidence: 0.6,
            viewing: 0.2,
            resolution_cell: 9e-6,
            rms_height: None,
        }
    }

    fn of(roughness: f64, query: &OpticalRoughnessQuery) -> OpticalRoughness {
        let metal = Material::conductor(Metal::Iron, roughness).unwrap();
        metal.optical_roughness(query).unwrap().unwrap()
    }

    #[test]
    fn a_quarter_wave_of_height_turns_the_phase_by_pi_at_normal_incidence() {
        let query = OpticalRoughnessQuery {
            incidence: 0.0,
            viewing: 0.0,
            rms_height: Some(RED / 4.0),
            ..query()
        };
        let got = of(0.3, &query);
        // Path there and back: half a wave. exp(−π²) = 5.17e−5.
        assert!(
            (got.phase_deviation().unwrap() - PI).abs() < 1e-14,
            "{got:?}"
        );
        assert!(
            (got.coherent_fraction().unwrap() / 5.172_318_62e-5 - 1.0).abs() < 1e-8,
            "{got:?}"
        );
        // A turn takes four quarters' half: λ/2.
        assert!(
            (got.height_of_a_turn() / (RED / 2.0) - 1.0).abs() < 1e-14,
            "{got:?}"
        );
    }

    /// The mean of exp(iφ) over Gaussian phases, by quadrature over the heights.
    #[test]
    fn the_coherent_fraction_is_what_gaussian_heights_leave_in_step() {
        for height in [20e-9, 80e-9, 150e-9] {
            let got = of(
                0.3,
                &OpticalRoughnessQuery {
                    rms_height: Some(height),
                    ..query()
                },
            );
            let per_metre = TAU / RED * (0.6_f64.cos() + 0.2_f64.cos());
            let mean: f64 = (-8000..=8000_i32)
                .map(|i| {
                    let x = f64::from(i) * 1e-3;
                    let density = (-0.5 * x * x).exp() / TAU.sqrt() * 1e-3;
                    density * (per_metre * height * x).cos()
                })
                .sum();
            let fraction = got.coherent_fraction().unwrap();
            // The trapezoidal rule is exact to the cut tails, exp(−32), and 16001 roundings.
            assert!(
                (fraction - mean * mean).abs() < 1e-12,
                "{height}: {fraction}"
            );
        }
    }

    /// The correlation of light behind a Gaussian phase screen, `exp(−σ_φ² (1 − ρ(r)))`.
    #[test]
    fn light_behind_a_rough_surface_decorrelates_within_the_correlation_length() {
        for roughness in [0.02, 0.3] {
            let height = 10.0 * of(roughness, &query()).height_of_a_turn();
            let got = of(
                roughness,
                &OpticalRoughnessQuery {
                    rms_height: Some(height),
                    ..query()
                },
            );
            let deviation = got.phase_deviation().unwrap();
            // The rms slope of a height correlation exp(−r²/ℓ²) is √2 σ_h/ℓ, and Beckmann's α is √2
            // times that.
            let length = 2.0 * height / roughness;
            let heights = (-(got.correlation_length() / length).powi(2)).exp();
            let light = (-deviation * deviation * (1.0 - heights)).exp();
            // The parabola of the correlation errs by 1/(2σ_φ²) of the exponent, 1/7900.
            assert!((light / (-1.0_f64).exp() - 1.0).abs() < 1.3e-4, "{light}");
        }
    }

    #[test]
    fn a_phase_of_a_turn_stretches_the_heights_by_two_pi() {
        let got = of(0.02, &query());
        let ratio = got.height_correlation_length_of_a_turn() / got.correlation_length();
        assert!((ratio / TAU - 1.0).abs() < 1e-14, "{ratio}");
        // The slope of heights of a turn: √2 σ_h/ℓ = α/√2.
        let slope =
            2.0_f64.sqrt() * got.height_of_a_turn() / got.height_correlation_length_of_a_turn();
        assert!((slope * 2.0_f64.sqrt() - 0.02).abs() < 1e-16, "{slope}");
    }

    /// N = A² / ∫∫ |μ|² over a large cell of area A, whose light correlates as `exp(−r²/r_c²)`.
    #[test]
    fn patches_are_the_area_over_the_area_of_correlation() {
        let got = of(0.3, &query());
        let area = PI / 4.0 * 9e-6 * 9e-6;
        let r_c = got.correlation_length();
        let rings = 4000;
        let step = 5.0 * r_c / f64::from(rings);
        let correlated: f64 = (0..rings)
            .map(|i| {
                let r = (f64::from(i) + 0.5) * step;
                TAU * r * step * (-2.0 * (r / r_c).powi(2)).exp()
            })
            .sum();
        // The midpoint rule errs by (5/4000)² / 24 of derivatives of order 10.
        assert!(
            (got.patches() * correlated / area - 1.0).abs() < 1e-6,
            "{got:?}"
        );
    }

    #[test]
    fn smooth_or_flat_surfaces_are_told_apart() {
        let flat = OpticalRoughnessQuery {
            rms_height: Some(50e-9),
            ..query()
        };
        let high = OpticalRoughnessQuery {
            rms_height: Some(1e-6),
            ..query()
        };
        assert!(of(0.3, &query()).is_fully_developed(), "rough");
        assert!(of(0.3, &high).is_fully_developed(), "rough and high");
        assert!(!of(0.3, &flat).is_fully_developed(), "flat");
        assert!(!of(0.02, &high).is_fully_developed(), "smooth");
        assert!(
            of(0.3, &flat)
                .to_string()
                .ends_with("50 nm leaves 46.70 % of the light in step"),
            "{}",
            of(0.3, &flat)
        );
    }

    #[test]
    fn only_rough_materials_are_judged() {
        let roughness = |material: Material| {
            let judged = material.optical_roughness(&query()).unwrap();
            judged.map(|judged| judged.roughness())
        };
        assert_eq!(roughness(Material::mirror(0.9).unwrap()), None, "mirror");
        assert_eq!(
            roughness(Material::polished(Metal::Gold).unwrap()),
            None,
            "metal"
        );
        assert_eq!(roughness(Material::dielectric(1.5).unwrap()), None, "glass");
        assert_eq!(
            roughness(Material::lambertian(0.5).unwrap()),
            Some(1.0),
            "paper"
        );
        assert_eq!(
            roughness(Material::oren_nayar(0.5, 0.3).unwrap()),
            Some(1.0),
            "plaster"
        );
        assert_eq!(
            roughness(Material::plastic(0.5, 1.5, 0.1).unwrap()),
            Some(0.1),
            "plastic"
        );
    }

    #[test]
    fn impossible_circumstances_are_refused() {
        let material = Material::lambertian(0.5).unwrap();
        for (name, bad) in [
            (
                "wavelength",
                OpticalRoughnessQuery {
                    wavelength: 650.0,
                    ..query()
                },
            ),
            (
                "incidence",
                OpticalRoughnessQuery {
                    incidence: 1.6,
                    ..query()
                },
            ),
            (
                "viewing",
                OpticalRoughnessQuery {
                    viewing: f64::NAN,
                    ..query()
                },
            ),
            (
                "resolution_cell",
                OpticalRoughnessQuery {
                    resolution_cell: 0.0,
                    ..query()
                },
            ),
            (
                "rms_height",
                OpticalRoughnessQuery {
                    rms_height: Some(-1e-6),
                    ..query()
                },
            ),
        ] {
            let result = material.optical_roughness(&bad);
            assert!(
                matches!(result, Err(TracerError::OutOfRange { parameter, .. }) if parameter == name),
                "{name}: {result:?}"
            );
        }
    }
}
