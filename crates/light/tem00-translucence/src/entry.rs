use core::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2};

use crate::{
    Medium,
    medium::dot,
    photon::{Meets, Photon},
    reservoir::Reservoir,
};

/// Light that entered a medium beside the point where a camera sees it leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The place of entry along the surface, from where the light leaves, in metres.
    pub offset: [f64; 2],
    /// The radiance towards the camera, in W/(m² sr).
    pub radiance: f64,
}

/// The chance to look for light at a collision, over the fraction of its light that gets there.
const OFTEN: f64 = 2.0;

/// The number of collisions from which on long paths end by chance, without bias: half of them each
/// time that their collisions have quadrupled, as much as paths in a body without absorption leave
/// it by themselves. So they stay rare and never weigh much.
const CERTAIN: u32 = 8;

/// The distance from the light, in transport lengths, from which paths are followed by chance: as
/// its inverse.
const NEAR: f64 = 4.0;

/// The cosine of directions along the surface, which light does not take.
const EDGE_ON: f64 = 1e-6;

impl Medium {
    /// Follows the light that a camera sees at a point of the surface backwards, and draws the
    /// place where it entered from the places of all of its collisions, in proportion to their
    /// light.
    ///
    /// `camera` and `source` are the unit directions from the surface to the camera and to a
    /// distant source; their third component is along the normal. `irradiance` returns the
    /// irradiance of the source at an offset along the surface, in W/m², on a plane that faces the
    /// source. The lit part of the surface begins at a `distance` of some metres; where that is
    /// many transport lengths, few paths are followed. Returns `None` if no light was found. The
    /// mean radiance over all seeds is the radiance of the light from below the surface. Facets of
    /// a matt boundary mask each other.
    pub fn entry(
        &self,
        [camera, source]: [[f64; 3]; 2],
        distance: f64,
        seed: u64,
        mut irradiance: impl FnMut([f64; 2]) -> f64,
    ) -> Option<Entry> {
        let mut photon = Photon::new(self, seed);
        let near = NEAR * self.transport_length() / distance.max(0.0);
        let followed = near.min(1.0);
        if photon.uniform() >= followed {
            return None;
        }
        // Below the surface, along the light from the source and against the light to the camera.
        let mut below = |[x, y, z]: [f64; 3]| {
            let facet = photon.facet();
            let refracted = (z > EDGE_ON).then(|| self.refracted([-x, -y, z], facet))?;
            refracted.map(|(direction, light)| (direction, light / self.facets_met(z)))
        };
        let ((back, seen), (incident, lit)) = (below(camera)?, below(source)?);
        let n = self.refractive_index();
        let irradiance_below = lit * source[2] / (incident[2] * followed);
        let first = photon.uniform();
        photon.enter(back, irradiance_below * seen / (n * n), first);
        let mut drawn = Reservoir::new(photon.uniform());
        let mut collisions = 0;
        while survives(&mut photon, collisions) {
            let [x, y, depth] = photon.place;
            let flight = depth / incident[2];
            let attenuation = libm::exp(-self.extinction() * flight);
            let chance = (OFTEN * attenuation).min(1.0);
            if photon.uniform() < chance {
                let offset = [x - flight * incident[0], y - flight * incident[1]];
                let phase = self.phase(-dot(photon.direction, incident));
                let seen = photon.weight * phase * attenuation / chance;
                drawn.add(offset, seen * irradiance(offset));
            }
            photon.scatter();
            if photon.advance() != Meets::Collision {
                break;
            }
            collisions += 1;
        }
        (drawn.weight > 0.0).then_some(Entry {
            offset: drawn.item,
            radiance: drawn.weight,
        })
    }
}

impl Medium {
    /// Returns the light that meets facets over the light that meets the plane, for its cosine to
    /// the normal, without masking: 1/G₁ of Gaussian slopes (Smith 1967).
    fn facets_met(&self, cosine: f64) -> f64 {
        let tangent = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
        let steepness = SQRT_2 * self.slope() * tangent;
        if steepness == 0.0 {
            return 1.0;
        }
        let a = 1.0 / steepness;
        0.5 * (1.0 + libm::erf(a)) + libm::exp(-a * a) * steepness / (2.0 * PI.sqrt())
    }
}

/// Returns whether a collision leaves a photon, which then weighs as much as all that it stands
/// for.
fn survives(photon: &mut Photon<'_>, collisions: u32) -> bool {
    if collisions >= CERTAIN && collisions.is_power_of_two() {
        photon.weight /= FRAC_1_SQRT_2;
        if photon.uniform() >= FRAC_1_SQRT_2 {
            return false;
        }
    }
    photon.survives()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;
    use crate::{LineSpread, Walk};

    /// Backwards from the camera, light has the radiance and the centre that it has forwards from
    /// the line, also where plane of incidence and line are turned.
    #[test]
    fn backwards_and_forwards_see_the_same_light() {
        let smooth = Medium::new(1.5, 1e3, 50.0).unwrap();
        let matt = smooth.with_anisotropy(0.5).unwrap();
        let matt = matt.with_matt_boundary(0.3).unwrap();
        for (medium, turn, distance) in [(smooth, 0.0_f64, 0.0), (matt, 1.1, 0.5e-3)] {
            let [incidence, exit] = [0.3, 0.9_f64];
            let walk = Walk {
                incidence,
                exits: vec![exit],
                photons: 200_000,
                seed: 1,
            };
            let forwards = &LineSpread::simulate(&medium, &walk).unwrap()[0];
            let (sin, cos) = turn.sin_cos();
            let outwards = |angle: f64| [angle.sin() * cos, angle.sin() * sin, angle.cos()];
            let directions = [outwards(exit), outwards(-incidence)];
            let seeds = 0..100_000_u64;
            let count = seeds.end as f64;
            let entries: Vec<_> = seeds
                .filter_map(|seed| medium.entry(directions, distance, seed, |_| 1.0))
                .collect();
            // Means over the light, with their standard errors.
            let light: f64 = entries.iter().map(|entry| entry.radiance).sum();
            let mean = |value: &dyn Fn(&Entry) -> f64| {
                let values = entries.iter().map(|entry| entry.radiance * value(entry));
                let mean = values.sum::<f64>() / light;
                let errors = entries.iter();
                let errors = errors.map(|entry| (entry.radiance * (value(entry) - mean)).powi(2));
                [mean, errors.sum::<f64>().sqrt() / light]
            };
            let agree = |[found, error]: [f64; 2], expected: f64, other: f64| {
                let difference = (found - expected).abs();
                assert!(
                    difference < 4.0 * error.hypot(other),
                    "{found} for {expected}"
                );
            };
            let squares: f64 = entries.iter().map(|entry| entry.radiance.powi(2)).sum();
            let radiance = forwards.radiance_factor() * incidence.cos() / PI;
            let found = [light / count, squares.sqrt() / count];
            agree(found, radiance, 2e-3 * radiance);
            let across = mean(&|entry| -(cos * entry.offset[0] + sin * entry.offset[1]));
            agree(across, forwards.centroid(), forwards.standard_error());
            let along = mean(&|entry| cos * entry.offset[1] - sin * entry.offset[0]);
            agree(along, 0.0, 0.0);
        }
    }
}
