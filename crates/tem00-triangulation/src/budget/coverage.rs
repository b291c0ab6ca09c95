use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// From this many degrees of freedom on, Student's t is a normal distribution to 2 · 10⁻⁵ of its
/// quantiles.
const NEARLY_NORMAL: f64 = 1e5;

/// Returns the effective degrees of freedom of a combined standard uncertainty, after Welch and
/// Satterthwaite; infinite if all of the contributions' are.
///
/// ```text
/// ν_eff = u⁴ / Σ (uᵢ⁴ / νᵢ)      u² = Σ uᵢ²
/// ```
///
/// Each contribution is its standard uncertainty, in the unit of the result, and its degrees of
/// freedom, greater than 0 and possibly infinite.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, eq. (G.2b).
pub fn effective_degrees_of_freedom(contributions: &[(f64, f64)]) -> f64 {
    let largest = contributions
        .iter()
        .fold(0.0_f64, |a, (u, _)| a.max(u.abs()));
    if largest == 0.0 {
        return f64::INFINITY;
    }
    // In parts of the largest, so that no power leaves the range of numbers.
    let parts = contributions
        .iter()
        .map(|(u, freedom)| (u / largest, freedom));
    let (square, sum) = parts.fold((0.0, 0.0), |(square, sum), (u, freedom)| {
        (square + u * u, sum + u.powi(4) / freedom)
    });
    if sum > 0.0 {
        square * square / sum
    } else {
        f64::INFINITY
    }
}

/// Returns the factor k by which a standard uncertainty is multiplied for an interval that covers the
/// value with the probability 95 %: the 97.5 % quantile of Student's t.
///
/// `degrees_of_freedom` is at least 1 and may be infinite, where k is 1.960. Less, or NaN, counts
/// as 1, which has the greatest k: 12.71.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, G.3 and table G.2.
pub fn coverage_factor(degrees_of_freedom: f64) -> f64 {
    const QUANTILE: f64 = 0.975;
    let freedom = degrees_of_freedom.max(1.0);
    if freedom < NEARLY_NORMAL
        && let Ok(student) = StudentsT::new(0.0, 1.0, freedom)
    {
        return student.inverse_cdf(QUANTILE);
    }
    Normal::standard().inverse_cdf(QUANTILE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_factors_are_those_of_the_table() {
        // JCGM 100:2008, table G.2, column 95 %.
        for (freedom, k) in [
            (1.0, 12.71),
            (2.0, 4.30),
            (3.0, 3.18),
            (5.0, 2.57),
            (10.0, 2.23),
            (20.0, 2.09),
            (50.0, 2.01),
            (100.0, 1.984),
            (f64::INFINITY, 1.960),
        ] {
            let found = coverage_factor(freedom);
            // Half a unit of the last digit.
            let rounding = if freedom > 99.0 { 0.0005 } else { 0.005 };
            assert!((found - k).abs() <= rounding, "{freedom}: {found}, {k}");
        }
        let (below, above) = (
            coverage_factor(0.99 * NEARLY_NORMAL),
            coverage_factor(1.01e5),
        );
        assert!((below / above - 1.0).abs() < 3e-5, "{below}, {above}");
    }

    #[test]
    fn the_end_gauge_of_the_guide_has_its_degrees_of_freedom() {
        // JCGM 100:2008, H.1: contributions in nm with their degrees of freedom, table H.1.
        let comparator = [(5.8, 24.0), (3.9, 5.0), (6.7, 8.0)];
        let difference = comparator.iter().map(|(u, _)| u * u).sum::<f64>().sqrt();
        assert!((difference - 9.7).abs() < 0.05, "{difference}");
        let of_comparator = effective_degrees_of_freedom(&comparator);
        // H.1.6: 25.6 with the unrounded contributions.
        assert!((of_comparator - 25.6).abs() < 1.0, "{of_comparator}");
        let contributions = [
            (25.0, 18.0),
            (difference, of_comparator),
            (2.9, 50.0),
            (16.6, 2.0),
        ];
        let combined = contributions.iter().map(|(u, _)| u * u).sum::<f64>().sqrt();
        // 32 nm, 16.7 degrees of freedom in H.1.6: there of rounded contributions.
        assert!((combined - 31.7).abs() < 0.5, "{combined}");
        let freedom = effective_degrees_of_freedom(&contributions);
        assert!((freedom - 16.7).abs() < 1.0, "{freedom}");
    }

    #[test]
    fn known_contributions_have_infinite_degrees_of_freedom() {
        for contributions in [
            &[][..],
            &[(0.0, 3.0)],
            &[(1e-200, f64::INFINITY), (2.0, f64::INFINITY)],
        ] {
            let freedom = effective_degrees_of_freedom(contributions);
            assert!(freedom.is_infinite(), "{contributions:?}: {freedom}");
        }
        let tiny = effective_degrees_of_freedom(&[(3e-200, 5.0), (0.0, 1.0)]);
        assert!((tiny - 5.0).abs() < 1e-12, "{tiny}");
    }
}
