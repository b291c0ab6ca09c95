use core::{array, f64::consts::PI};

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use tem00_numerics::{
    Refusal,
    cast::to_usize,
    check,
    seed::{Purpose, derived},
};

use crate::{LineSpread, Medium, PathSample, medium::dot, spread::Tally};

/// The largest angle of incidence or exit, in radians: 85°.
pub(crate) const MAX_ANGLE: f64 = 85.0 * PI / 180.0;

/// Simulation of a laser line on a half space, seen by one camera or more.
///
/// Angles are in radians to the normal, in the plane across the line, and positive towards +x: the
/// laser travels towards +x for a positive incidence, and a camera at a positive exit sees light
/// that leaves towards +x.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The angle of incidence θi, from −85° to 85°.
    pub incidence: f64,
    /// The angles θo of the cameras, likewise.
    pub exits: Vec<f64>,
    /// The number of photons, from 64 to 10⁹; rounded up to a multiple of 64.
    pub photons: u64,
    /// The seed; the same seed gives the same bits for any number of threads.
    pub seed: u64,
}

impl LineSpread {
    /// Follows photons through a medium and returns what each camera sees.
    ///
    /// A photon flies from collision to collision, is reflected at the boundary by chance, and sends
    /// a part of its light to each camera at every collision (next event). The walk from the first
    /// collision on and its mirror image across the line differ in probability only by the first
    /// scattering angle. Both count, each with its conditional probability, so that the diffusion
    /// across the line adds little noise to the centre.
    ///
    /// # Errors
    ///
    /// Returns an error if an angle or the number of photons is out of range.
    pub fn simulate(medium: &Medium, walk: &Walk) -> Result<Vec<Self>, Refusal> {
        let angle = |name, angle| check::range(name, angle, [-MAX_ANGLE, MAX_ANGLE], "rad");
        angle("incidence", walk.incidence)?;
        check::each(&walk.exits, |exit| angle("exits", exit))?;
        check::range("photons", walk.photons as f64, [64.0, 1e9], "")?;
        let blocks = blocks(|number| block(medium, walk, number, Tally::default));
        let collected = |camera| Self::collect(medium, walk, camera, &blocks);
        Ok((0..walk.exits.len()).map(collected).collect())
    }

    /// Returns the light that the first camera sees, in bins, and the paths of single photons.
    pub(crate) fn binned(medium: &Medium, walk: &Walk) -> (Vec<f64>, Vec<PathSample>) {
        let blocks = blocks(|number| block(medium, walk, number, Tally::binned));
        Tally::joined(blocks.into_iter().flat_map(|block| block.tallies))
    }
}

/// The number of blocks of photons, each with random numbers of its own.
pub(crate) const BLOCKS: u64 = 64;

#[cfg(feature = "parallel")]
fn blocks<T: Send>(block: impl Fn(u64) -> T + Sync + Send) -> Vec<T> {
    use rayon::prelude::*;
    (0..BLOCKS).into_par_iter().map(block).collect()
}

#[cfg(not(feature = "parallel"))]
fn blocks<T>(block: impl Fn(u64) -> T) -> Vec<T> {
    (0..BLOCKS).map(block).collect()
}

/// Light of a block of photons.
pub(crate) struct Block {
    /// What each camera sees.
    pub(crate) tallies: Vec<Tally>,
    /// The light that entered the medium, and the light that left it again.
    pub(crate) entered: f64,
    pub(crate) escaped: f64,
}

/// Follows the photons of a block.
fn block(medium: &Medium, walk: &Walk, number: u64, tally: fn() -> Tally) -> Block {
    let random = ChaCha8Rng::seed_from_u64(derived(walk.seed, Purpose::Pattern, number + 1));
    let mut photon = Photon {
        medium,
        random,
        exits: Vec::new(),
        seen: Block {
            tallies: walk.exits.iter().map(|_| tally()).collect(),
            entered: 0.0,
            escaped: 0.0,
        },
    };
    // First flights are stratified: they decide where the line is seen. In random order, so that
    // neighbours are independent pairs of paths.
    let count = walk.photons.div_ceil(BLOCKS);
    let mut strata: Vec<_> = (0..count).collect();
    for left in (1..strata.len()).rev() {
        let drawn = uniform(&mut photon.random) * (left + 1) as f64;
        strata.swap(left, to_usize(drawn));
    }
    for stratum in strata {
        let first = (stratum as f64 + uniform(&mut photon.random)) / count as f64;
        photon.meet(walk, first);
    }
    photon.seen
}

/// Way of light to a camera.
#[derive(Clone, Copy, Default)]
struct Exit {
    /// Direction below the surface, against the light.
    direction: [f64; 3],
    /// The radiance outside over the light that arrives below the facet from a collision.
    radiance: f64,
}

struct Photon<'a> {
    medium: &'a Medium,
    random: ChaCha8Rng,
    exits: Vec<Exit>,
    seen: Block,
}

/// State of a photon between its first collision and its end.
struct State {
    /// Place of the first collision across the line.
    entry: f64,
    /// Place across the line, relative to the first collision, and depth.
    place: [f64; 2],
    direction: [f64; 3],
    length: f64,
    /// The probability of the walk, given that it or its mirror image occurred.
    probability: f64,
    /// The light of the photon.
    weight: f64,
}

/// Optical depth from which no light is sent to a camera: 10⁻⁷ of it would arrive.
const DARK: f64 = 16.0;

impl Photon<'_> {
    /// Follows a photon through the facets that it meets.
    fn meet(&mut self, walk: &Walk, first: f64) {
        let outside = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            [sin, 0.0, cos]
        };
        self.exits.clear();
        for &exit in &walk.exits {
            // As if the light came from the camera: paths can be reversed.
            let facet = self.facet();
            let way = self.medium.refracted(outside(-exit), facet);
            let n = self.medium.refractive_index();
            self.exits
                .push(way.map_or_else(Exit::default, |(direction, light)| Exit {
                    direction,
                    radiance: light / (n * n * direction[2]),
                }));
        }
        let facet = self.facet();
        if let Some((direction, light)) = self.medium.refracted(outside(walk.incidence), facet) {
            self.seen.entered += light;
            self.follow(direction, light, first);
        }
    }

    /// Draws the slopes of a facet.
    fn facet(&mut self) -> [f64; 2] {
        let slope = self.medium.slope();
        if slope == 0.0 {
            return [0.0; 2];
        }
        // Box and Muller 1958.
        let radius = slope * (-2.0 * libm::log1p(-uniform(&mut self.random))).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * uniform(&mut self.random));
        [radius * cos, radius * sin]
    }

    fn follow(&mut self, incident: [f64; 3], weight: f64, first: f64) {
        for tally in &mut self.seen.tallies {
            tally.begin(uniform(&mut self.random));
        }
        let length = self.flight(first);
        let mut state = State {
            entry: length * incident[0],
            place: [0.0, length * incident[2]],
            direction: incident,
            length,
            probability: 1.0,
            weight,
        };
        self.send(&state);
        if !self.survives() {
            return self.end();
        }
        state.direction = self.scattered(incident);
        let [x, y, z] = state.direction;
        let [own, mirrored] = [x, -x].map(|x| self.medium.phase(dot(incident, [x, y, z])));
        state.probability = own / (own + mirrored);
        while self.advance(&mut state) {
            self.send(&state);
            if !self.survives() {
                break;
            }
            state.direction = self.scattered(state.direction);
        }
        self.end();
    }

    fn end(&mut self) {
        for tally in &mut self.seen.tallies {
            tally.end();
        }
    }

    /// Moves a photon to its next collision; false if it leaves the medium.
    fn advance(&mut self, state: &mut State) -> bool {
        let drawn = uniform(&mut self.random);
        let mut rest = self.flight(drawn);
        loop {
            let to_surface = -state.place[1] / state.direction[2];
            let meets = state.direction[2] < 0.0 && to_surface < rest;
            let step = if meets { to_surface } else { rest };
            state.place[0] += step * state.direction[0];
            state.length += step;
            if !meets {
                state.place[1] += step * state.direction[2];
                return true;
            }
            state.place[1] = 0.0;
            rest -= step;
            if !self.reflect(state) {
                return false;
            }
        }
    }

    /// Reflects a photon that meets the boundary from below, by chance; false if it leaves.
    fn reflect(&mut self, state: &mut State) -> bool {
        let [p, q] = self.facet();
        let length = (1.0 + p * p + q * q).sqrt();
        let normal = [p / length, q / length, 1.0 / length];
        let cosine = -dot(state.direction, normal);
        // Facets that look away are not met.
        state.weight *= (-cosine * length / state.direction[2]).max(0.0);
        if cosine <= 0.0 {
            return false;
        }
        if uniform(&mut self.random) >= self.medium.reflectance_from_inside(cosine) {
            self.seen.escaped += state.weight;
            return false;
        }
        state.direction = array::from_fn(|i| state.direction[i] + 2.0 * cosine * normal[i]);
        // What a facet sends upwards would meet another: without masking it is lost both ways.
        state.direction[2] > 0.0
    }

    /// Sends light of a collision to the cameras.
    fn send(&mut self, state: &State) {
        let [beside, depth] = state.place;
        let [x, y, z] = state.direction;
        let extinction = self.medium.extinction();
        for (exit, tally) in self.exits.iter().zip(&mut self.seen.tallies) {
            let [ex, ey, ez] = exit.direction;
            let flight = depth / ez;
            if exit.radiance == 0.0 || extinction * flight > DARK {
                continue;
            }
            let seen = exit.radiance * state.weight * libm::exp(-extinction * flight);
            let length = state.length + flight;
            let first = state.entry - flight * ex;
            let walks = [
                (state.probability, x, beside),
                (1.0 - state.probability, -x, -beside),
            ];
            for (probability, x, beside) in walks {
                if probability > 0.0 {
                    let phase = self.medium.phase(-(x * ex + y * ey + z * ez));
                    let weight = probability * phase * seen;
                    tally.add(PathSample {
                        weight,
                        place: first + beside,
                        length,
                    });
                }
            }
        }
    }

    /// Returns the length of a flight for a uniform number.
    fn flight(&self, uniform: f64) -> f64 {
        -libm::log1p(-uniform) / self.medium.extinction()
    }

    fn survives(&mut self) -> bool {
        uniform(&mut self.random) < self.medium.scattered_fraction()
    }

    /// Draws the direction behind a collision.
    fn scattered(&mut self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let cosine = self.medium.scattering_cosine(uniform(&mut self.random));
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * uniform(&mut self.random));
        let [u, v] = [sine * cos, sine * sin];
        // A frame around the direction (Frisvad 2012, as revised by Duff et al. 2017).
        let sign = 1.0_f64.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let along = [1.0 + sign * x * x * a, sign * b, -sign * x];
        let across = [b, sign + y * y * a, -y];
        let direction = [x, y, z];
        array::from_fn(|i| u * along[i] + v * across[i] + cosine * direction[i])
    }
}

/// A uniform number from 0 to below 1.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (0.5_f64).powi(53)
}
