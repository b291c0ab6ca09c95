//! How well samples agree with a law, whether they were rounded or not.

use tem00_statistics::{StatisticsError, TestOutcome, chi_squared, kolmogorov_smirnov};

use super::GreyLevels;

/// The number of bins of the χ² test.
const BINS: u32 = 20;

/// Samples on the scale of the distribution function of a law: even in [0, 1] if they follow it.
///
/// Rounded samples lie evenly within the cell of their level, which law and samples therefore fill
/// alike: what is compared are the shares of the samples up to the edges of the levels.
#[derive(Debug)]
pub(super) struct Placed {
    places: Vec<f64>,
    /// Where bins may begin, in ascending order.
    edges: Vec<f64>,
}

impl Placed {
    pub(super) fn new(
        samples: &[f64],
        levels: Option<&GreyLevels>,
        cumulative: impl Fn(f64) -> f64,
    ) -> Self {
        match levels {
            Some(levels) => Self {
                places: levels.places(samples, &cumulative),
                edges: (1..levels.len())
                    .map(|index| cumulative(levels.cell(index)[0]))
                    .collect(),
            },
            None => Self {
                places: samples.iter().map(|&sample| cumulative(sample)).collect(),
                edges: (1..BINS).map(quantile).collect(),
            },
        }
    }

    pub(super) fn kolmogorov_smirnov(&self) -> Result<TestOutcome, StatisticsError> {
        kolmogorov_smirnov(&self.places, |place| place)
    }

    /// Compares the counts in bins of about the same probability, of which `constraints` were
    /// fitted.
    #[expect(clippy::cast_precision_loss, reason = "there are at most 2²⁸ samples")]
    pub(super) fn chi_squared(&self, constraints: usize) -> Result<TestOutcome, StatisticsError> {
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
    use approx::assert_relative_eq;
    use tem00_statistics::{GammaIntensity, exponential_cumulative};

    use super::*;

    const MEAN: f64 = 3.0;

    /// Quantiles of the exponential law of the mean 3.
    fn quantiles(count: u32) -> Vec<f64> {
        let at = |i: u32| -MEAN * (1.0 - (f64::from(i) + 0.5) / f64::from(count)).ln();
        (0..count).map(at).collect()
    }

    fn rounded(samples: &[f64]) -> (Vec<f64>, GreyLevels) {
        let rounded: Vec<f64> = samples.iter().map(|sample| sample.round()).collect();
        #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
        let values: Vec<f32> = rounded.iter().map(|&value| value as f32).collect();
        let levels = GreyLevels::of(&values).expect("few levels");
        (rounded, levels)
    }

    fn exponential(light: f64) -> f64 {
        exponential_cumulative(light / MEAN)
    }

    #[test]
    fn rounded_samples_agree_with_the_law_that_they_were_rounded_from() {
        let (samples, levels) = rounded(&quantiles(2_000));
        let raw = Placed::new(&samples, None, exponential);
        let p_value = |placed: &Placed| placed.kolmogorov_smirnov().expect("valid").p_value;
        assert!(p_value(&raw) < 1e-6, "the steps are deviations");
        let placed = Placed::new(&samples, Some(&levels), exponential);
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
        let placed = Placed::new(&samples, Some(&levels), |light| {
            law.cumulative(light / MEAN)
        });
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
        let placed = Placed::new(&samples, Some(&levels), |light| (light / 2.5).min(1.0));
        // At 0.5 the law has 0.2 and the samples 0.1, at 1.5 they have 0.6 and 0.4. The places are
        // those of continuous samples, whose distance is up to 1/2n larger.
        let distance = placed.kolmogorov_smirnov().expect("valid").statistic;
        assert!((0.2..=0.205).contains(&distance), "{distance}");
        // Bins of 0.2, 0.4 and 0.4: (10 − 20)²/20 + (30 − 40)²/40 + (60 − 40)²/40.
        let statistic = placed.chi_squared(1).expect("valid").statistic;
        assert_relative_eq!(statistic, 17.5, max_relative = 1e-12);
    }

    #[test]
    fn samples_that_were_not_rounded_fill_twenty_bins() {
        let samples = quantiles(2_000);
        let placed = Placed::new(&samples, None, exponential);
        assert_eq!(placed.bin_edges().len(), 19);
        // Each bin holds its hundred quantiles.
        assert!(
            placed.chi_squared(2).expect("valid").statistic < 1e-9,
            "{placed:?}"
        );
    }
}
