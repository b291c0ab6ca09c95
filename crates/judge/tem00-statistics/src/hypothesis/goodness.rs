use crate::{
    StatisticsError, TestOutcome, chi_squared, estimate::moments::check_samples,
    hypothesis::samples::checked_probability, kolmogorov_smirnov, test::GreyLevels,
};

/// The number of bins of the χ² test.
const BINS: u32 = 20;

/// Agreement of samples, rounded or not, with a law.
///
/// Samples are compared on the scale of the law's distribution function, where they are uniform in
/// [0, 1] if they follow the law. Rounded samples are spread evenly within the cell of their level,
/// as the law is, so that only the fractions of the samples up to the edges of the levels are
/// compared. Without this spreading, few grey levels would be a deviation from any continuous law.
///
/// # Independence
///
/// The samples must be independent: use
/// [`decorrelated_samples`](crate::estimate::decorrelated_samples).
///
/// # Validity
///
/// For rounded samples the p-values are too high: a step of the law between two edges is not
/// detected.
///
/// # Examples
///
/// ```
/// use tem00_statistics::{
///     exponential_cumulative, kolmogorov_smirnov,
///     test::{GoodnessOfFit, GreyLevels},
/// };
///
/// // Speckle of a mean of three grey levels.
/// let law = |light: f64| exponential_cumulative(light / 3.0);
/// let quantile = |i| -3.0 * (1.0 - (f64::from(i) + 0.5) / 2_000.0_f64).ln();
/// let rounded: Vec<f64> = (0..2_000).map(|i| quantile(i).round()).collect();
/// assert!(kolmogorov_smirnov(&rounded, law)?.p_value < 1e-6);
///
/// let levels = GreyLevels::from_values(&rounded).expect("a few whole numbers");
/// let fit = GoodnessOfFit::of_rounded(&rounded, &levels, law)?;
/// assert!(fit.kolmogorov_smirnov()?.p_value > 0.999);
/// assert!(fit.chi_squared(1)?.p_value > 0.999);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GoodnessOfFit {
    /// The samples on the scale of the distribution function.
    places: Vec<f64>,
    /// Values at which bins may begin, in ascending order.
    edges: Vec<f64>,
}

impl GoodnessOfFit {
    /// Compares samples that were not rounded with the law that has the distribution function
    /// `cumulative`.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no sample, one is not finite, or `cumulative` returns a value
    /// outside [0, 1].
    pub fn new(samples: &[f64], cumulative: impl Fn(f64) -> f64) -> Result<Self, StatisticsError> {
        check_samples(samples, 1)?;
        let probability = |&sample: &f64| checked_probability(sample, cumulative(sample));
        Ok(Self {
            places: samples.iter().map(probability).collect::<Result<_, _>>()?,
            edges: (1..BINS).map(quantile).collect(),
        })
    }

    /// Compares samples that were rounded to `levels` with the law that has the distribution
    /// function `cumulative`. The function is evaluated at the edges of the levels, the last of
    /// which may be infinite.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn of_rounded(
        samples: &[f64],
        levels: &GreyLevels,
        cumulative: impl Fn(f64) -> f64,
    ) -> Result<Self, StatisticsError> {
        check_samples(samples, 1)?;
        let cells = (0..levels.count()).flat_map(|index| levels.cell(index));
        for edge in cells {
            checked_probability(edge, cumulative(edge))?;
        }
        let edge = |index| cumulative(levels.cell(index)[0]);
        Ok(Self {
            places: levels.places(samples, &cumulative),
            edges: (1..levels.count()).map(edge).collect(),
        })
    }

    /// Applies the Kolmogorov–Smirnov test, as [`kolmogorov_smirnov`](crate::kolmogorov_smirnov)
    /// does.
    ///
    /// The distance of rounded samples is the distance at the edges of the levels, or larger by up
    /// to half of one sample's fraction of its cell.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`kolmogorov_smirnov`](crate::kolmogorov_smirnov).
    pub fn kolmogorov_smirnov(&self) -> Result<TestOutcome, StatisticsError> {
        kolmogorov_smirnov(&self.places, |place| place)
    }

    /// Applies Pearson's test, as [`chi_squared`](crate::chi_squared) does, in up to 20 bins of
    /// about the same probability. `constraints` is 1 for the total plus 1 for each fitted
    /// parameter of the law.
    ///
    /// # Errors
    ///
    /// Returns an error if the bins do not outnumber the constraints, as with few levels or
    /// samples.
    pub fn chi_squared(&self, constraints: usize) -> Result<TestOutcome, StatisticsError> {
        let edges = self.bin_edges();
        let mut observed = vec![0_u64; edges.len() + 1];
        for &place in &self.places {
            observed[edges.partition_point(|&edge| edge <= place)] += 1;
        }
        let starts = core::iter::once(&0.0).chain(&edges);
        let ends = edges.iter().chain(core::iter::once(&1.0));
        let total = self.places.len() as f64;
        let expected: Vec<_> = starts
            .zip(ends)
            .map(|(start, end)| (end - start) * total)
            .collect();
        chi_squared(&observed, &expected, constraints)
    }

    /// Returns the edges nearest to the quantiles.
    fn bin_edges(&self) -> Vec<f64> {
        let nearest = |target: f64| {
            let distance = |edge: &&f64| (**edge - target).abs();
            let closer = |a: &&f64, b: &&f64| distance(a).total_cmp(&distance(b));
            self.edges.iter().min_by(closer).copied()
        };
        let mut edges: Vec<f64> = (1..BINS).map(quantile).filter_map(nearest).collect();
        edges.dedup_by(|next, edge| *next <= *edge);
        edges
    }
}

fn quantile(bin: u32) -> f64 {
    f64::from(bin) / f64::from(BINS)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;
    use crate::{GammaIntensity, exponential_cumulative};

    const MEAN: f64 = 3.0;

    /// Quantiles of the exponential distribution with the mean 3.
    fn quantiles(count: u32) -> Vec<f64> {
        let at = |i: u32| -MEAN * (1.0 - (f64::from(i) + 0.5) / f64::from(count)).ln();
        (0..count).map(at).collect()
    }

    fn rounded(samples: &[f64]) -> (Vec<f64>, GreyLevels) {
        let rounded: Vec<f64> = samples.iter().map(|sample| sample.round()).collect();
        #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
        let values: Vec<f32> = rounded.iter().map(|&value| value as f32).collect();
        let levels = GreyLevels::from_values(&values).expect("few levels");
        (rounded, levels)
    }

    fn exponential(light: f64) -> f64 {
        exponential_cumulative(light / MEAN)
    }

    #[test]
    fn rounded_samples_agree_with_the_law_that_they_were_rounded_from() {
        let (samples, levels) = rounded(&quantiles(2_000));
        let raw = GoodnessOfFit::new(&samples, exponential).expect("valid");
        let p_value = |placed: &GoodnessOfFit| placed.kolmogorov_smirnov().expect("valid").p_value;
        assert!(p_value(&raw) < 1e-6, "the steps are deviations");
        let placed = GoodnessOfFit::of_rounded(&samples, &levels, exponential).expect("valid");
        assert!(p_value(&placed) > 0.999, "their edges are none");
        assert!(
            placed.chi_squared(1).expect("valid").p_value > 0.999,
            "{placed:?}"
        );
    }

    #[test]
    fn rounded_samples_of_another_law_are_told_apart() {
        let (samples, levels) = rounded(&quantiles(2_000));
        let law = GammaIntensity::new(1.5).expect("valid");
        let cumulative = |light: f64| law.cumulative(light / MEAN);
        let placed = GoodnessOfFit::of_rounded(&samples, &levels, cumulative).expect("valid");
        assert!(
            placed.kolmogorov_smirnov().expect("valid").p_value < 1e-6,
            "KS"
        );
        assert!(placed.chi_squared(1).expect("valid").p_value < 1e-6, "χ²");
    }

    #[test]
    fn distance_of_rounded_samples_is_that_at_the_edges() {
        // Ten samples of 0, thirty of 1 and sixty of 2, against an even law on [0, 2.5].
        let counts = [(0.0, 10), (1.0, 30), (2.0, 60)];
        let samples: Vec<f64> = counts
            .iter()
            .flat_map(|&(level, count)| core::iter::repeat_n(level, count))
            .collect();
        let (_, levels) = rounded(&samples);
        let even = |light: f64| (light / 2.5).min(1.0);
        let placed = GoodnessOfFit::of_rounded(&samples, &levels, even).expect("valid");
        // At 0.5 the law has 0.2 and the samples 0.1, at 1.5 they have 0.6 and 0.4. The places are
        // placed like continuous samples, whose distance is up to 1/2n larger.
        let distance = placed.kolmogorov_smirnov().expect("valid").statistic;
        assert!((0.2..=0.205).contains(&distance), "{distance}");
        // Bins of 0.2, 0.4 and 0.4: (10 − 20)²/20 + (30 − 40)²/40 + (60 − 40)²/40.
        let statistic = placed.chi_squared(1).expect("valid").statistic;
        assert_relative(statistic, 17.5, 1e-12);
    }

    #[test]
    fn samples_that_were_not_rounded_fill_twenty_bins() {
        let samples = quantiles(2_000);
        let placed = GoodnessOfFit::new(&samples, exponential).expect("valid");
        assert_eq!(placed.bin_edges().len(), 19);
        // Each bin holds its hundred quantiles.
        assert!(
            placed.chi_squared(2).expect("valid").statistic < 1e-9,
            "{placed:?}"
        );
    }
}
