use num_complex::Complex;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use tem00_numerics::{
    Grid,
    cast::{to_signed, to_usize},
};

use crate::{
    Pupil, PupilField, SpeckleError,
    pupil::{lattice::unit_phasor, mask::Mask},
};

/// Rest of the generator's key beside the seed; a new value would be a new family.
const KEY: &[u8; 24] = b"tem00 few scatterers  v1";

impl PupilField {
    /// Creates the field of a few point sources of equal strength and random phase, at random positions
    /// of a circular pupil: partially developed speckle.
    ///
    /// ```text
    /// I(r) = |Σ exp(iφⱼ − 2πi kⱼ·r / Q)|² / N
    /// C    = √(1 − 1/N),   I ≤ N
    /// ```
    ///
    /// Every point of the image gets light from each of the N sources: scatterers on a spot seen
    /// without a lens, the spots of a diffractive projector or the ends of
    /// fibres in a pupil. One source makes no speckle, two make fringes, from some fifty on speckle
    /// counts as fully developed. `size` and `speckle_size` are those of
    /// [`from_speckle_size`](Self::from_speckle_size).
    ///
    /// The mean is exactly 1. The contrast is that of the ensemble of seeds: one pattern of a few
    /// sources scatters about it.
    ///
    /// # Validity
    ///
    /// The sources lie in the undisplaced pupil, on lattice points, no two on the same. A displaced
    /// pupil sees those that it still covers, a defocused one all. A lens that images a surface of few
    /// scatterers per resolution cell is another case: there the number that meet in a point
    /// fluctuates, and the contrast exceeds 1.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ count` and there are so many lattice points in the pupil; those
    /// of [`from_speckle_size`](Self::from_speckle_size).
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::from_scatterers(4, [64, 64], 2.0, 7)?;
    /// let pattern = field.pattern();
    /// let brightest = pattern.values().values().iter().fold(0.0_f32, |a, &b| a.max(b));
    /// assert!(brightest <= 4.0001);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    ///
    /// # References
    ///
    /// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (a finite number of equal-length
    ///   components).
    pub fn from_scatterers(
        count: usize,
        size: [usize; 2],
        speckle_size: f64,
        seed: u64,
    ) -> Result<Self, SpeckleError> {
        let diameter = Self::from_speckle_size(size, speckle_size, seed)?.diameter();
        let mask = Mask::new(&Pupil::Circle, diameter, [0.0; 2]);
        if !(1..=mask.count()).contains(&count) {
            let limits = [1.0, mask.count() as f64];
            let unit = "scatterers, the lattice points in the pupil";
            return Err(SpeckleError::out_of_limits(
                "count",
                count as f64,
                limits,
                unit,
            ));
        }
        let samples = scatter(&mask, count, &mut generator(seed));
        Self::from_samples(samples, size, speckle_size)
    }
}

/// Unit phasors at `count` of the mask's points, the origin in the middle.
fn scatter(mask: &Mask, count: usize, generator: &mut ChaCha8Rng) -> Grid<Complex<f32>> {
    let [x, y] = [0, 1].map(|axis| {
        // The box about the mask may reach further to one side than to the other.
        let corner = mask.corner()[axis];
        let end = corner + to_signed(mask.extent()[axis]);
        let reach = corner.unsigned_abs().max(end.unsigned_abs());
        usize::try_from(reach).unwrap_or(usize::MAX)
    });
    let mut samples = Grid::filled(2 * x + 1, 2 * y + 1, Complex::new(0.0, 0.0));
    let index = |k: i64, reach: usize| usize::try_from(k + to_signed(reach)).unwrap_or(usize::MAX);
    let mut points = points_of(mask);
    for taken in 0..count {
        // The points before `taken` are used up: Durstenfeld (1964).
        let other = taken + below(points.len() - taken, generator);
        points.swap(taken, other);
        let [kx, ky] = points[taken];
        samples[(index(kx, x), index(ky, y))] = unit_phasor(generator.next_u32());
    }
    samples
}

/// The lattice points of the mask, row by row.
fn points_of(mask: &Mask) -> Vec<[i64; 2]> {
    let [x, y] = mask.corner();
    let rows = 0..mask.extent()[1];
    rows.flat_map(|row| {
        let columns = mask.powers(row);
        columns.map(move |(column, _)| [x + to_signed(column), y + to_signed(row)])
    })
    .collect()
}

/// A random number below `end`; for the ends of lattices all are equally probable within 10⁻¹⁰.
fn below(end: usize, generator: &mut ChaCha8Rng) -> usize {
    const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
    let uniform = (generator.next_u64() >> 11) as f64 * UNIT;
    to_usize(uniform * end as f64).min(end - 1)
}

fn generator(seed: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..24].copy_from_slice(KEY);
    key[24..].copy_from_slice(&seed.to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

#[cfg(test)]
mod tests;
