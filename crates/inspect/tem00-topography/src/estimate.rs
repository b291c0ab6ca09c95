use tem00_numerics::{cast::to_usize, quadrature::integrate};

/// Result with its standard uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The standard uncertainty by the spread between repetitions.
    pub uncertainty: f64,
}

/// Result that is the largest of several deviations, to which chance adds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The standard uncertainty by the spread between repetitions.
    pub uncertainty: f64,
    /// The value that is expected of a sensor without any such deviation, by its noise alone.
    pub by_chance: f64,
}

/// The maximum number of groups of repetitions.
const MAX_GROUPS: usize = 16;

/// Returns the statistic of all repetitions, and its standard uncertainty by leaving out one group
/// of them after the other. The statistic is called with the numbers of the repetitions that count.
pub(crate) fn jackknife(
    repetitions: usize,
    statistic: impl Fn(&[usize]) -> Option<f64>,
) -> Option<Estimate> {
    let groups = repetitions.min(MAX_GROUPS);
    let all: Vec<usize> = (0..repetitions).collect();
    let value = statistic(&all)?;
    let without = |group: usize| {
        let kept = all.iter().copied().filter(|index| index % groups != group);
        statistic(&kept.collect::<Vec<_>>())
    };
    let left: Vec<f64> = (0..groups).map(without).collect::<Option<_>>()?;
    let spread: f64 = left.iter().map(|found| (found - mean(&left)).powi(2)).sum();
    let count = groups as f64;
    Some(Estimate {
        value,
        uncertainty: ((count - 1.0) / count * spread).sqrt(),
    })
}

/// Returns the mean; NaN without values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the length of the shortest interval that holds a fraction of the values, from 0 to 1.
pub(crate) fn shortest_interval(mut values: Vec<f64>, part: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let held = to_usize((part * values.len() as f64).ceil());
    let windows = values.windows(held.max(1));
    windows
        .map(|window| window[window.len() - 1] - window[0])
        .min_by(f64::total_cmp)
}

/// The number of standard deviations beyond which no normal number is met.
const FAR: f64 = 9.0;

/// The distribution function of the standard normal law.
fn normal(t: f64) -> f64 {
    0.5 * libm::erfc(-t * core::f64::consts::FRAC_1_SQRT_2)
}

/// Returns the expected maximum of the absolute values of independent standard normal numbers, E =
/// ∫ 1 − (2Φ(t) − 1)ⁿ dt.
pub(crate) fn expected_maximum(count: usize) -> f64 {
    let n = count as f64;
    let above = |t: f64| 1.0 - libm::pow(2.0 * normal(t) - 1.0, n);
    integrate(above, [0.0, FAR], 0.5)
}

/// Returns the expected range of independent standard normal numbers, E = ∫ 1 − Φ(t)ⁿ − (1 − Φ(t))ⁿ
/// dt (L. H. C. Tippett, Biometrika 17, 364, 1925).
pub(crate) fn expected_range(count: usize) -> f64 {
    let n = count as f64;
    let between = |t: f64| 1.0 - libm::pow(normal(t), n) - libm::pow(normal(-t), n);
    integrate(between, [-FAR, FAR], 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values = [1.0, 2.0, 4.0, 9.0];
        let of = |kept: &[usize]| Some(mean(&kept.iter().map(|&i| values[i]).collect::<Vec<_>>()));
        let found = jackknife(4, of).unwrap();
        // s² = (9 + 4 + 0 + 25)/3 about the mean 4.
        let expected = (38.0_f64 / 3.0 / 4.0).sqrt();
        assert!((found.value - 4.0).abs() < 1e-15);
        assert!((found.uncertainty / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn chance_alone_has_the_extremes_of_tables() {
        // Of two: E max|N| = 2/√π, E range = 2/√π; of ten, Tippett's 3.07751.
        let two = 2.0 / core::f64::consts::PI.sqrt();
        assert!((expected_maximum(2) / two - 1.0).abs() < 1e-9);
        assert!((expected_range(2) / two - 1.0).abs() < 1e-9);
        assert!((expected_range(10) - 3.077_51).abs() < 1e-5);
    }

    #[test]
    fn the_shortest_interval_leaves_the_outliers_out() {
        let values = (0..95)
            .map(|i| 0.01 * f64::from(i))
            .chain((0..5).map(|_| 7.0));
        let found = shortest_interval(values.collect(), 0.95).unwrap();
        assert!((found - 0.94).abs() < 1e-12, "{found}");
        assert_eq!(shortest_interval(Vec::new(), 0.95), None);
    }
}
