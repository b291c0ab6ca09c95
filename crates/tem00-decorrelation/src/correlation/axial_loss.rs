//! The correlation at the peak as a polynomial, for many points at once.

use core::f64::consts::PI;
use std::sync::OnceLock;

use tem00_numerics::{disc_overlap_inverse, vectorised};

use super::{CorrelationLaw, pupil_overlap_correlation};

/// Coefficients along each axis.
const TERMS: usize = 12;

/// Axial shifts below this one take at most β²/4 = π² x² = 1e-13 of the correlation.
const NO_AXIAL_SHIFT: f64 = 1e-7;

/// The factor by which an axial displacement reduces the correlation at the peak, beside a displacement of the pupil.
///
/// ```text
/// γ(s, x) / γ(s, 0)       s from 0 to 1 pupil diameter, x from 0 to 1 decorrelation length
/// ```
///
/// It is analytic in s and x², so that a polynomial at Chebyshev's points meets the integral of
/// [`CorrelationLaw::AtPeak`] within 1e−5: only arithmetic, which several points at a time share in vector units.
#[derive(Debug)]
pub struct AxialLoss {
    /// Of the products of powers of 2 s − 1 and of 2 x² − 1.
    coefficients: [[f64; TERMS]; TERMS],
}

impl AxialLoss {
    /// Returns the polynomial, which is worked out once.
    pub fn shared() -> &'static Self {
        static LOSS: OnceLock<AxialLoss> = OnceLock::new();
        LOSS.get_or_init(Self::new)
    }

    /// Returns the coefficients of the products of powers of 2 s − 1, row by row, and of 2 x² − 1.
    pub const fn coefficients(&self) -> &[[f64; TERMS]; TERMS] {
        &self.coefficients
    }

    fn new() -> Self {
        let factors = nodes().map(|shift| nodes().map(|square| factor(shift, square.sqrt())));
        let along = |values| powers(coefficients(values));
        let over_shift = transposed(factors).map(along);
        Self {
            coefficients: transposed(over_shift).map(along),
        }
    }

    /// Writes the factors for the first `count` shifts of the pupil and along the axis, each counted up to 1.
    #[inline(always)]
    pub fn write<const N: usize>(
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

/// Replaces the first `count` shifts across the pupil, in its diameters, by those that leave alone the correlation
/// which they leave together with shifts along the axis, in axial decorrelation lengths.
///
/// ```text
/// chat²(s') = γ(s, x)       the law at the peak, CorrelationLaw::AtPeak
/// ```
///
/// Shifts beyond one diameter keep growing, which tells the speckle of two later states apart: exactly so for motion
/// across the line of sight; along it, beyond the first zero of the correlation, by the unit of that zero, without
/// the revival of 4.7 % behind it. Infinite shifts across the pupil stay infinite. The shifts up to the next multiple of
/// 8 may be replaced as well.
///
/// # Examples
///
/// A quarter of the pupil and half a decorrelation length:
///
/// ```
/// use tem00_decorrelation::{CorrelationLaw, add_axial_shifts, pupil_overlap_correlation};
///
/// let mut shift = [0.25];
/// add_axial_shifts(1, &mut shift, &[0.5]);
/// let left = pupil_overlap_correlation(shift[0]);
/// assert!((left - CorrelationLaw::AtPeak.correlation(0.25, 0.5)).abs() < 1e-5);
/// ```
#[inline(always)] // They are read and written where they lie.
pub fn add_axial_shifts<const N: usize>(
    count: usize,
    pupil_shifts: &mut [f64; N],
    axial_shifts: &[f64; N],
) {
    let count = count.min(N);
    let is_lateral = |axial: &f64| axial.abs() < NO_AXIAL_SHIFT;
    if axial_shifts[..count].iter().all(is_lateral) {
        return;
    }
    // Whole vectors are faster than the rest of one.
    let count = count.next_multiple_of(8).min(N);
    let loss = AxialLoss::shared();
    let mut kept = [0.0; N];
    vectorised(
        #[inline(always)]
        || {
            loss.write(count, [pupil_shifts, axial_shifts], &mut kept);
            let axial = axial_shifts.iter().zip(&kept);
            for (pupil, (axial, kept)) in pupil_shifts[..count].iter_mut().zip(axial) {
                *pupil = equivalent_shift(*pupil, axial.abs(), *kept);
            }
        },
    );
}

/// The shift whose overlap leaves as much as a shift across the pupil and one along the axis, which has `kept` a part
/// of what the first has left.
#[inline(always)]
fn equivalent_shift(lateral: f64, axial: f64, kept: f64) -> f64 {
    let equivalent = disc_overlap_inverse((pupil_overlap_correlation(lateral) * kept).sqrt());
    let beyond_the_zero = if axial >= 1.0 { axial } else { 0.0 };
    let both = equivalent.max(lateral).max(beyond_the_zero);
    if axial < NO_AXIAL_SHIFT {
        lateral
    } else {
        both
    }
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

    #[test]
    fn shifts_along_the_axis_add_what_they_take_of_the_correlation() {
        let shift = |lateral, axial| {
            let mut shift = [lateral];
            add_axial_shifts(1, &mut shift, &[axial]);
            shift[0]
        };
        for lateral in [0.0, 1e-3, 0.25, 0.7, 0.98, 1.0, 3.0] {
            for axial in [0.0, 0.99e-7, 1.01e-7, 1e-5, 1e-3, 0.3, 0.9] {
                let shift = shift(lateral, axial);
                let correlation = CorrelationLaw::AtPeak.correlation(lateral, axial);
                let error = pupil_overlap_correlation(shift) - correlation;
                assert!(
                    error.abs() < 1e-5 && shift >= lateral,
                    "{lateral} across, {axial:e} along: {error:e}"
                );
            }
            let beyond = shift(lateral, 1.5) - lateral.max(1.5);
            assert!(beyond.abs() < 1e-15, "{lateral} across: {beyond:e}");
        }
        assert_eq!(shift(f64::INFINITY, 0.5), f64::INFINITY);
    }
}
