/// Probability that χ² of `freedom` degrees exceeds `value`.
#[must_use]
pub fn chi_squared_survival(value: f64, freedom: u32) -> f64 {
    let x = 0.5 * value.max(0.0);
    // Q(a + 1, x) = Q(a, x) + xᵃ e⁻ˣ / Γ(a + 1), from a = 1/2 or 1 on.
    let (start, mut sum) = if freedom.is_multiple_of(2) {
        (1.0, (-x).exp())
    } else {
        (0.5, libm::erfc(x.sqrt()))
    };
    let mut order = start;
    while 2.0 * order < f64::from(freedom) {
        sum += (order * x.ln() - x - libm::lgamma(order + 1.0)).exp();
        order += 1.0;
    }
    sum.min(1.0)
}

/// p-value of Pearson's χ² test of counts against their expectations, less `constraints` degrees
/// of freedom.
#[must_use]
#[track_caller]
pub fn chi_squared(observed: &[f64], expected: &[f64], constraints: u32) -> f64 {
    assert_eq!(
        observed.len(),
        expected.len(),
        "one expectation for each bin"
    );
    assert!(
        expected.iter().all(|&e| e >= 5.0),
        "bins that expect less than 5: {expected:?}"
    );
    let pairs = observed.iter().zip(expected);
    let sum = pairs.map(|(o, e)| (o - e).powi(2) / e).sum();
    chi_squared_survival(sum, expected.len() as u32 - constraints)
}

/// p-value of the Kolmogorov–Smirnov test of samples against a cumulative distribution, by
/// Stephens' approximation, from 5 samples on.
#[must_use]
#[track_caller]
pub fn kolmogorov_smirnov(samples: &mut [f64], cumulative: impl Fn(f64) -> f64) -> f64 {
    assert!(!samples.is_empty(), "samples");
    samples.sort_by(f64::total_cmp);
    let count = samples.len() as f64;
    let distances = samples.iter().enumerate().map(|(i, &x)| {
        let f = cumulative(x);
        (f - i as f64 / count).max((i as f64 + 1.0) / count - f)
    });
    let root = count.sqrt();
    let lambda = distances.fold(0.0, f64::max) * (root + 0.12 + 0.11 / root);
    kolmogorov_survival(lambda)
}

fn kolmogorov_survival(lambda: f64) -> f64 {
    // Below, the series converges slowly towards 1.
    if lambda < 0.2 {
        return 1.0;
    }
    let term = |k: i32| f64::from(4 * (k % 2) - 2) * (-2.0 * (f64::from(k) * lambda).powi(2)).exp();
    (1..100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_relative;

    #[test]
    fn survivals_are_those_of_the_tables() {
        for (freedom, p, value) in [(1, 0.05, 3.841), (10, 0.95, 3.940), (5, 0.01, 15.086)] {
            assert_relative(chi_squared_survival(value, freedom), p, 1e-3);
        }
        for (lambda, p) in [(1.3581, 0.05), (1.6276, 0.01), (0.82757, 0.5)] {
            assert_relative(kolmogorov_survival(lambda), p, 2e-3);
        }
    }

    #[test]
    fn counts_of_another_distribution_are_improbable() {
        let fair = chi_squared(&[98.0, 105.0, 97.0], &[100.0; 3], 1);
        assert_relative(fair, (-0.19_f64).exp(), 1e-12);
        let loaded = chi_squared(&[70.0, 130.0], &[100.0; 2], 1);
        assert!(loaded < 1e-4, "a loaded coin: {loaded}");
    }
}
