use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{Fft2, Fft2Scratch, Grid};

use crate::{
    Phasors, Pupil, SpeckleError, SpeckleField, SpecklePattern,
    lattice::{Lattice, wrap_to},
    mask::{Mask, to_f64, to_i64},
    rows::for_each_row,
};

/// A random field on the lattice of pupil points, seen through the pupil.
///
/// The lattice is a torus of Q × Q points; the phasor `P(k)` at a point depends only on the seed and
/// on k modulo Q. The pupil selects the N points within its diameter C, and its Fourier transform
/// is the speckle field on Q × Q samples:
///
/// ```text
/// U(r) = 1/√N Σ P(k + offset) exp(−2πi k·r / Q)        |k|² ≤ C²/4
/// I(r) = |U(r)|²
/// ```
///
/// The sum runs over points about k = 0, wherever the pupil stands on the lattice, so that U is
/// band-limited about zero frequency and can be interpolated.
///
/// # Validity
///
/// The intensity holds spatial frequencies up to C/Q, twice those of the amplitude: C ≤ Q/2 keeps
/// it free of aliasing, and keeps a pupil displaced by its own diameter from meeting itself on the
/// torus. C ≥ 8 gives 49 phasors or more, so that the contrast is within 1 % of one.
///
/// # Examples
///
/// ```
/// use tem00_speckle::PupilField;
///
/// let field = PupilField::new(256, 64, 1)?;
/// assert_eq!(field.speckle_size(), 4.0);
///
/// let pattern = field.pattern();
/// let values = pattern.values().values();
/// let mean = values.iter().map(|&i| f64::from(i)).sum::<f64>() / values.len() as f64;
/// assert!((mean - 1.0).abs() < 1e-6);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - D. D. Duncan and S. J. Kirkpatrick, *Algorithms for simulation of speckle*, 2008.
/// - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
///   Speckle into a Physically-Based Renderer*, 2016, §5.
#[derive(Clone, Debug)]
pub struct PupilField {
    lattice: Lattice,
    diameter: usize,
    pupil: Pupil,
    mask: Mask,
    transform: Fft2,
}

impl PupilField {
    /// The largest pattern size Q, in samples: 8 GiB for one complex field.
    pub const MAX_SIZE: usize = 1 << 15;
    /// The smallest pupil diameter C, in lattice points.
    pub const MIN_DIAMETER: usize = 8;
    /// The smallest number of phasors N, that of a circle of the smallest diameter.
    pub const MIN_PHASORS: usize = 49;

    /// Creates a field of unit phasors behind a circular pupil.
    ///
    /// `size` is the pattern size Q in samples, `diameter` the pupil diameter C in lattice points.
    /// A speckle is Q/C samples wide, and the pattern repeats after Q samples or C speckles.
    ///
    /// # Errors
    ///
    /// Returns an error unless `8 ≤ diameter ≤ size / 2` and `size ≤ MAX_SIZE`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SpeckleError};
    ///
    /// let aliased = PupilField::new(256, 129, 0);
    /// assert!(matches!(aliased, Err(SpeckleError::Diameter { .. })));
    /// ```
    pub fn new(size: usize, diameter: usize, seed: u64) -> Result<Self, SpeckleError> {
        if size > Self::MAX_SIZE {
            return Err(SpeckleError::Size(size));
        }
        if diameter < Self::MIN_DIAMETER || diameter > size / 2 {
            return Err(SpeckleError::Diameter { diameter, size });
        }
        let lattice = Lattice {
            seed,
            size,
            phasors: Phasors::Unit,
        };
        Self::build(lattice, diameter, Pupil::Circle)
    }

    /// Returns the same field behind a pupil of another shape.
    ///
    /// # Errors
    ///
    /// Returns an error if a proportion of `pupil` is out of range or if it holds fewer than
    /// [`MIN_PHASORS`](Self::MIN_PHASORS) lattice points.
    pub fn with_pupil(self, pupil: Pupil) -> Result<Self, SpeckleError> {
        pupil.check()?;
        Self::build(self.lattice, self.diameter, pupil)
    }

    /// Returns the same pupil with another law of phasors.
    #[must_use]
    pub const fn with_phasors(mut self, phasors: Phasors) -> Self {
        self.lattice.phasors = phasors;
        self
    }

    /// Returns the same pupil with another, independent set of phasors.
    #[must_use]
    pub const fn with_seed(mut self, seed: u64) -> Self {
        self.lattice.seed = seed;
        self
    }

    fn build(lattice: Lattice, diameter: usize, pupil: Pupil) -> Result<Self, SpeckleError> {
        let mask = Mask::new(pupil, diameter);
        if mask.count() < Self::MIN_PHASORS {
            return Err(SpeckleError::PhasorCount(mask.count()));
        }
        let [half_width, half_height] = mask.half_extent();
        let transform = Fft2::with_aperture(
            lattice.size,
            lattice.size,
            2 * half_width + 1,
            2 * half_height + 1,
        )
        .map_err(|_| SpeckleError::Size(lattice.size))?;
        Ok(Self {
            lattice,
            diameter,
            pupil,
            mask,
            transform,
        })
    }

    /// Returns the pattern size Q, in samples.
    pub const fn size(&self) -> usize {
        self.lattice.size
    }

    /// Returns the nominal pupil diameter C, in lattice points.
    pub const fn diameter(&self) -> usize {
        self.diameter
    }

    /// Returns the seed.
    pub const fn seed(&self) -> u64 {
        self.lattice.seed
    }

    /// Returns the shape of the pupil.
    pub const fn pupil(&self) -> Pupil {
        self.pupil
    }

    /// Returns the law of the phasors.
    pub const fn phasors(&self) -> Phasors {
        self.lattice.phasors
    }

    /// Returns the number N of lattice points inside the pupil.
    pub const fn phasor_count(&self) -> usize {
        self.mask.count()
    }

    /// Returns the diameter `2√(N/π)` of the disc whose area is the pupil's N lattice cells.
    ///
    /// With it the Airy autocovariance of a circular pupil holds within 1.3e−3 in every direction at
    /// C = 32, and within 3e−4 at C = 128. With the nominal C these are 4.1e−3 and 6e−4.
    pub fn effective_diameter(&self) -> f64 {
        2.0 * (to_f64(self.phasor_count()) / PI).sqrt()
    }

    /// Returns the speckle size `Q / C`, in samples.
    ///
    /// This is the period of the intensity's cut-off frequency, `λ d / D` on the sensor. The first
    /// zero of a circular pupil's autocovariance lies at 1.22 speckle sizes, its full width at half
    /// maximum is 1.03.
    pub fn speckle_size(&self) -> f64 {
        to_f64(self.size()) / to_f64(self.diameter)
    }

    /// Returns the exact amplitude correlation μ of two samples that are `lag` samples apart.
    ///
    /// ```text
    /// μ(lag) = 1/N Σ exp(−2πi k·lag / Q)
    /// ```
    ///
    /// It is real, 1 at zero lag, and has the period Q. The autocovariance of the intensity is
    /// `μ²` for Gaussian phasors and `μ² − 1/N` for unit phasors.
    ///
    /// # Panics
    ///
    /// Panics unless both lags are finite.
    pub fn amplitude_correlation(&self, lag: [f64; 2]) -> f64 {
        assert!(
            lag.iter().all(|l| l.is_finite()),
            "the lag {lag:?} is not finite"
        );
        self.mask.correlation(lag, self.size())
    }

    /// Returns the fraction of the pupil's lattice points it shares with itself, displaced.
    ///
    /// `shift` is in lattice points, on the torus. The value is counted, not approximated, and is
    /// the amplitude correlation of the fields at two offsets that differ by `shift`.
    pub fn overlap(&self, shift: [i64; 2]) -> f64 {
        to_f64(self.mask.overlap_count(shift, self.size())) / to_f64(self.phasor_count())
    }

    /// Returns the intensity behind the undisplaced pupil.
    pub fn pattern(&self) -> SpecklePattern {
        self.pattern_at([0, 0])
    }

    /// Returns the intensity behind the pupil displaced by `offset` lattice points.
    pub fn pattern_at(&self, offset: [i64; 2]) -> SpecklePattern {
        let scale = self.intensity_scale();
        let values = self
            .transform
            .forward(&self.aperture(offset, None), |_, _, value| {
                scale * value.norm_sqr()
            });
        SpecklePattern::new(values, self.speckle_size())
    }

    /// Returns the complex amplitude behind the undisplaced pupil.
    pub fn field(&self) -> SpeckleField {
        self.field_at([0, 0])
    }

    /// Returns the complex amplitude behind the pupil displaced by `offset` lattice points.
    pub fn field_at(&self, offset: [i64; 2]) -> SpeckleField {
        let zero = Complex::new(0.0, 0.0);
        let mut values = Grid::filled(self.size(), self.size(), zero);
        self.amplitude_into(&mut values, offset, None, &mut Fft2Scratch::default());
        SpeckleField::new(values, self.speckle_size())
    }

    /// The amplitude, centred on zero frequency; `filter` weighs the pupil points of each axis.
    pub(crate) fn amplitude_into(
        &self,
        values: &mut Grid<Complex<f32>>,
        offset: [i64; 2],
        filter: Option<&[Vec<f32>; 2]>,
        scratch: &mut Fft2Scratch,
    ) {
        let [half_width, half_height] = self.mask.half_extent();
        let centre_x = self.centring_phase(half_width);
        let centre_y = self.centring_phase(half_height);
        let aperture = self.aperture(offset, filter);
        self.transform
            .forward_into(&aperture, values, scratch, |x, y, value| {
                value * centre_x[x] * centre_y[y]
            });
    }

    pub(crate) const fn mask(&self) -> &Mask {
        &self.mask
    }

    /// The phasors inside the pupil, its bounding box at the corner of the transform's array.
    fn aperture(&self, offset: [i64; 2], filter: Option<&[Vec<f32>; 2]>) -> Grid<Complex<f32>> {
        let [half_width, half_height] = self.mask.half_extent();
        let zero = Complex::new(0.0, 0.0);
        let mut aperture = Grid::filled(2 * half_width + 1, 2 * half_height + 1, zero);
        for_each_row(&mut aperture, |y, values| {
            let row = self.mask.row(y.abs_diff(half_height));
            let ky = offset[1] + to_i64(y) - to_i64(half_height);
            let start = half_width - row.outer;
            let kx = offset[0] - to_i64(row.outer);
            self.lattice
                .fill_row([kx, ky], &mut values[start..=half_width + row.outer]);
            if let Some(hole) = row.hole {
                values[half_width - hole..=half_width + hole].fill(zero);
            }
            if let Some([filter_x, filter_y]) = filter {
                for (value, weight) in values.iter_mut().zip(filter_x) {
                    *value *= weight * filter_y[y];
                }
            }
        });
        aperture
    }

    /// exp(2πi half x / Q) N^(−1/4): moves the pupil's centre from the index `half` to zero
    /// frequency. The normalisation 1/√N is shared by the two axes.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "amplitudes are stored as f32"
    )]
    fn centring_phase(&self, half: usize) -> Vec<Complex<f32>> {
        let size = self.size();
        let scale = to_f64(self.phasor_count()).powf(-0.25);
        (0..size)
            .map(|x| {
                let turns = to_f64(half * x % size) / to_f64(size);
                let phase = Complex::from_polar(scale, 2.0 * PI * turns);
                Complex::new(phase.re as f32, phase.im as f32)
            })
            .collect()
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "intensities are stored as f32"
    )]
    fn intensity_scale(&self) -> f32 {
        (1.0 / to_f64(self.phasor_count())) as f32
    }

    /// The phasor at a lattice point.
    #[cfg(test)]
    pub(crate) fn phasor(&self, k: [i64; 2]) -> Complex<f32> {
        let mut value = [Complex::new(0.0, 0.0)];
        self.lattice.fill_row(k, &mut value);
        value[0]
    }
}

impl PartialEq for PupilField {
    fn eq(&self, other: &Self) -> bool {
        // The mask and the plan follow from these.
        self.lattice == other.lattice
            && self.diameter == other.diameter
            && self.pupil == other.pupil
    }
}

/// The displacement of the torus nearest to `to − from`.
pub(crate) fn nearest_shift(from: [i64; 2], to: [i64; 2], size: usize) -> [i64; 2] {
    let along = |axis: usize| crate::mask::signed(wrap_to(to[axis] - from[axis], size), size);
    [along(0), along(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(size: usize, diameter: usize, seeds: u64) -> Vec<PupilField> {
        (0..seeds)
            .map(|seed| PupilField::new(size, diameter, seed).unwrap())
            .collect()
    }

    fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
        let count = to_f64(values.len());
        values.sum::<f64>() / count
    }

    /// Mean of (I(r) − 1)(I(r + lag) − 1) over the tile.
    fn autocovariance(pattern: &SpecklePattern, [x, y]: [i64; 2]) -> f64 {
        let (size, values) = (pattern.size(), pattern.values());
        mean((0..size * size).map(|index| {
            let (column, row) = (index % size, index / size);
            let there = values.wrapped(to_i64(column) + x, to_i64(row) + y);
            (f64::from(values[(column, row)]) - 1.0) * (f64::from(*there) - 1.0)
        }))
    }

    /// U(r) by its definition, in `f64`.
    fn amplitude_by_definition(field: &PupilField, offset: [i64; 2], r: [f64; 2]) -> Complex<f64> {
        let half = to_i64(field.diameter() / 2);
        let mut sum = Complex::new(0.0, 0.0);
        for ky in -half..=half {
            for kx in -half..=half {
                if 4 * (kx * kx + ky * ky) > to_i64(field.diameter().pow(2)) {
                    continue;
                }
                let p = field.phasor([kx + offset[0], ky + offset[1]]);
                #[expect(clippy::cast_precision_loss, reason = "small integers")]
                let turns = (kx as f64 * r[0] + ky as f64 * r[1]) / to_f64(field.size());
                let wave = Complex::from_polar(1.0, -2.0 * PI * turns);
                sum += Complex::new(f64::from(p.re), f64::from(p.im)) * wave;
            }
        }
        sum / to_f64(field.phasor_count()).sqrt()
    }

    #[test]
    fn the_field_is_the_sum_over_the_pupil() {
        for (size, diameter) in [(17, 8), (24, 12), (25, 11), (36, 9)] {
            let field = PupilField::new(size, diameter, 5).unwrap();
            for offset in [[0, 0], [-3, 7], [to_i64(size) - 1, 2]] {
                let amplitude = field.field_at(offset);
                let pattern = field.pattern_at(offset);
                for (x, y) in [(0, 0), (1, 0), (0, 1), (5, 11), (size - 1, size - 2)] {
                    let expected = amplitude_by_definition(&field, offset, [to_f64(x), to_f64(y)]);
                    let got = amplitude.values()[(x, y)];
                    let error =
                        (f64::from(got.re) - expected.re).hypot(f64::from(got.im) - expected.im);
                    // An f32 transform of 600 points: a few 2⁻²⁴ of the norm 1.
                    assert!(
                        error < 2e-6,
                        "Q = {size}, {offset:?}, ({x}, {y}): {error:e}"
                    );
                    let intensity = f64::from(pattern.values()[(x, y)]);
                    assert!(
                        (intensity - expected.norm_sqr()).abs() < 1e-5,
                        "{intensity}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_mean_of_every_tile_is_one() {
        for (size, diameter) in [(16, 8), (63, 31), (128, 64), (100, 20)] {
            for field in fields(size, diameter, 4) {
                let pattern = field.pattern();
                let mean = mean(pattern.values().values().iter().map(|&i| f64::from(i)));
                // Parseval; the phasors and the transform are rounded to f32.
                assert!((mean - 1.0).abs() < 1e-6, "Q = {size}: mean {mean}");
            }
        }
    }

    #[test]
    fn squared_contrast_is_one_less_one_over_the_phasor_count() {
        const TILES: u32 = 24;
        for (size, diameter) in [(48, 8), (64, 32), (128, 32)] {
            let fields = fields(size, diameter, u64::from(TILES));
            let expected = 1.0 - 1.0 / to_f64(fields[0].phasor_count());
            let squared = mean(fields.iter().map(|f| autocovariance(&f.pattern(), [0, 0])));
            // One tile's squared contrast has the standard deviation 1.53/C; α = 6e−5.
            let tolerance = 4.0 * 1.53 / to_f64(diameter) / f64::from(TILES).sqrt();
            assert!(
                (squared - expected).abs() < tolerance,
                "{squared} for {expected}"
            );
        }
    }

    #[test]
    fn autocovariance_is_the_squared_mask_transform() {
        const TILES: u32 = 24;
        let unit = fields(64, 16, u64::from(TILES));
        for phasors in [Phasors::Unit, Phasors::Gaussian] {
            let fixed_mean = match phasors {
                Phasors::Unit => 1.0 / to_f64(unit[0].phasor_count()),
                Phasors::Gaussian => 0.0,
            };
            let patterns: Vec<_> = unit
                .iter()
                .map(|field| field.clone().with_phasors(phasors).pattern())
                .collect();
            for lag in [[0, 0], [1, 0], [0, 1], [2, 2], [-3, 1], [5, 0], [20, 9]] {
                let covariance = mean(patterns.iter().map(|p| autocovariance(p, lag)));
                #[expect(clippy::cast_precision_loss, reason = "small integers")]
                let mu = unit[0].amplitude_correlation(lag.map(|l| l as f64));
                let expected = mu * mu - fixed_mean;
                // The deviation of a covariance is at most that of the squared contrast, 1.53/C;
                // Gaussian phasors add 2/√N ≈ 2.26/C of a fluctuating mean. α = 6e−5.
                let deviation = if phasors == Phasors::Unit { 1.53 } else { 2.73 };
                let tolerance = 4.0 * deviation / 16.0 / f64::from(TILES).sqrt();
                let difference = covariance - expected;
                assert!(
                    difference.abs() < tolerance,
                    "{phasors:?} at {lag:?}: {difference}"
                );
            }
        }
    }

    #[test]
    fn airy_pattern_is_the_correlation_with_the_effective_diameter() {
        let field = PupilField::new(256, 32, 0).unwrap();
        for lag in [1.0, 2.5, 4.0, 8.0, 11.0, 16.0] {
            let argument = PI * lag * field.effective_diameter() / 256.0;
            let airy = tem00_numerics::jinc(argument).powi(2);
            let exact = field.amplitude_correlation([lag, 0.0]).powi(2);
            // The lattice disc is not quite round: at most 1.2e−3 along the axes at C = 32.
            assert!(
                (exact - airy).abs() < 1.3e-3,
                "at {lag}: {exact} and {airy}"
            );
        }
    }

    #[test]
    fn intensity_has_no_spectrum_beyond_the_pupil_diameter() {
        let (size, diameter) = (80, 17);
        let pattern = PupilField::new(size, diameter, 3).unwrap().pattern();
        let intensity = pattern.values().map(|&i| Complex::new(i, 0.0));
        let spectrum = Fft2::new(size, size)
            .unwrap()
            .forward(&intensity, |x, y, value| {
                let along = |k| crate::mask::signed(k, size);
                (along(x).pow(2) + along(y).pow(2), value.norm() / 6_400.0)
            });
        let (mut inside, mut outside) = (0.0_f32, 0.0_f32);
        for &(k2, magnitude) in spectrum.values() {
            if k2 > to_i64(diameter * diameter) {
                outside = outside.max(magnitude);
            } else if k2 > 0 {
                inside = inside.max(magnitude);
            }
        }
        // Rounding of 6400 values of 1e−7 each, averaged.
        assert!(outside < 1e-6, "spectrum {outside:e} beyond the support");
        assert!(inside > 0.01, "no spectrum inside the support: {inside}");
    }

    #[test]
    fn displaced_pupils_share_the_phasors_of_their_overlap() {
        let field = PupilField::new(48, 20, 11).unwrap();
        let here = field.field();
        for shift in [[3, 0], [-4, 9], [20, 0], [45, 50]] {
            let there = field.field_at(shift);
            let mut sum = Complex::new(0.0, 0.0);
            for y in 0..48_u32 {
                for x in 0..48_u32 {
                    #[expect(clippy::cast_precision_loss, reason = "small integers")]
                    let turns =
                        (shift[0] as f64 * f64::from(x) + shift[1] as f64 * f64::from(y)) / 48.0;
                    let frame = Complex::from_polar(1.0, -2.0 * PI * turns);
                    let index = (x as usize, y as usize);
                    let (a, b) = (here.values()[index], there.values()[index]);
                    let product = a * b.conj();
                    sum +=
                        Complex::new(f64::from(product.re), f64::from(product.im)) * frame.conj();
                }
            }
            // Parseval: the mean of U₁ U₂* in the common frame is the number of shared phasors.
            let correlation = sum / 2_304.0;
            let error = (correlation - field.overlap(shift)).norm();
            assert!(error < 1e-6, "{shift:?}: {correlation}");
        }
    }

    #[test]
    fn gaussian_phasors_let_the_mean_of_a_tile_fluctuate() {
        const TILES: u32 = 200;
        let variance = mean(fields(32, 16, u64::from(TILES)).into_iter().map(|field| {
            let pattern = field.with_phasors(Phasors::Gaussian).pattern();
            (mean(pattern.values().values().iter().map(|&i| f64::from(i))) - 1.0).powi(2)
        }));
        // The mean of N = 197 exponentials has the variance 1/N. The estimate from n tiles deviates
        // by √((2 + 6/N)/n) of it: 3.3 standard deviations, α = 1e−3.
        let ratio = variance * 197.0;
        let tolerance = 3.3 * (2.03 / f64::from(TILES)).sqrt();
        assert!((ratio - 1.0).abs() < tolerance, "variance · N = {ratio}");
    }

    #[test]
    fn sizes_without_a_pattern_are_refused() {
        let diameter = |diameter, size| Err(SpeckleError::Diameter { diameter, size });
        assert_eq!(PupilField::new(256, 129, 0), diameter(129, 256));
        assert_eq!(PupilField::new(255, 128, 0), diameter(128, 255));
        assert_eq!(PupilField::new(256, 7, 0), diameter(7, 256));
        assert_eq!(PupilField::new(0, 0, 0), diameter(0, 0));
        assert_eq!(
            PupilField::new(1_000_000, 500_000, 0),
            Err(SpeckleError::Size(1_000_000))
        );
        let message = PupilField::new(256, 129, 0).unwrap_err().to_string();
        assert!(
            message.contains("129") && message.contains("128 of 256"),
            "the message says the value and what is allowed: {message}"
        );
    }

    #[test]
    fn fields_cross_threads() {
        fn check<T: Send + Sync>() {}
        check::<PupilField>();
        check::<crate::SpeckleStack>();
        check::<crate::paper::BilinearStack>();
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn patterns_are_the_same_bits_for_any_number_of_threads() {
        let field = PupilField::new(96, 40, 8).unwrap();
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| field.pattern_at([5, 6]))
        };
        assert_eq!(with_threads(1), with_threads(3));
    }
}
