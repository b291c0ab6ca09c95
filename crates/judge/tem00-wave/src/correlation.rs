use num_complex::Complex;
use tem00_numerics::Grid;

use crate::field::largest_magnitude;

/// A measured value and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The measured value.
    pub value: f64,
    /// The standard error of the value.
    pub standard_error: f64,
}

impl Estimate {
    /// Returns the mean of repeated measurements and its standard error `s/√n`, or `None` for fewer
    /// than two measurements.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_wave::Estimate;
    ///
    /// let mean = Estimate::of_repetitions(&[0.9, 1.0, 1.1]).unwrap();
    /// assert!((mean.value - 1.0).abs() < 1e-15);
    /// assert!((mean.standard_error - 0.1 / 3.0_f64.sqrt()).abs() < 1e-15);
    /// ```
    pub fn of_repetitions(values: &[f64]) -> Option<Self> {
        if values.len() < 2 {
            return None;
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            value: mean,
            standard_error: (squares / (count * (count - 1.0))).sqrt(),
        })
    }
}

/// Correlation of two fields of fully developed speckle, over one or more repetitions.
///
/// ```text
/// γ = |⟨U₁ U₂*⟩|² / (⟨|U₁|²⟩ ⟨|U₂|²⟩)
/// ```
///
/// It equals the correlation of their intensities and needs fewer samples. The fields are compared
/// sample by sample, phases included: a displacement of the pattern is not compensated, and a phase
/// that varies across the field lowers the value.
///
/// # Validity
///
/// With K independent speckles in total, the expected value exceeds γ by about `(1 − γ)² / K`.
///
/// # Examples
///
/// ```
/// use tem00_wave::{Complex, FieldCorrelation, Grid};
///
/// let first = Grid::from_fn(2, 1, |x, _| Complex::new(1.0, x as f64));
/// let second = first.map(|u| u * Complex::new(0.0, 3.0));
/// let mut correlation = FieldCorrelation::default();
/// correlation.add(&first, &second);
/// assert!((correlation.value().unwrap() - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldCorrelation {
    repetitions: Vec<Products>,
    /// The largest magnitude of either field in the first repetition.
    scales: Option<[f64; 2]>,
}

/// Sums over one repetition.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Products {
    mixed: Complex<f64>,
    first: f64,
    second: f64,
}

impl core::ops::Sub for Products {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            mixed: self.mixed - other.mixed,
            first: self.first - other.first,
            second: self.second - other.second,
        }
    }
}

impl Products {
    fn correlation(self) -> Option<f64> {
        let power = self.first * self.second;
        (power > 0.0).then(|| self.mixed.norm_sqr() / power)
    }
}

impl FieldCorrelation {
    /// Adds one repetition: two fields of the same surface.
    ///
    /// # Panics
    ///
    /// Panics unless both fields have the same size.
    pub fn add(&mut self, first: &Grid<Complex<f64>>, second: &Grid<Complex<f64>>) {
        assert!(
            first.width() == second.width() && first.height() == second.height(),
            "fields of different sizes"
        );
        let scale_of = |field: &Grid<Complex<f64>>| match largest_magnitude(field.values()) {
            0.0 => 1.0,
            largest => largest,
        };
        let [a, b] = *self
            .scales
            .get_or_insert_with(|| [scale_of(first), scale_of(second)]);
        let mut sum = Products {
            mixed: Complex::new(0.0, 0.0),
            first: 0.0,
            second: 0.0,
        };
        for (u, v) in first.values().iter().zip(second.values()) {
            let (u, v) = (u / a, v / b);
            sum.mixed += u * v.conj();
            sum.first += u.norm_sqr();
            sum.second += v.norm_sqr();
        }
        self.repetitions.push(sum);
    }

    /// Returns the correlation over all repetitions, or `None` if a field was dark throughout.
    pub fn value(&self) -> Option<f64> {
        self.total()?.correlation()
    }

    /// Returns the correlation with its standard error from the scatter of the repetitions, or
    /// `None` if there are fewer than two repetitions or a field was dark throughout.
    ///
    /// The error is estimated by the jackknife, which leaves out one repetition at a time (Efron
    /// and Stein 1981).
    pub fn estimate(&self) -> Option<Estimate> {
        let (total, count) = (self.total()?, self.repetitions.len() as f64);
        let without = |one: &Products| (total - *one).correlation();
        let partial: Vec<f64> = self
            .repetitions
            .iter()
            .map(without)
            .collect::<Option<_>>()?;
        let spread = Estimate::of_repetitions(&partial)?.standard_error;
        Some(Estimate {
            value: total.correlation()?,
            standard_error: spread * (count - 1.0),
        })
    }

    /// Returns the correlation with the standard error for the number of `independent` speckles in
    /// all repetitions together, or `None` if this number is below one or a field was dark
    /// throughout.
    ///
    /// ```text
    /// σ = (1 − γ) √(2γ/K + 1/K²)
    /// ```
    ///
    /// The number of speckles is about the area of the field divided by the area of a speckle,
    /// `(4/π) h²` for a round pupil with the speckle size h.
    pub fn estimate_from_speckles(&self, independent: f64) -> Option<Estimate> {
        let value = self.value().filter(|_| independent >= 1.0)?;
        let variance = 2.0 * value / independent + independent.powi(-2);
        Some(Estimate {
            value,
            standard_error: (1.0 - value).max(0.0) * variance.sqrt(),
        })
    }

    fn total(&self) -> Option<Products> {
        self.repetitions.iter().copied().reduce(|a, b| Products {
            mixed: a.mixed + b.mixed,
            first: a.first + b.first,
            second: a.second + b.second,
        })
    }
}

#[cfg(test)]
mod tests;
