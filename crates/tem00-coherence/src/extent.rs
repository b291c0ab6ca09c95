use core::f64::consts::{PI, TAU};

use glam::DVec3;
use tem00_numerics::{disc_overlap, quadrature::for_each_node};

use crate::{CoherenceError, PolychromaticSpeckle};

/// The directions from which the light of a source reaches the surface: those of its transverse modes, of the points of
/// a lamp or a fibre, or of a diffuser that moves many times while the detector integrates.
///
/// Lights of different directions do not interfere: the detector adds their intensities, as it adds those of wave
/// numbers. For [`PolychromaticSpeckle::contrast_of`].
///
/// # Validity
///
/// Discs and Gaussians are small against a radian: to first order in the angle, errors are of the order of its square.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceExtent {
    directions: Directions,
}

#[derive(Clone, Debug, PartialEq)]
enum Directions {
    Disc { half_angle: f64 },
    Gaussian { spread: f64 },
    List(Vec<(DVec3, f64)>),
}

/// The largest angles of discs and Gaussians, in radians.
const MAX_ANGLE: f64 = 0.3;

/// Beyond so many standard deviations of a difference a Gaussian ends, at 2e-11 of its light.
const GAUSSIAN_REACH: f64 = 7.0;

/// Directions of differences on half a turn; the other half is alike.
const AZIMUTHS: i32 = 64;

impl SourceExtent {
    /// A disc about the direction to the source, equally bright, of this half-angle in radians as seen from the surface.
    ///
    /// # Errors
    ///
    /// Returns an error unless the angle is from 0 to 0.3.
    pub fn disc(half_angle: f64) -> Result<Self, CoherenceError> {
        check_angle("half_angle", half_angle)?;
        Ok(Self {
            directions: Directions::Disc { half_angle },
        })
    }

    /// A round Gaussian about the direction to the source, of this standard deviation along each axis, in radians as
    /// seen from the surface.
    ///
    /// # Errors
    ///
    /// Returns an error unless the angle is from 0 to 0.3.
    pub fn gaussian(standard_deviation: f64) -> Result<Self, CoherenceError> {
        check_angle("standard_deviation", standard_deviation)?;
        Ok(Self {
            directions: Directions::Gaussian {
                spread: standard_deviation,
            },
        })
    }

    /// Single directions from the surface to the source, of any length, each with its share of the light; shares are
    /// scaled to the sum 1.
    ///
    /// # Errors
    ///
    /// Returns an error if a direction has no length, a share is negative or not finite, or all are 0.
    pub fn directions(list: &[(DVec3, f64)]) -> Result<Self, CoherenceError> {
        let total: f64 = list.iter().map(|(_, share)| share).sum();
        let allowed = "not negative, finite, and not all 0";
        let refused = |share| CoherenceError::refused("share", share, allowed);
        if !(total > 0.0 && total.is_finite()) {
            return Err(refused(total));
        }
        let unit = |&(direction, share): &(DVec3, f64)| {
            let unit = direction.try_normalize();
            let unit = unit.ok_or(CoherenceError::Direction {
                parameter: "direction",
                value: direction,
                allowed: "finite and not zero",
            })?;
            if share < 0.0 {
                return Err(refused(share));
            }
            Ok((unit, share / total))
        };
        Ok(Self {
            directions: Directions::List(list.iter().map(unit).collect::<Result<_, _>>()?),
        })
    }

    /// Visits the differences of two directions of the light, as vectors in radians about the direction `to_source`,
    /// each with its probability; `feature` is the smallest difference that matters.
    fn for_each_difference(
        &self,
        to_source: DVec3,
        feature: f64,
        mut visit: impl FnMut(DVec3, f64),
    ) {
        let mut rings = |end: f64, density: &dyn Fn(f64) -> f64| {
            if end == 0.0 {
                visit(DVec3::ZERO, 1.0);
                return;
            }
            let (first, second) = to_source.any_orthonormal_pair();
            for_each_node([0.0, end], feature.min(0.25 * end), |radius, weight| {
                let share = weight * TAU * radius * density(radius) / f64::from(AZIMUTHS);
                for azimuth in 0..AZIMUTHS {
                    let angle = PI * (f64::from(azimuth) + 0.5) / f64::from(AZIMUTHS);
                    visit(radius * (angle.cos() * first + angle.sin() * second), share);
                }
            });
        };
        match &self.directions {
            Directions::Disc { half_angle } => rings(2.0 * half_angle, &|radius| {
                disc_overlap(0.5 * radius / half_angle) / (PI * half_angle * half_angle)
            }),
            Directions::Gaussian { spread } => {
                let variance = 2.0 * spread * spread;
                rings(GAUSSIAN_REACH * variance.sqrt(), &|radius| {
                    (-0.5 * radius * radius / variance).exp() / (TAU * variance)
                });
            }
            Directions::List(list) => {
                for (first, share) in list {
                    for (second, other) in list {
                        visit(first - second, share * other);
                    }
                }
            }
        }
    }
}

impl PolychromaticSpeckle<'_> {
    /// Returns the contrast under a source of finite extent, in focus.
    ///
    /// ```text
    /// C² = ⟨ ∫ R(κ) chat²(|κ v + k w| / κ_t|v|) exp(−(κ q + k p)² R_q²) dκ ⟩     over pairs of directions l_S, l_S'
    /// w = δ − p n,   p = δ·l / n·l,   δ = l_S − l_S'
    /// ```
    ///
    /// A change δ of the direction to the source displaces the field across the pupil, by w of its distance, as a change
    /// of the wave number does, by κ v / k; and it changes the phases of heights. In the plane of incidence
    /// `|w| = |δ| cos θᵢ / cos θₒ`, across it `|w| = |δ|`.
    ///
    /// # Validity
    ///
    /// That of the cell and of the extent; in focus; of the relief without its correlation length. All light of one
    /// direction is coherent over the resolution cell, and lights of two are not with each other.
    ///
    /// # Examples
    ///
    /// A fibre of 0.4 mm at 100 mm, head-on, before a lens of sin u = 0.01:
    ///
    /// ```
    /// use tem00_coherence::{
    ///     CellGeometry, DVec3, PolychromaticSpeckle, ResolutionCell, SourceExtent, SpectralLine,
    /// };
    ///
    /// let cell = ResolutionCell::new(CellGeometry {
    ///     to_source: DVec3::Z,
    ///     to_pupil: DVec3::Z,
    ///     normal: DVec3::Z,
    ///     sin_aperture: 0.01,
    ///     wavelength: 650e-9,
    /// })?;
    /// let line = SpectralLine::monochromatic(650e-9)?;
    /// let speckle = PolychromaticSpeckle { line: &line, cell: &cell };
    /// let contrast = |half_angle| Ok::<_, tem00_coherence::CoherenceError>(
    ///     speckle.contrast_of(&SourceExtent::disc(half_angle)?)
    /// );
    /// assert!(contrast(0.002)? > 0.85);
    /// assert!(contrast(0.02)? < 0.4);
    /// # Ok::<(), tem00_coherence::CoherenceError>(())
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 5 and 6: moving diffusers, many lasers.
    pub fn contrast_of(&self, extent: &SourceExtent) -> f64 {
        let cell = self.cell;
        let wave_number = self.line.wave_number();
        let full = cell.full_displacement();
        let (tilt, height_factor) = (cell.tilt(), cell.height_factor());
        let rms_height = cell.relief().rms_height;
        let of_difference = |change: DVec3| {
            let (tilted, heightened) = cell.change_with_source(change);
            let (tilted, heightened) = (wave_number * tilted, wave_number * heightened);
            self.mean(|kappa| {
                let overlap = disc_overlap((kappa * tilt + tilted).length() / full);
                let phases = (kappa * height_factor + heightened) * rms_height;
                overlap.powi(2) * (-phases * phases).exp()
            })
        };
        // The largest changes that a radian makes, of the displacement and of the phases.
        let height_per_angle = cell.height_per_angle();
        let per_angle = wave_number * (1.0 + height_per_angle) / full;
        let feature = 0.5 / per_angle.max(wave_number * height_per_angle * rms_height);
        let mut sum = 0.0;
        extent.for_each_difference(cell.source(), feature, |change, share| {
            sum += share * of_difference(change);
        });
        sum.sqrt()
    }
}

fn check_angle(parameter: &'static str, angle: f64) -> Result<(), CoherenceError> {
    if (0.0..=MAX_ANGLE).contains(&angle) {
        return Ok(());
    }
    let allowed = "from 0 to 0.3, in radians";
    Err(CoherenceError::refused(parameter, angle, allowed))
}

#[cfg(test)]
mod tests;
