mod map;

use core::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_numerics::{Grid, circle_point_at_turn};

use self::map::RadianceMap;
use crate::{LightSample, TracerError, error::check_light};

/// Light from all around, so far away that it is the same everywhere in the scene.
///
/// Its radiance is constant, or given by a map of latitude by longitude: the rows go from `up` down
/// to the opposite direction in equal steps of the angle, the columns once around, from left to
/// right as seen by an observer who looks at the middle of the map. A map has one radiance for each
/// of its pixels, without interpolation, so that directions are drawn in exact proportion to it.
///
/// # Examples
///
/// A sky with a bright patch is sampled where it is bright:
///
/// ```
/// use core::f64::consts::PI;
///
/// use glam::DVec3;
/// use tem00_numerics::Grid;
/// use tem00_tracer::Environment;
///
/// // Four columns, two rows: only the front upper quarter shines, which covers π/2 sr.
/// let map = Grid::from_vec(4, 2, vec![0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0])?;
/// let sky = Environment::from_radiance(map, DVec3::Z, DVec3::X)?;
///
/// let sample = sky.sample([0.3, 0.8]).expect("a patch shines");
/// assert_eq!(sky.radiance_along(sample.direction), 3.0); // W/(m² sr)
/// assert!((sample.radiance_over_pdf - 1.5 * PI).abs() < 1e-12); // W/m²
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    radiance: Radiance,
}

#[derive(Clone, Debug, PartialEq)]
enum Radiance {
    Constant(f64),
    Map {
        map: Arc<RadianceMap>,
        /// Towards the middle of the map, to the right of it, and up.
        middle: DVec3,
        right: DVec3,
        up: DVec3,
    },
}

impl Environment {
    /// Creates an environment of constant `radiance`, in W/(m² sr).
    ///
    /// # Errors
    ///
    /// Returns an error if the radiance is negative or not finite.
    pub fn constant(radiance: f64) -> Result<Self, TracerError> {
        check_light("radiance", radiance)?;
        Ok(Self {
            radiance: Radiance::Constant(radiance),
        })
    }

    /// Creates an environment from a radiance map, in W/(m² sr).
    ///
    /// `up` is the direction of the upper edge of the map. `middle` is a direction that appears in
    /// its middle column; only its component across `up` counts.
    ///
    /// # Errors
    ///
    /// Returns an error if a radiance is negative or not finite, if `up` is zero, or if `middle` is
    /// parallel to it.
    pub fn from_radiance(map: Grid<f32>, up: DVec3, middle: DVec3) -> Result<Self, TracerError> {
        let up = up.try_normalize().ok_or(TracerError::Direction {
            parameter: "up",
            allowed: "a direction",
        })?;
        let across = middle.normalize_or_zero();
        let middle = (across - across.dot(up) * up)
            .try_normalize()
            .filter(|_| across.cross(up).length() > 1e-6)
            .ok_or(TracerError::Direction {
                parameter: "middle",
                allowed: "a direction across `up`",
            })?;
        Ok(Self {
            radiance: Radiance::Map {
                map: Arc::new(RadianceMap::new(map)?),
                middle,
                right: middle.cross(up),
                up,
            },
        })
    }

    /// Draws a direction from which light comes, in proportion to its radiance, by two uniform
    /// numbers in [0, 1).
    ///
    /// Returns `None` if the environment is black.
    pub fn sample(&self, u: [f64; 2]) -> Option<LightSample> {
        let (direction, radiance, pdf) = match &self.radiance {
            Radiance::Constant(radiance) => (on_sphere(u), *radiance, 0.25 / PI),
            Radiance::Map {
                map,
                middle,
                right,
                up,
            } => {
                let (local, radiance) = map.sample(u)?;
                let direction = local.x * *middle + local.y * *right + local.z * *up;
                (direction.normalize(), radiance, radiance / map.total())
            }
        };
        (radiance > 0.0 && pdf > 0.0).then(|| LightSample {
            direction,
            distance: f64::INFINITY,
            radiance_over_pdf: radiance / pdf,
            pdf: Some(pdf),
        })
    }

    /// Returns the density with which [`sample`](Self::sample) draws a direction, of unit length,
    /// per steradian.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        match &self.radiance {
            Radiance::Constant(radiance) if *radiance > 0.0 => 0.25 / PI,
            Radiance::Map { map, .. } if map.total() > 0.0 => {
                self.radiance_along(direction) / map.total()
            }
            _ => 0.0,
        }
    }

    /// Returns the radiance that comes from a direction, of unit length, in W/(m² sr).
    pub fn radiance_along(&self, direction: DVec3) -> f64 {
        match &self.radiance {
            Radiance::Constant(radiance) => *radiance,
            Radiance::Map {
                map,
                middle,
                right,
                up,
            } => map.radiance(DVec3::new(
                direction.dot(*middle),
                direction.dot(*right),
                direction.dot(*up),
            )),
        }
    }
}

/// Returns a direction, uniform over the sphere for uniform numbers.
fn on_sphere([u, v]: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * v;
    let radius = (4.0 * v * (1.0 - v)).sqrt();
    (radius * DVec2::from(circle_point_at_turn(u))).extend(z)
}

#[cfg(test)]
mod tests;
