use tem00_numerics::{Refusal, cast::to_usize, check, parallel};

use crate::{
    CoverageInterval, CoverageProbability, FirstOrder, Inputs, IntervalKind, UncertaintyError,
    moments::Moments, trials,
};

/// Options of a propagation of distributions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PropagationOptions {
    /// The probability of the coverage interval.
    pub probability: CoverageProbability,
    /// The coverage interval whose ends are to be stable.
    pub interval: IntervalKind,
    /// The significant digits of the standard uncertainty that are to be stable, from 1 to 4.
    pub digits: u8,
    /// A number, at least 1, by which the numerical tolerance of these digits is divided: 5 where
    /// the trials validate a first order (JCGM 101, § 8.2).
    pub tolerance_divisor: f64,
    /// The maximum number of trials.
    pub max_trials: u64,
    /// The seed of all random numbers.
    pub seed: u64,
}

impl Default for PropagationOptions {
    /// Two digits, a symmetric interval of 95 %, at most 10⁷ trials.
    fn default() -> Self {
        Self {
            probability: CoverageProbability::P95,
            interval: IntervalKind::Symmetric,
            digits: 2,
            tolerance_divisor: 1.0,
            max_trials: 10_000_000,
            seed: 0,
        }
    }
}

/// The propagation of distributions by trials, as many as make its results stable.
///
/// Blocks of M = max(⌈100/(1 − p)⌉, 10⁴) trials are drawn until twice the standard deviations of
/// the averages of the estimate, the standard uncertainty and both ends of the coverage interval
/// are at most the numerical tolerance δ = ½ 10^ℓ of the standard uncertainty c · 10^ℓ, whose c has
/// the requested number of digits.
///
/// Each block has its own random numbers, so that the result is the same for any number of threads;
/// the feature `parallel` brings them.
///
/// The [front page](crate) has an example.
///
/// # References
///
/// - JCGM 101:2008, § 7.6, 7.7 and 7.9.
#[derive(Clone, Debug, PartialEq)]
pub struct Propagation {
    options: PropagationOptions,
    values: Vec<f64>,
    moments: Moments,
    largest_error: f64,
}

/// Agreement of the ends of a coverage interval by first order and by trials.
///
/// # References
///
/// - JCGM 101:2008, § 8.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validation {
    /// The distance `d_low` of the lower ends.
    pub low: f64,
    /// The distance `d_high` of the upper ends.
    pub high: f64,
    /// The numerical tolerance δ of the standard uncertainty.
    pub tolerance: f64,
}

impl Validation {
    /// Returns whether the first order may be used: neither distance exceeds the tolerance.
    pub fn is_valid(&self) -> bool {
        self.low.max(self.high) <= self.tolerance
    }
}

impl Propagation {
    /// Draws values of a model until they are stable or their number is the maximum.
    ///
    /// # Errors
    ///
    /// Returns an error if an option is outside its range, if fewer trials are allowed than two
    /// blocks have, if a t distribution has 2 degrees of freedom or fewer, or if a value of the
    /// model, or the variance of all, is not finite.
    pub fn new(
        inputs: &Inputs,
        model: impl Fn(&[f64]) -> f64 + Sync,
        options: PropagationOptions,
    ) -> Result<Self, UncertaintyError> {
        let trials = options.checked_block()?;
        inputs.check_variances()?;
        let blocks = options.max_trials / trials as u64;
        let mut result = Self {
            options,
            values: Vec::new(),
            moments: Moments::default(),
            largest_error: f64::INFINITY,
        };
        let mut summaries = Vec::new();
        let mut next = 0;
        while next < blocks && !result.is_stable() {
            let range = next..blocks.min(next + parallel::thread_count() as u64);
            next = range.end;
            let of_block = |block| trials::block((inputs, &model), (options.seed, block), trials);
            for values in trials::map(range, of_block) {
                // Threads may have drawn more than are needed.
                if !result.is_stable() {
                    result.add(values?, &mut summaries)?;
                }
            }
        }
        // The stable sort merges the blocks, which are sorted.
        result.values.sort_by(f64::total_cmp);
        Ok(result)
    }

    /// Adds the values of a block.
    fn add(
        &mut self,
        mut values: Vec<f64>,
        summaries: &mut Vec<[f64; 4]>,
    ) -> Result<(), UncertaintyError> {
        let moments = Moments::of(&values);
        values.sort_unstable_by(f64::total_cmp);
        let (kind, probability) = (self.options.interval, self.options.probability);
        let interval = CoverageInterval::of_sorted(&values, probability, kind);
        summaries.push([
            moments.mean,
            moments.deviation(),
            interval.low,
            interval.high,
        ]);
        self.values.append(&mut values);
        self.moments = match summaries.len() {
            1 => moments,
            _ => self.moments.and(moments),
        };
        if !self.uncertainty().is_finite() {
            let allowed = "of finite variance";
            return Err(Refusal::new("model", self.uncertainty(), allowed).into());
        }
        self.largest_error = 2.0 * largest_deviation_of_averages(summaries);
        Ok(())
    }

    /// Returns the options.
    pub const fn options(&self) -> &PropagationOptions {
        &self.options
    }

    /// Returns the estimate: the mean of all values.
    pub const fn estimate(&self) -> f64 {
        self.moments.mean
    }

    /// Returns the standard uncertainty: the standard deviation of all values.
    pub fn uncertainty(&self) -> f64 {
        self.moments.deviation()
    }

    /// Returns the requested coverage interval.
    pub fn interval(&self) -> CoverageInterval {
        let (probability, kind) = (self.options.probability, self.options.interval);
        CoverageInterval::of_sorted(&self.values, probability, kind)
    }

    /// Returns all values of the model, from the smallest to the largest.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the numerical tolerance that the results were to meet.
    pub fn tolerance(&self) -> f64 {
        self.options.tolerance(self.uncertainty())
    }

    /// Returns twice the largest standard deviation of the averages of estimate, standard
    /// uncertainty and ends of the coverage interval.
    pub const fn largest_error(&self) -> f64 {
        self.largest_error
    }

    /// Returns whether all results are stable; otherwise the number of trials was not enough.
    pub fn is_stable(&self) -> bool {
        self.largest_error <= self.tolerance()
    }

    /// Compares the coverage interval of a first order with the interval of the trials.
    ///
    /// The trials should be stable with a
    /// [`tolerance_divisor`](PropagationOptions::tolerance_divisor) of 5.
    pub fn validate(&self, first_order: &FirstOrder) -> Validation {
        let interval = self.interval();
        let of_first_order = first_order.interval(self.options.probability);
        Validation {
            low: (of_first_order.low - interval.low).abs(),
            high: (of_first_order.high - interval.high).abs(),
            tolerance: numerical_tolerance(self.uncertainty(), self.options.digits),
        }
    }
}

impl PropagationOptions {
    /// Returns the number of trials of a block.
    fn checked_block(&self) -> Result<usize, UncertaintyError> {
        check::range("digits", f64::from(self.digits), [1.0, 4.0], "")?;
        let divisor = self.tolerance_divisor;
        let (holds, allowed) = (
            (1.0..f64::INFINITY).contains(&divisor),
            "at least 1 and finite",
        );
        check::that(holds, "tolerance_divisor", divisor, "", allowed)?;
        let trials = (100.0 / (1.0 - self.probability.value())).ceil().max(1e4);
        let (max, allowed) = (
            self.max_trials as f64,
            "at least two blocks of 10⁴, or of 100/(1 − p) if that is more",
        );
        check::that(max >= 2.0 * trials, "max_trials", max, "", allowed)?;
        Ok(to_usize(trials))
    }

    fn tolerance(&self, uncertainty: f64) -> f64 {
        numerical_tolerance(uncertainty, self.digits) / self.tolerance_divisor
    }
}

/// Returns the largest of the standard deviations of the averages of the results of blocks;
/// infinite for a single block.
fn largest_deviation_of_averages(summaries: &[[f64; 4]]) -> f64 {
    if summaries.len() < 2 {
        return f64::INFINITY;
    }
    let deviation = |index: usize| {
        let found: Vec<f64> = summaries.iter().map(|summary| summary[index]).collect();
        Moments::of(&found).deviation() / (found.len() as f64).sqrt()
    };
    (0..4).map(deviation).fold(0.0, f64::max)
}

/// Returns the numerical tolerance δ = ½ 10^ℓ of a number c · 10^ℓ whose c has `digits` digits
/// (JCGM 101, § 7.9.2); 0 for 0.
fn numerical_tolerance(number: f64, digits: u8) -> f64 {
    if number == 0.0 {
        return 0.0;
    }
    let rounded = format!("{number:.*e}", usize::from(digits) - 1);
    let exponent = rounded
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    0.5 * 10.0_f64.powi(exponent.unwrap_or_default() + 1 - i32::from(digits))
}

#[cfg(test)]
mod tests;
