//! What a displacement along the axis takes of the correlation beside one across the pupil, as a polynomial.

use core::f64::consts::PI;

use tem00_decorrelation::{CorrelationLaw, pupil_overlap_correlation};

/// Coefficients along each axis.
const TERMS: usize = 12;

/// The factor by which an axial displacement reduces the correlation at the peak, beside a displacement of the pupil.
///
/// ```text
/// γ(s, x) / γ(s, 0)       s from 0 to 1 pupil diameter, x from 0 to 1 decorrelation length
/// ```
///
/// It is analytic in s and x², so that a polynomial at Chebyshev's points meets the integral of
/// [`CorrelationLaw::AtPeak`] within 1e−5: only arithmetic, which several points at a time share in vector units.
#[derive(Debug)]
pub(super) struct AxialLoss {
    /// Of the products of powers of 2 s − 1 and of 2 x² − 1.
    coefficients: [[f64; TERMS]; TERMS],
}

impl AxialLoss {
    pub(super) fn new() -> Self {
        let factors = nodes().map(|shift| nodes().map(|square| factor(shift, square.sqrt())));
        let along = |values| powers(coefficients(values));
        let over_shift = transposed(factors).map(along);
        Self {
            coefficients: transposed(over_shift).map(along),
        }
    }

    /// Writes the factors for the first `count` shifts of the pupil and along the axis, each counted up to 1.
    #[inline(always)]
    pub(super) fn write<const N: usize>(
        &self,
        count: usize,
        [pupil_shifts, axial_shifts]: [&[f64; N]; 2],
        factors: &mut [f64; N],
    ) {
        let count = count.min(N);
        let s = pupil_shifts.map(|shift| 2.0 * shift.min(1.0) - 1.0);
        let y = axial_shifts.map(|shift| 2.0 * (shift * shift).min(1.0) - 1.0);
        factors.fill(0.0);
        // Horner's rule, step by step for all points.
        for row in self.coefficients.iter().rev() {
            let mut sums = [0.0; N];
            for coefficient in row.iter().rev() {
                for i in 0..count {
                    sums[i] = sums[i] * y[i] + coefficient;
                }
            }
            for i in 0..count {
                factors[i] = factors[i] * s[i] + sums[i];
            }
        }
        for factor in factors {
            *factor = factor.clamp(0.0, 1.0);
        }
    }
}

fn factor(pupil_shift: f64, axial_shift: f64) -> f64 {
    CorrelationLaw::AtPeak.correlation(pupil_shift, axial_shift)
        / pupil_overlap_correlation(pupil_shift)
}

/// Chebyshev's points of [0, 1].
fn nodes() -> [f64; TERMS] {
    core::array::from_fn(|i| 0.5 + 0.5 * angle(i).cos())
}

fn angle(index: usize) -> f64 {
    PI * (index as f64 + 0.5) / TERMS as f64
}

/// The coefficients of Chebyshev's polynomials, from the values at his points.
fn coefficients(values: [f64; TERMS]) -> [f64; TERMS] {
    core::array::from_fn(|k| {
        let parts = values.iter().enumerate();
        let sum: f64 = parts
            .map(|(i, value)| value * (k as f64 * angle(i)).cos())
            .sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / TERMS as f64
    })
}

/// The coefficients of powers for those of Chebyshev's polynomials: `T_{k+1}(t) = 2 t T_k(t) − T_{k−1}(t)`.
fn powers(chebyshev: [f64; TERMS]) -> [f64; TERMS] {
    let (mut before, mut this) = ([0.0; TERMS], [0.0; TERMS]);
    this[0] = 1.0;
    let mut sum = [0.0; TERMS];
    for (k, coefficient) in chebyshev.into_iter().enumerate() {
        let double = if k == 0 { 1.0 } else { 2.0 };
        let next = |power: usize| match power.checked_sub(1) {
            Some(lower) => double * this[lower] - before[power],
            None => -before[power],
        };
        sum.iter_mut()
            .zip(this)
            .for_each(|(sum, part)| *sum += coefficient * part);
        (before, this) = (this, core::array::from_fn(next));
    }
    sum
}

fn transposed(rows: [[f64; TERMS]; TERMS]) -> [[f64; TERMS]; TERMS] {
    core::array::from_fn(|column| rows.map(|row| row[column]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polynomial_meets_the_integral() {
        let loss = AxialLoss::new();
        let (mut worst, mut factor) = (0.0_f64, [0.0]);
        for (i, j) in (0..=200).flat_map(|i| (0..=200).map(move |j| (i, j))) {
            let (shift, axial) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
            let exact = CorrelationLaw::AtPeak.correlation(shift, axial);
            loss.write(1, [&[shift], &[axial]], &mut factor);
            let found = pupil_overlap_correlation(shift) * factor[0];
            worst = worst.max((found - exact).abs());
        }
        assert!(worst < 1e-5, "off by {worst:e}");
    }
}
