use tem00_numerics::cast::to_f32;

use crate::{PupilField, SpeckleError, SpecklePattern};

/// Independent speckle patterns whose intensities add, each with its fraction of the light.
///
/// ```text
/// I = Σ wⱼ Iⱼ          Σ wⱼ = 1, Iⱼ independent patterns of mean 1
/// C = √(Σ wⱼ²)         contrast, for fully developed patterns
/// ```
///
/// Several lasers, both polarisations and the coherent modes of a broad spectrum are all of this form, and
/// [`split_by`](Self::split_by) combines them. The mean is exactly 1 where that of every pattern is.
///
/// # Patterns and stacks
///
/// [`pattern`](Self::pattern) adds patterns: pass [`PupilField::pattern`], or a closure that
/// displaces the pupil or exposes. For look-ups, build one stack per [field](Self::fields) and weigh
/// what they return with [`intensity`](Self::intensity). Coordinates and correlations stay those of
/// one stack: equal motion leaves every part of the sum with the same correlation.
///
/// # Examples
///
/// Unpolarised light of two lasers, one of them twice as strong:
///
/// ```
/// use tem00_speckle::{IncoherentSum, PupilField, SlicePath, SpeckleStack};
///
/// let lasers = IncoherentSum::weighted(&[2.0, 1.0])?;
/// let light = lasers.split_by(&IncoherentSum::partially_polarised(0.0)?)?;
/// assert!((light.contrast() - (5.0_f64 / 9.0 / 2.0).sqrt()).abs() < 1e-12);
///
/// let field = PupilField::new(64, 16, 1)?;
/// let pattern = light.pattern(&field, PupilField::pattern)?;
///
/// // The same light by look-ups: four stacks.
/// let stacks = light
///     .fields(&field)?
///     .iter()
///     .map(|part| SpeckleStack::generate(part, SlicePath::Still))
///     .collect::<Result<Vec<_>, _>>()?;
/// let intensity = light.intensity(|part| stacks[part].intensity_at(5.0, 7.0, 0.0));
/// assert!((intensity - f64::from(pattern.values()[(5, 7)])).abs() < 0.02);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (sums of speckle patterns).
#[derive(Clone, Debug, PartialEq)]
pub struct IncoherentSum {
    weights: Vec<f64>,
}

impl IncoherentSum {
    /// The largest number of patterns in a sum.
    pub const MAX_PATTERNS: usize = 1024;

    /// Creates the sum of `count` patterns of equal mean: contrast `1/√count`.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ count ≤ MAX_PATTERNS`.
    pub fn equal(count: usize) -> Result<Self, SpeckleError> {
        if !(1..=Self::MAX_PATTERNS).contains(&count) {
            return Err(not_a_count(count as f64));
        }
        Ok(Self {
            weights: vec![(count as f64).recip(); count],
        })
    }

    /// Creates the sum of patterns from their mean intensities, in any unit.
    ///
    /// Patterns without light are left out.
    ///
    /// # Errors
    ///
    /// Returns an error if a weight is negative or not finite, or unless between 1 and `MAX_PATTERNS`
    /// of them are positive.
    pub fn weighted(weights: &[f64]) -> Result<Self, SpeckleError> {
        let bad = |&weight: &f64| !(weight >= 0.0 && weight.is_finite());
        if let Some(index) = weights.iter().position(bad) {
            return Err(SpeckleError::Weight {
                index,
                weight: weights[index],
            });
        }
        // Scaled by the largest first: the sum of the weights may overflow.
        let largest = weights.iter().fold(0.0_f64, |a, &b| a.max(b));
        let scaled = || {
            let scaled = weights.iter().map(|weight| weight / largest);
            scaled.filter(|&weight| weight > 0.0)
        };
        let (count, total) = (scaled().count(), scaled().sum::<f64>());
        if !(1..=Self::MAX_PATTERNS).contains(&count) {
            return Err(not_a_count(count as f64));
        }
        Ok(Self {
            weights: scaled().map(|weight| weight / total).collect(),
        })
    }

    /// Creates partially polarised light of the degree of polarisation P.
    ///
    /// ```text
    /// w = (1 ± P) / 2,     C = √((1 + P²) / 2)
    /// ```
    ///
    /// The degree is that of the light that reaches the sensor: 1 behind a polariser, near 0 for
    /// laser light off white paper without one.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ degree ≤ 1`.
    pub fn partially_polarised(degree: f64) -> Result<Self, SpeckleError> {
        if !(0.0..=1.0).contains(&degree) {
            return Err(SpeckleError::out_of_range(
                "degree",
                degree,
                "between 0 and 1",
            ));
        }
        Self::weighted(&[0.5 * (1.0 + degree), 0.5 * (1.0 - degree)])
    }

    /// Returns this sum with every pattern split as `other` is: light that both laws divide.
    ///
    /// # Errors
    ///
    /// Returns an error if the product of both counts exceeds `MAX_PATTERNS`.
    pub fn split_by(&self, other: &Self) -> Result<Self, SpeckleError> {
        let count = self.weights.len() * other.weights.len();
        if count > Self::MAX_PATTERNS {
            return Err(not_a_count(count as f64));
        }
        let products = |weight| other.weights.iter().map(move |part| weight * part);
        let weights: Vec<f64> = self.weights.iter().flat_map(products).collect();
        Self::weighted(&weights)
    }

    /// Returns the weights of the patterns, which sum to 1.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Returns the contrast `√(Σ w²)` of the sum of fully developed patterns.
    pub fn contrast(&self) -> f64 {
        let squares = self.weights.iter().map(|weight| weight * weight);
        squares.sum::<f64>().sqrt()
    }

    /// Returns one field for each pattern: `field` itself, then the same with seeds made from its
    /// own.
    ///
    /// Two patterns of sums of other seeds are the same with a probability of 2⁻⁶⁴ only.
    ///
    /// # Errors
    ///
    /// Returns an error if `field` was made from samples and there is more than one pattern: samples
    /// are no source of independent ones.
    pub fn fields(&self, field: &PupilField) -> Result<Vec<PupilField>, SpeckleError> {
        match field.seed() {
            None if self.weights.len() > 1 => Err(SpeckleError::NoSeed),
            None => Ok(vec![field.clone()]),
            Some(seed) => Ok((0..self.weights.len())
                .map(|index| field.clone().with_seed(part_seed(seed, index)))
                .collect()),
        }
    }

    /// Returns the sum of what `part` makes of each of the [fields](Self::fields), by their weights.
    ///
    /// # Errors
    ///
    /// As [`fields`](Self::fields).
    ///
    /// # Panics
    ///
    /// Panics unless `part` returns patterns of one size.
    pub fn pattern(
        &self,
        field: &PupilField,
        part: impl Fn(&PupilField) -> SpecklePattern,
    ) -> Result<SpecklePattern, SpeckleError> {
        self.try_pattern(field, |field| Ok(part(field)))
    }

    /// Like [`pattern`](Self::pattern), for a `part` that can fail: the first error ends the sum.
    ///
    /// # Errors
    ///
    /// As [`fields`](Self::fields), and those of `part`.
    ///
    /// # Panics
    ///
    /// Panics unless `part` returns patterns of one size.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{IncoherentSum, PupilField, SpeckleError};
    ///
    /// let field = PupilField::new(64, 16, 1)?;
    /// let light = IncoherentSum::equal(3)?;
    ///
    /// // Each part with speckles of its own size, as of three wavelengths.
    /// let mut sizes = [4.0, 4.4, 4.8].into_iter();
    /// let pattern = light.try_pattern(&field, |part| {
    ///     let size = sizes.next().unwrap_or(4.0);
    ///     Ok::<_, SpeckleError>(part.clone().with_speckle_size(size)?.pattern())
    /// })?;
    /// assert_eq!(pattern.size(), [64, 64]);
    /// # Ok::<(), SpeckleError>(())
    /// ```
    pub fn try_pattern<E: From<SpeckleError>>(
        &self,
        field: &PupilField,
        mut part: impl FnMut(&PupilField) -> Result<SpecklePattern, E>,
    ) -> Result<SpecklePattern, E> {
        let fields = self.fields(field)?;
        let speckle_size = field.speckle_size();
        let mut sum = part(&fields[0])?.into_values();
        let first = to_f32(self.weights[0]);
        sum.values_mut()
            .iter_mut()
            .for_each(|value| *value *= first);
        for (field, &weight) in fields.iter().zip(&self.weights).skip(1) {
            let weight = to_f32(weight);
            let values = part(field)?.into_values();
            assert!(
                values.width() == sum.width() && values.height() == sum.height(),
                "the patterns of a sum differ in size"
            );
            let pairs = sum.values_mut().iter_mut().zip(values.values());
            pairs.for_each(|(sum, value)| *sum += weight * value);
        }
        Ok(SpecklePattern::new(sum, speckle_size))
    }

    /// Returns the sum of the intensities that `part` gives for the patterns 0, 1, …, in their
    /// weights.
    pub fn intensity(&self, part: impl FnMut(usize) -> f64) -> f64 {
        let parts = (0..self.weights.len()).map(part);
        parts
            .zip(&self.weights)
            .map(|(value, weight)| weight * value)
            .sum()
    }
}

/// The seed of pattern `index` of a sum: its own for the first, scattered over all seeds for the
/// others.
///
/// Were it `seed + index`, the second pattern of one seed would be the first of the next.
const fn part_seed(seed: u64, index: usize) -> u64 {
    match index {
        0 => seed,
        _ => scatter(scatter(seed) ^ scatter(index as u64)),
    }
}

/// Steele, Lea and Flood (2014), the output function of `SplitMix64`.
const fn scatter(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

const fn not_a_count(count: f64) -> SpeckleError {
    SpeckleError::out_of_range("count", count, "1 to 1024 patterns")
}

#[cfg(test)]
mod tests;
