use tem00_numerics::{
    cast::to_f32,
    check, fractions,
    seed::{Purpose, derived},
};

use crate::{PupilField, SpeckleError, SpecklePattern};

/// The largest number of patterns in a sum.
const MAX_PATTERNS: usize = 1024;

/// Returns the fractions of the light in independent speckle patterns whose intensities add.
///
/// ```text
/// I = Σ wⱼ Iⱼ          Σ wⱼ = 1, Iⱼ independent patterns of mean 1
/// ```
///
/// The light consists of `patterns` equal patterns. Each consists of two waves with the fractions
/// `(1 ± P)/2`, where P is the degree of `polarisation`, and each wave has parts with the mean
/// intensities `weights`, in any unit: several lasers, or the coherent modes of a broad spectrum.
/// Parts without light are left out. P is the degree of polarisation of the light at the sensor: 1
/// behind a polariser, near 0 for laser light from white paper without one.
///
/// The contrast is `√(Σ wⱼ²)`; `tem00_statistics::IncoherentSum` gives the distribution. Under
/// equal motion every part has the same correlation, so that look-up coordinates are the same as
/// for one pattern.
///
/// # Errors
///
/// Returns an error unless `0 ≤ polarisation ≤ 1`, if a weight is negative or not finite, if no
/// weight is positive, or unless there are between 1 and 1024 patterns in all.
///
/// # Examples
///
/// Unpolarised light of two lasers, one of them twice as strong as the other, as a pattern and by
/// look-ups:
///
/// ```
/// use tem00_speckle::{
///     PupilField, SlicePath, SpecklePattern, SpeckleStack, incoherent_fractions,
/// };
///
/// let fractions = incoherent_fractions(1, 0.0, &[2.0, 1.0])?;
/// let fields = PupilField::new(64, 16, 1)?.independent(fractions.len())?;
/// let patterns = fields.iter().map(PupilField::pattern);
/// let pattern = SpecklePattern::weighted_mean(&fractions, patterns)?;
///
/// let mut intensity = 0.0;
/// for (field, fraction) in fields.iter().zip(&fractions) {
///     let stack = SpeckleStack::generate(field, SlicePath::Still)?;
///     intensity += fraction * stack.intensity_at(5.0, 7.0, 0.0);
/// }
/// assert!((intensity - f64::from(pattern.values()[(5, 7)])).abs() < 0.02);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 3 (sums of speckle patterns).
pub fn incoherent_fractions(
    patterns: usize,
    polarisation: f64,
    weights: &[f64],
) -> Result<Vec<f64>, SpeckleError> {
    let holds = (0.0..=1.0).contains(&polarisation);
    check::that(holds, "polarisation", polarisation, "", "between 0 and 1")?;
    check_count(patterns)?;
    let fractions = vec![(patterns as f64).recip(); patterns];
    let waves = [0.5 * (1.0 + polarisation), 0.5 * (1.0 - polarisation)];
    split(&split(&fractions, &waves)?, weights)
}

/// The fractions when every pattern is divided by `weights`.
fn split(whole: &[f64], weights: &[f64]) -> Result<Vec<f64>, SpeckleError> {
    let lit = |weights: &[f64]| -> Result<Vec<f64>, SpeckleError> {
        let mut lit = fractions("weights", weights)?;
        lit.retain(|&fraction| fraction > 0.0);
        Ok(lit)
    };
    let parts = lit(weights)?;
    check_count(whole.len() * parts.len())?;
    let products = |fraction| parts.iter().map(move |part| fraction * part);
    lit(&whole.iter().flat_map(products).collect::<Vec<_>>())
}

fn check_count(patterns: usize) -> Result<(), SpeckleError> {
    let holds = (1..=MAX_PATTERNS).contains(&patterns);
    Ok(check::that(
        holds,
        "patterns",
        patterns,
        "",
        "1 to 1024 in all",
    )?)
}

impl PupilField {
    /// Returns the fields of `patterns` independent patterns: this field, then the same field with
    /// seeds derived from its seed.
    ///
    /// Two fields made from different seeds are the same with a probability of 2⁻⁶⁴ only.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ patterns ≤ 1024`, or if the field was made from samples and
    /// there is more than one pattern: samples cannot provide independent patterns.
    pub fn independent(&self, patterns: usize) -> Result<Vec<Self>, SpeckleError> {
        check_count(patterns)?;
        match self.seed() {
            None if patterns > 1 => Err(SpeckleError::refused(
                "field",
                "one of samples",
                "a seeded field for independent patterns",
            )),
            None => Ok(vec![self.clone()]),
            Some(seed) => Ok((0..patterns)
                .map(|index| {
                    self.clone()
                        .with_seed(derived(seed, Purpose::Pattern, index as u64))
                })
                .collect()),
        }
    }
}

impl SpecklePattern {
    /// Returns the mean of patterns with weights in any unit: light that adds by intensities.
    ///
    /// Its mean intensity is 1 if the mean intensity of every pattern is 1, and its speckle size is
    /// the one of the first pattern.
    ///
    /// # Errors
    ///
    /// Returns an error if a weight is negative or not finite, if no weight is positive, or unless
    /// there are as many patterns as weights, all of one size.
    pub fn weighted_mean(
        weights: &[f64],
        patterns: impl IntoIterator<Item = Self>,
    ) -> Result<Self, SpeckleError> {
        let fractions = fractions("weights", weights)?;
        let mut patterns = patterns.into_iter();
        let count = |count: usize| {
            let allowed = "as many as there are weights";
            SpeckleError::refused("patterns", count as f64, allowed)
        };
        let first = patterns.next().ok_or_else(|| count(0))?;
        let (size, speckle_size) = (first.size(), first.speckle_size());
        let mut sum = first
            .into_values()
            .map(|&value| to_f32(fractions[0]) * value);
        for (index, fraction) in fractions.iter().enumerate().skip(1) {
            let pattern = patterns.next().ok_or_else(|| count(index))?;
            if pattern.size() != size {
                let [width, _] = pattern.size();
                let allowed = "all of one size";
                return Err(SpeckleError::refused("patterns", width as f64, allowed));
            }
            let pairs = sum.values_mut().iter_mut().zip(pattern.values().values());
            pairs.for_each(|(sum, value)| *sum += to_f32(*fraction) * value);
        }
        match patterns.next() {
            Some(_) => Err(count(fractions.len() + 1)),
            None => Ok(Self::new(sum, speckle_size)),
        }
    }
}

#[cfg(test)]
mod tests;
