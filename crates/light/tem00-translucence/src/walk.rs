use core::f64::consts::PI;

use tem00_numerics::{
    Refusal,
    cast::to_usize,
    check, parallel,
    seed::{Purpose, derived},
};

use crate::{
    LineSpread, Medium, PathSample,
    medium::dot,
    photon::{Meets, Photon},
    spread::Tally,
};

/// The largest angle of incidence or exit, in radians: 85°.
pub const MAX_ANGLE: f64 = 85.0 * PI / 180.0;

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
    /// A photon flies from collision to collision, is reflected at the boundary by chance, and
    /// sends a part of its light to each camera at every collision (next event). The walk from the
    /// first collision on and its mirror image across the line differ in probability only by the
    /// first scattering angle. Both count, each with its conditional probability, so that the
    /// diffusion across the line adds little noise to the centre.
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
pub(crate) const BLOCKS: usize = 64;

fn blocks<T: Send>(block: impl Fn(u64) -> T + Sync) -> Vec<T> {
    parallel::map(BLOCKS, |number| block(number as u64))
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
    let seed = derived(walk.seed, Purpose::Pattern, number + 1);
    let mut line = Line {
        photon: Photon::new(medium, seed),
        exits: Vec::new(),
        seen: Block {
            tallies: walk.exits.iter().map(|_| tally()).collect(),
            entered: 0.0,
            escaped: 0.0,
        },
    };
    // First flights are stratified: they decide where the line is seen. In random order, so that
    // neighbours are independent pairs of paths.
    let count = walk.photons.div_ceil(BLOCKS as u64);
    let mut strata: Vec<_> = (0..count).collect();
    for left in (1..strata.len()).rev() {
        let drawn = line.photon.uniform() * (left + 1) as f64;
        strata.swap(left, to_usize(drawn));
    }
    for stratum in strata {
        let first = (stratum as f64 + line.photon.uniform()) / count as f64;
        line.meet(walk, first);
    }
    line.seen
}

/// Way of light to a camera.
#[derive(Clone, Copy, Default)]
struct Exit {
    /// Direction below the surface, against the light.
    direction: [f64; 3],
    /// The radiance outside over the light that arrives below the facet from a collision.
    radiance: f64,
}

/// The photons of a line, and what the cameras see of them.
struct Line<'a> {
    photon: Photon<'a>,
    exits: Vec<Exit>,
    seen: Block,
}

/// Optical depth from which no light is sent to a camera: 10⁻⁷ of it would arrive.
const DARK: f64 = 16.0;

impl Line<'_> {
    /// Follows a photon through the facets that it meets.
    fn meet(&mut self, walk: &Walk, first: f64) {
        let outside = |angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            [sin, 0.0, cos]
        };
        let medium = self.photon.medium;
        self.exits.clear();
        for &exit in &walk.exits {
            // As if the light came from the camera: paths can be reversed.
            let facet = self.photon.facet();
            let way = medium.refracted(outside(-exit), facet);
            let n = medium.refractive_index();
            self.exits
                .push(way.map_or_else(Exit::default, |(direction, light)| Exit {
                    direction,
                    radiance: light / (n * n * direction[2]),
                }));
        }
        let facet = self.photon.facet();
        if let Some((direction, light)) = medium.refracted(outside(walk.incidence), facet) {
            self.seen.entered += light;
            self.follow(direction, light, first);
        }
    }

    fn follow(&mut self, incident: [f64; 3], weight: f64, first: f64) {
        for tally in &mut self.seen.tallies {
            tally.begin(self.photon.uniform());
        }
        let photon = &mut self.photon;
        photon.enter(incident, weight, first);
        // From here on places across the line are relative to the first collision.
        let entry = core::mem::take(&mut photon.place[0]);
        let mut probability = 1.0;
        self.send(entry, probability);
        if !self.photon.survives() {
            return self.end();
        }
        self.photon.scatter();
        let [x, y, z] = self.photon.direction;
        let [own, mirrored] = [x, -x].map(|x| self.photon.medium.phase(dot(incident, [x, y, z])));
        probability = own / (own + mirrored);
        loop {
            match self.photon.advance() {
                Meets::Collision => self.send(entry, probability),
                Meets::Outside => {
                    self.seen.escaped += self.photon.weight;
                    break;
                }
                Meets::Nothing => break,
            }
            if !self.photon.survives() {
                break;
            }
            self.photon.scatter();
        }
        self.end();
    }

    fn end(&mut self) {
        for tally in &mut self.seen.tallies {
            tally.end();
        }
    }

    /// Sends light of a collision to the cameras. The first collision was `entry` beside the line,
    /// and the walk has a `probability`, given that it or its mirror image occurred.
    fn send(&mut self, entry: f64, probability: f64) {
        let photon = &self.photon;
        let [beside, _, depth] = photon.place;
        let [x, y, z] = photon.direction;
        let extinction = photon.medium.extinction();
        for (exit, tally) in self.exits.iter().zip(&mut self.seen.tallies) {
            let [ex, ey, ez] = exit.direction;
            let flight = depth / ez;
            if exit.radiance == 0.0 || extinction * flight > DARK {
                continue;
            }
            let seen = exit.radiance * photon.weight * libm::exp(-extinction * flight);
            let length = photon.length + flight;
            let first = entry - flight * ex;
            let walks = [(probability, x, beside), (1.0 - probability, -x, -beside)];
            for (probability, x, beside) in walks {
                if probability > 0.0 {
                    let phase = photon.medium.phase(-(x * ex + y * ey + z * ez));
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
}
