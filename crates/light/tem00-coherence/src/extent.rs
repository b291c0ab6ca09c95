use core::f64::consts::{PI, TAU};

use glam::DVec3;
use tem00_numerics::{check, disc_overlap, quadrature::for_each_node};

use crate::{Refusal, cell::unit};

/// The directions from which the light of a source reaches the surface: the directions of its
/// transverse modes, of the points of a lamp or a fibre, or of the points of a diffuser that moves
/// many times while the detector integrates.
///
/// Light from different directions does not interfere: the detector adds the intensities, as it
/// adds the intensities of different wave numbers. The extent is an argument of
/// [`ResolutionCell::with_source_extent`](crate::ResolutionCell::with_source_extent). The default
/// is a point.
///
/// # Validity
///
/// Discs and Gaussians must be small compared with a radian: the model is of first order in the
/// angle, and its errors are of the order of the squared angle.
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

impl Default for SourceExtent {
    fn default() -> Self {
        Self {
            directions: Directions::Disc { half_angle: 0.0 },
        }
    }
}

/// The largest angles of discs and Gaussians, in radians.
const ANGLES: [f64; 2] = [0.0, 0.3];

/// Number of standard deviations of a difference at which a Gaussian is cut off, with 2e-11 of its
/// light beyond.
const GAUSSIAN_REACH: f64 = 7.0;

/// The largest number of single directions: the work grows with the number of pairs.
const MAX_DIRECTIONS: usize = 100;

/// The number of panels as wide as the smallest difference that matters; beyond them the panels
/// grow.
const EVEN_PANELS: f64 = 12.0;

/// Number of azimuths of a difference over a full turn.
const AZIMUTHS: i32 = 32;

/// Checks an angle. It counts as 0 where its square would underflow.
fn angle(name: &'static str, angle: f64) -> Result<f64, Refusal> {
    let angle = check::range(name, angle, ANGLES, "rad")?;
    Ok(if angle < 1e-150 { 0.0 } else { angle })
}

impl SourceExtent {
    /// Creates a uniform disc about the direction to the source, with its half-angle in radians as
    /// seen from the surface.
    ///
    /// # Errors
    ///
    /// Returns an error unless the angle is from 0 to 0.3.
    pub fn disc(source_half_angle: f64) -> Result<Self, Refusal> {
        Ok(Self {
            directions: Directions::Disc {
                half_angle: angle("source_half_angle", source_half_angle)?,
            },
        })
    }

    /// Creates a round Gaussian about the direction to the source, with its standard deviation
    /// along each axis in radians as seen from the surface.
    ///
    /// # Errors
    ///
    /// Returns an error unless the angle is from 0 to 0.3.
    pub fn gaussian(standard_deviation: f64) -> Result<Self, Refusal> {
        Ok(Self {
            directions: Directions::Gaussian {
                spread: angle("standard_deviation", standard_deviation)?,
            },
        })
    }

    /// Creates single directions from the surface to the source, of any length, each with its
    /// fraction of the light; the fractions are scaled to the sum 1.
    ///
    /// # Errors
    ///
    /// Returns an error if there are more than 100, a direction has no length, a fraction is
    /// negative or not finite, or all fractions are 0.
    pub fn directions(list: &[(DVec3, f64)]) -> Result<Self, Refusal> {
        let count = list.len();
        let allowed = "from 1 to 100 in number";
        check::that(count <= MAX_DIRECTIONS, "directions", count, "", allowed)?;
        let total: f64 = list.iter().map(|(_, share)| share).sum();
        let allowed = "not negative, finite, and not all 0";
        let holds = total > 0.0 && total.is_finite();
        check::that(holds, "share", total, "", allowed)?;
        let scaled = |&(direction, share): &(DVec3, f64)| {
            check::that(share >= 0.0, "share", share, "", allowed)?;
            Ok((unit("direction", direction)?, share / total))
        };
        Ok(Self {
            directions: Directions::List(list.iter().map(scaled).collect::<Result<_, _>>()?),
        })
    }

    /// Returns whether all light comes from one direction.
    pub fn is_point(&self) -> bool {
        match &self.directions {
            Directions::Disc { half_angle: angle } | Directions::Gaussian { spread: angle } => {
                *angle == 0.0
            }
            Directions::List(list) => list.iter().all(|(direction, _)| *direction == list[0].0),
        }
    }

    /// Visits the differences between two directions of the light, as vectors in radians about the
    /// direction `to_source`, each with its probability; `feature` is the smallest difference that
    /// matters.
    pub(crate) fn for_each_difference(
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
            let mut visit = |radius: f64, weight: f64| {
                let share = weight * TAU * radius * density(radius) / f64::from(AZIMUTHS);
                for azimuth in 0..AZIMUTHS {
                    let angle = TAU * (f64::from(azimuth) + 0.5) / f64::from(AZIMUTHS);
                    visit(radius * (angle.cos() * first + angle.sin() * second), share);
                }
            };
            // For directions far apart the integrand varies only as slowly as the source does.
            let mut from = end.min(EVEN_PANELS * feature.max(1e-12 * end));
            for_each_node(
                [0.0, from],
                (from / EVEN_PANELS).max(feature).min(0.25 * end),
                &mut visit,
            );
            while from < end {
                let to = end.min(4.0 * from);
                for_each_node([from, to], 0.25 * end, &mut visit);
                from = to;
            }
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

#[cfg(test)]
mod tests;
