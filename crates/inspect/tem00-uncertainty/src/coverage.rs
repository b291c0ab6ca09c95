use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use tem00_numerics::check;

use crate::UncertaintyError;

/// From this many degrees of freedom on, the quantiles of Student's t are the quantiles of a normal
/// distribution plus a term in 1/ν, to 10⁻⁸.
const NEARLY_NORMAL: f64 = 1e5;

/// Probability with which a coverage interval contains the value of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct CoverageProbability(f64);

impl CoverageProbability {
    /// 95 %.
    pub const P95: Self = Self(0.95);
    /// 99 %.
    pub const P99: Self = Self(0.99);

    /// Creates a coverage probability.
    ///
    /// # Errors
    ///
    /// Returns an error unless it is from 0.5 to 0.9999.
    pub fn new(probability: f64) -> Result<Self, UncertaintyError> {
        Ok(Self(check::range(
            "probability",
            probability,
            [0.5, 0.9999],
            "",
        )?))
    }

    /// Returns the probability.
    pub const fn value(self) -> f64 {
        self.0
    }
}

/// Returns the effective degrees of freedom of a combined standard uncertainty, after Welch and
/// Satterthwaite; infinite if the degrees of freedom of all contributions are.
///
/// ```text
/// ν_eff = u⁴ / Σ (uᵢ⁴ / νᵢ)
/// ```
///
/// Each contribution is its standard uncertainty, in the unit of the `combined` one, and its
/// degrees of freedom, greater than 0 and possibly infinite. Contributions with finite degrees of
/// freedom are independent.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, eq. (G.2b).
pub fn effective_degrees_of_freedom(combined: f64, contributions: &[(f64, f64)]) -> f64 {
    // As fractions of the combined uncertainty, so that no power leaves the range of numbers.
    let terms = contributions
        .iter()
        .map(|(u, freedom)| (u / combined).powi(4) / freedom);
    let sum = terms.sum::<f64>();
    // NaN, of contributions that are all 0 or cancel, is not.
    if sum > 0.0 {
        sum.recip()
    } else {
        f64::INFINITY
    }
}

/// Returns the factor k by which a standard uncertainty is multiplied for an interval that covers
/// the value with a probability p: the (1 + p)/2 quantile of Student's t.
///
/// `degrees_of_freedom` is at least 1 and may be infinite, where k is 1.960 for 95 %. Less, or NaN,
/// counts as 1, which has the greatest k: 12.71 for 95 %.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, G.3 and table G.2.
pub fn coverage_factor(degrees_of_freedom: f64, probability: CoverageProbability) -> f64 {
    let quantile = 0.5 * (1.0 + probability.value());
    let freedom = degrees_of_freedom.max(1.0);
    if freedom < NEARLY_NORMAL
        && let Ok(student) = StudentsT::new(0.0, 1.0, freedom)
    {
        return student.inverse_cdf(quantile);
    }
    let normal = Normal::standard().inverse_cdf(quantile);
    // The first term in 1/ν (Abramowitz and Stegun, eq. 26.7.5).
    normal + (normal.powi(3) + normal) / (4.0 * freedom)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    #[test]
    fn coverage_factors_are_those_of_the_table() {
        // JCGM 100:2008, table G.2, columns 95 % and 99 %.
        for (freedom, k95, k99) in [
            (1.0, 12.71, 63.66),
            (2.0, 4.30, 9.92),
            (3.0, 3.18, 5.84),
            (5.0, 2.57, 4.03),
            (10.0, 2.23, 3.17),
            (16.0, 2.12, 2.92),
            (20.0, 2.09, 2.85),
            (50.0, 2.01, 2.68),
            (100.0, 1.984, 2.626),
            (f64::INFINITY, 1.960, 2.576),
        ] {
            // Half a unit of the last digit.
            let rounding = if freedom > 99.0 { 0.0005 } else { 0.005 };
            let probabilities = [CoverageProbability::P95, CoverageProbability::P99];
            for (probability, k) in probabilities.into_iter().zip([k95, k99]) {
                let found = coverage_factor(freedom, probability);
                assert!((found - k).abs() <= rounding, "{freedom}: {found}, {k}");
            }
        }
        for freedom in [0.5, -2.0, f64::NAN] {
            let found = coverage_factor(freedom, CoverageProbability::P95);
            assert!((found - 12.71).abs() < 0.005, "{freedom}: {found}");
        }
    }

    #[test]
    fn coverage_factors_go_on_where_t_is_nearly_normal() {
        let factor = |freedom| coverage_factor(freedom, CoverageProbability::P99);
        let (below, above) = (factor(0.999_999 * NEARLY_NORMAL), factor(NEARLY_NORMAL));
        // The term in 1/ν differs by 5e-11 between both; the next one is 8 / ν² = 8e-10 of it.
        assert!((below - above).abs() < 2e-9, "{below}, {above}");
    }

    #[test]
    fn known_contributions_have_infinite_degrees_of_freedom() {
        for (combined, contributions) in [
            (0.0, &[][..]),
            (0.0, &[(0.0, 3.0)]),
            (0.0, &[(1.0, f64::INFINITY), (1.0, f64::INFINITY)]),
            (2.0, &[(1e-200, f64::INFINITY), (2.0, f64::INFINITY)]),
        ] {
            let freedom = effective_degrees_of_freedom(combined, contributions);
            assert!(freedom.is_infinite(), "{contributions:?}: {freedom}");
        }
        let tiny = effective_degrees_of_freedom(3e-200, &[(3e-200, 5.0), (0.0, 1.0)]);
        assert!((tiny - 5.0).abs() < 1e-12, "{tiny}");
    }

    #[test]
    fn probabilities_outside_the_range_are_refused() {
        refuses!(probability = 0.5 => CoverageProbability::new(probability);
            probability: [0.499, 0.999_91, 95.0, f64::NAN]);
        assert!(CoverageProbability::new(0.9999).is_ok(), "the largest");
    }
}
