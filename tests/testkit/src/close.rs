/// Asserts |got − expected| ≤ tolerance · |expected|.
#[track_caller]
pub fn assert_relative(got: f64, expected: f64, tolerance: f64) {
    assert_absolute(got, expected, tolerance * expected.abs());
}

/// Asserts |got − expected| ≤ tolerance.
#[track_caller]
pub fn assert_absolute(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance,
        "{got:e} is not {expected:e} within {tolerance:e}"
    );
}

/// Pearson's correlation coefficient.
#[must_use]
#[track_caller]
pub fn correlation<T: Copy + Into<f64>>(a: &[T], b: &[T]) -> f64 {
    assert_eq!(a.len(), b.len(), "pairs");
    let count = a.len() as f64;
    let mean = |x: &[T]| x.iter().map(|&x| x.into()).sum::<f64>() / count;
    let means = [mean(a), mean(b)];
    let mut sums = [0.0; 3];
    for (&a, &b) in a.iter().zip(b) {
        let [a, b] = [a.into() - means[0], b.into() - means[1]];
        sums = [sums[0] + a * b, sums[1] + a * a, sums[2] + b * b];
    }
    sums[0] / (sums[1] * sums[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Numbers;

    #[test]
    fn correlations_are_those_of_the_model() {
        let mut numbers = Numbers::new(5);
        let a: Vec<f64> = (0..10_000).map(|_| numbers.normal()).collect();
        let b: Vec<f64> = a.iter().map(|a| 0.6 * a + 0.8 * numbers.normal()).collect();
        assert_absolute(correlation(&a, &b), 0.6, 4.0 * 0.64 / 100.0);
        assert_absolute(correlation(&a, &a), 1.0, 1e-12);
    }
}
