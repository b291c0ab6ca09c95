use tem00_numerics::cast::to_usize;

use crate::CoverageProbability;

/// Choice among the intervals that cover a value with the same probability.
///
/// # References
///
/// - JCGM 101:2008, § 7.7.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntervalKind {
    /// The interval with equal probabilities that the value lies below and above it.
    #[default]
    Symmetric,
    /// The shortest interval, which contains the mode of a distribution with one peak. Both of its
    /// ends scatter together, with the cube root of the number of trials; its length scatters no
    /// more than the length of other intervals.
    Shortest,
}

/// Interval that contains the value of a quantity with a coverage probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoverageInterval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl CoverageInterval {
    /// Returns the length of the interval.
    pub fn length(&self) -> f64 {
        self.high - self.low
    }

    /// Returns the interval of sorted values (JCGM 101, § 7.7).
    ///
    /// Of M values q = pM, rounded, lie from the lower end to below the upper one. Fewer than 1/(1
    /// − p) values have their range as the interval.
    ///
    /// # Panics
    ///
    /// Panics unless `values.len() ≥ 1`.
    pub fn of_sorted(values: &[f64], probability: CoverageProbability, kind: IntervalKind) -> Self {
        let (count, probability) = (values.len(), probability.value());
        let between = to_usize((probability * count as f64).round()).min(count - 1);
        let first = match kind {
            // The document counts from 1.
            IntervalKind::Symmetric => (count - between).div_ceil(2) - 1,
            IntervalKind::Shortest => shortest(values, between),
        };
        Self {
            low: values[first],
            high: values[first + between],
        }
    }
}

/// Returns the start of the shortest interval that has `between` values behind its lower end; the
/// first of several.
fn shortest(values: &[f64], between: usize) -> usize {
    let length = |first: &usize| values[first + between] - values[*first];
    let shorter = |a: usize, b: usize| if length(&b) < length(&a) { b } else { a };
    (0..values.len() - between).reduce(shorter).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(values: &[f64], probability: f64, kind: IntervalKind) -> String {
        let CoverageInterval { low, high } = CoverageInterval::of_sorted(
            values,
            CoverageProbability::new(probability).unwrap(),
            kind,
        );
        format!("{low} to {high}")
    }

    #[test]
    fn a_symmetric_interval_leaves_as_many_values_below_as_above() {
        let numbers: Vec<f64> = (1..=10_000).map(f64::from).collect();
        // q = 9500, r = 250 (JCGM 101, § 7.7.2).
        let found = interval(&numbers, 0.95, IntervalKind::Symmetric);
        assert_eq!(found, "250 to 9750", "even");
        // q = 9495, r = int((9995 − 9495 + 1)/2) = 250.
        let found = interval(&numbers[..9995], 0.95, IntervalKind::Symmetric);
        assert_eq!(found, "250 to 9745", "odd");
    }

    #[test]
    fn the_shortest_interval_lies_where_values_are_dense() {
        let squares: Vec<f64> = (0..1000).map(|i| f64::from(i * i)).collect();
        let found = interval(&squares, 0.9, IntervalKind::Shortest);
        assert_eq!(found, "0 to 810000", "dense below");
        let mirrored: Vec<f64> = squares.iter().rev().map(|x| 0.0 - x).collect();
        let found = interval(&mirrored, 0.9, IntervalKind::Shortest);
        assert_eq!(found, "-810000 to 0", "dense above");
        let even: Vec<f64> = (0..100).map(f64::from).collect();
        let found = interval(&even, 0.9, IntervalKind::Shortest);
        assert_eq!(found, "0 to 90", "the first of equal ones");
    }

    #[test]
    fn few_values_have_their_range() {
        for kind in [IntervalKind::Symmetric, IntervalKind::Shortest] {
            for count in [1, 2, 9] {
                let values: Vec<f64> = (1..=count).map(f64::from).collect();
                assert_eq!(interval(&values, 0.95, kind), format!("1 to {count}"));
            }
        }
    }
}
