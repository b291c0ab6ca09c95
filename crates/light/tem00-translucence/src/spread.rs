use core::f64::consts::PI;

use tem00_coherence::{DelayedLight, PathPairs, Spectrum};

use crate::{
    Medium, Walk, bins,
    reservoir::Reservoir,
    walk::{BLOCKS, Block},
};

/// The number of following paths with which each path is paired: few pairs are coherent in light of
/// a large linewidth.
const PARTNERS: usize = 16;

/// Line-spread function of a half space for one pair of angles, with the path lengths behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSpread {
    radiance_factor: f64,
    albedo: f64,
    centroid: f64,
    standard_error: f64,
    samples: Vec<PathSample>,
    optical: f64,
}

/// Path of light from the place of entry to where it leaves the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathSample {
    /// The light of the path, in a common unit.
    pub weight: f64,
    /// The place across the line at which the light leaves, from where it entered, in metres.
    pub place: f64,
    /// The geometrical length of the path below the surface, in metres.
    pub length: f64,
}

impl LineSpread {
    pub(crate) fn collect(medium: &Medium, walk: &Walk, camera: usize, blocks: &[Block]) -> Self {
        let sums = || blocks.iter().map(|block| block.tallies[camera].sums);
        let [weight, moment] = [0, 1].map(|index| sums().map(|sums| sums[index]).sum::<f64>());
        let centroid = moment / weight;
        let squares = sums().map(|[part, moment]| (moment - centroid * part).powi(2));
        let count = blocks.len() as f64;
        let variance = squares.sum::<f64>() * count / (count - 1.0) / weight.powi(2);
        let escaped: f64 = blocks.iter().map(|block| block.escaped).sum();
        let entered: f64 = blocks.iter().map(|block| block.entered).sum();
        let photons = walk.photons.div_ceil(BLOCKS as u64) as f64 * count;
        Self {
            radiance_factor: PI * medium.scattered_fraction() * weight / photons,
            albedo: escaped / entered,
            centroid,
            standard_error: variance.sqrt(),
            samples: blocks
                .iter()
                .flat_map(|block| block.tallies[camera].samples.iter().copied())
                .collect(),
            optical: medium.refractive_index(),
        }
    }

    /// Returns the radiance of the light from below the surface over that of a white Lambertian
    /// surface in the same irradiance.
    pub const fn radiance_factor(&self) -> f64 {
        self.radiance_factor
    }

    /// Returns the fraction of the light that entered which leaves the surface again, in all
    /// directions.
    pub const fn albedo(&self) -> f64 {
        self.albedo
    }

    /// Returns the centre of the light across the line, from where it entered, in metres.
    ///
    /// All of the light counts; a detector that looks at a window or at the peak of the line finds
    /// a smaller shift, down to a third.
    pub const fn centroid(&self) -> f64 {
        self.centroid
    }

    /// Returns the standard error of the centre, in metres, from the scatter of 64 blocks of
    /// photons.
    pub const fn standard_error(&self) -> f64 {
        self.standard_error
    }

    /// Returns a path of each photon that sent light to the camera, drawn by its light.
    pub fn samples(&self) -> &[PathSample] {
        &self.samples
    }

    /// Returns the speckle contrast of the light that leaves at `places`, in metres from the entry,
    /// in light of a spectrum; `None` if fewer than two photons leave there.
    ///
    /// C² = ⟨|γ(n (l − l′))|²⟩ over pairs of independent paths (Goodman 2007), for polarised light;
    /// unpolarised light has C/√2.
    pub fn contrast(&self, line: &Spectrum, places: [f64; 2]) -> Option<f64> {
        let pairs = pairs(&self.samples, self.optical, (line, places));
        pairs.self_coherence().map(f64::sqrt)
    }
}

/// Returns the coherence of the paths that leave at `places`, in a medium of a refractive index.
pub(crate) fn pairs(
    samples: &[PathSample],
    refractive_index: f64,
    (line, places): (&Spectrum, [f64; 2]),
) -> PathPairs {
    let within = |sample: &&PathSample| (places[0]..=places[1]).contains(&sample.place);
    let paths = samples.iter().filter(within).map(|sample| DelayedLight {
        weight: sample.weight,
        delay: refractive_index * sample.length,
    });
    let paths: Vec<_> = paths.collect();
    let mut pairs = PathPairs::default();
    for (first, path) in paths.iter().enumerate() {
        let others = paths[first + 1..].iter().take(PARTNERS);
        for other in others {
            pairs.add(line, &[*path], &[*other]);
        }
    }
    pairs
}

/// Light that a camera sees of a block of photons.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    /// Σ w and Σ w x.
    sums: [f64; 2],
    samples: Vec<PathSample>,
    /// The light in [bins](bins), or none.
    bins: Vec<f64>,
    /// The path of the photon that is drawn so far, with the light of all of its paths.
    drawn: Reservoir<PathSample>,
}

impl Tally {
    /// Creates a tally that also sorts the light into bins.
    pub(crate) fn binned() -> Self {
        Self {
            bins: vec![0.0; bins::PLACES * bins::LENGTHS],
            ..Self::default()
        }
    }

    /// Adds the bins of tallies, and joins their samples.
    pub(crate) fn joined(tallies: impl Iterator<Item = Self>) -> (Vec<f64>, Vec<PathSample>) {
        let join = |mut sum: Self, mut next: Self| {
            let bins = sum.bins.iter_mut().zip(&next.bins);
            bins.for_each(|(sum, light)| *sum += light);
            sum.samples.append(&mut next.samples);
            sum
        };
        let all = tallies.reduce(join).unwrap_or_default();
        (all.bins, all.samples)
    }

    /// Begins a photon, with a uniform number that chooses one of its paths.
    pub(crate) fn begin(&mut self, uniform: f64) {
        self.drawn = Reservoir::new(uniform);
    }

    pub(crate) fn add(&mut self, path: PathSample) {
        self.sums[0] += path.weight;
        self.sums[1] += path.weight * path.place;
        if let Some(bin) = self.bins.get_mut(bins::index(path.place, path.length)) {
            *bin += path.weight;
        }
        self.drawn.add(path, path.weight);
    }

    pub(crate) fn end(&mut self) {
        if self.drawn.weight > 0.0 {
            self.samples.push(PathSample {
                weight: self.drawn.weight,
                ..self.drawn.item
            });
        }
    }
}
