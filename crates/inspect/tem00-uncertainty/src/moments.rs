/// Number, mean and sum of squared deviations of values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    pub(crate) count: f64,
    pub(crate) mean: f64,
    squares: f64,
}

impl Moments {
    pub(crate) fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        Self {
            count,
            mean,
            squares: values.iter().map(|value| (value - mean).powi(2)).sum(),
        }
    }

    /// Returns the moments of the values of both.
    pub(crate) fn and(self, other: Self) -> Self {
        let count = self.count + other.count;
        let difference = other.mean - self.mean;
        let between = difference * difference * self.count * other.count / count;
        Self {
            count,
            mean: self.mean + difference * other.count / count,
            squares: self.squares + other.squares + between,
        }
    }

    /// Returns the standard deviation of the values, with their number minus one as the divisor.
    pub(crate) fn deviation(&self) -> f64 {
        (self.squares / (self.count - 1.0)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_two_parts_are_those_of_the_whole() {
        let values: Vec<f64> = (0..50).map(|i| f64::from(i * i)).collect();
        let (first, second) = values.split_at(13);
        let found = Moments::of(first).and(Moments::of(second));
        // Sums of i² and i⁴ for i < 50.
        let (sum, squares) = (40_425.0, 59_416_665.0);
        let variance: f64 = (squares - sum * sum / 50.0) / 49.0;
        assert!((found.mean - sum / 50.0).abs() < 1e-10, "{found:?}");
        assert!(
            (found.deviation() - variance.sqrt()).abs() < 1e-10,
            "{found:?}"
        );
    }
}
