//! One-dimensional quadrature.
//!
//! | rule | for |
//! |---|---|
//! | [`gauss_legendre`] | nodes and weights of any order, at compile time |
//! | [`integrate`], [`for_each_node`] | smooth functions whose finest feature is known |
//! | [`integrate_from_root`] | the same with a root `√(x − start)` at the start |

use core::f64::consts::PI;

/// Sixteen points per panel.
const RULE: [(f64, f64); 16] = gauss_legendre();

/// Returns ∫ f over `[start, end]` by the Gauss–Legendre rule with sixteen points on panels that
/// are at most `longest` wide; 0 where `end ≤ start`.
///
/// On one panel polynomials up to degree 31 are exact, and a cosine of one period to 10⁻¹⁵. The
/// number of panels, `(end − start) / longest`, must be small enough for a loop.
///
/// # Examples
///
/// ```
/// use tem00_numerics::quadrature::integrate;
///
/// let area = integrate(f64::exp, [0.0, 1.0], 1.0);
/// assert!((area - (core::f64::consts::E - 1.0)).abs() < 1e-15);
/// ```
pub fn integrate(f: impl Fn(f64) -> f64, [start, end]: [f64; 2], longest: f64) -> f64 {
    let mut sum = 0.0;
    for_each_node([start, end], longest, |x, weight| sum += weight * f(x));
    sum
}

/// Calls `visit` with the nodes and weights of the rule of [`integrate`], for several integrals
/// over the same nodes.
pub fn for_each_node([start, end]: [f64; 2], longest: f64, mut visit: impl FnMut(f64, f64)) {
    if end <= start {
        return;
    }
    let panels = ((end - start) / longest).ceil().max(1.0);
    let half = 0.5 * (end - start) / panels;
    let mut panel = 0.0;
    while panel < panels {
        let centre = start + (2.0 * panel + 1.0) * half;
        for (node, weight) in RULE {
            visit(centre + node * half, weight * half);
        }
        panel += 1.0;
    }
}

/// Returns ∫ f over `[start, end]` for an f that has a root `√(x − start)` at its start, by the
/// substitution `x = start + (end − start) t²` on panels of t at most `longest` wide.
pub fn integrate_from_root(f: impl Fn(f64) -> f64, [start, end]: [f64; 2], longest: f64) -> f64 {
    let width = end - start;
    let substituted = |t: f64| 2.0 * width * t * f(start + width * t * t);
    if width > 0.0 {
        integrate(substituted, [0.0, 1.0], longest)
    } else {
        0.0
    }
}

/// Returns the N nodes of the Gauss–Legendre rule on [−1, 1], in ascending order, each with its
/// weight; the weights add up to 2.
///
/// The rule integrates polynomials up to degree 2N − 1 exactly. Nodes and weights are good to a few
/// roundings, for N up to 100.
///
/// # Examples
///
/// ```
/// use tem00_numerics::quadrature::gauss_legendre;
///
/// const RULE: [(f64, f64); 2] = gauss_legendre();
///
/// assert!((RULE[1].0 - 3.0_f64.sqrt().recip()).abs() < 1e-15);
/// assert!((RULE[1].1 - 1.0).abs() < 1e-15);
/// ```
///
/// # References
///
/// - M. Abramowitz and I. A. Stegun, *Handbook of Mathematical Functions*, 1964, eq. 25.4.29.
pub const fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let mut rule = [(0.0, 2.0); N];
    let mut i = 0;
    while i < N / 2 {
        let (node, weight) = node_and_weight(i, N);
        rule[i] = (-node, weight);
        rule[N - 1 - i] = (node, weight);
        i += 1;
    }
    if N % 2 == 1 {
        let (_, slope) = legendre(0.0, N);
        rule[N / 2] = (0.0, 2.0 / (slope * slope));
    }
    rule
}

/// The zero number `index` of the Legendre polynomial of degree `points`, from the largest on, by
/// Newton's method, and the weight 2 / ((1 − x²) P′(x)²).
const fn node_and_weight(index: usize, points: usize) -> (f64, f64) {
    let mut x = cosine(PI * (index as f64 + 0.75) / (points as f64 + 0.5));
    let mut slope = 1.0;
    let mut step = 0;
    // The starting value is correct to two digits, and each step doubles the number of digits.
    while step < 6 {
        let (value, derivative) = legendre(x, points);
        slope = derivative;
        x -= value / slope;
        step += 1;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// The cosine of an angle in [0, π/2] by its series, good to 1e−7: the library's is not `const`.
const fn cosine(angle: f64) -> f64 {
    let square = angle * angle;
    let (mut sum, mut term) = (1.0, 1.0);
    let mut n = 2.0;
    while n < 12.0 {
        term *= -square / (n * (n - 1.0));
        sum += term;
        n += 2.0;
    }
    sum
}

/// The Legendre polynomial of a degree of 1 or more, and its derivative.
const fn legendre(x: f64, degree: usize) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    let mut order = 2;
    while order <= degree {
        let n = order as f64;
        let next = ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n;
        (before, value) = (value, next);
        order += 1;
    }
    let slope = degree as f64 * (before - x * value) / (1.0 - x * x);
    (value, slope)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    #[test]
    fn polynomials_up_to_the_degree_31_are_exact() {
        for order in [0, 1, 2, 17, 30, 31] {
            let area = integrate(|x| x.powi(order), [0.0, 2.0], 2.0);
            let exact = 2.0_f64.powi(order + 1) / f64::from(order + 1);
            assert_relative(area, exact, 1e-14);
        }
        let missed = integrate(|x| x.powi(32), [-1.0, 1.0], 2.0) * 16.5;
        // The error for x³² equals the error for P₁₆², which the rule takes as 0: 2¹⁶ · 16!³ · … =
        // 4e−10 of the area.
        assert!((1e-11..1e-7).contains(&(1.0 - missed)), "{missed}");
    }

    /// Checks the rule with N points on all monomials that it integrates, over [0, 1].
    fn check_rule<const N: usize>() {
        let rule = gauss_legendre::<N>();
        assert!(rule.is_sorted_by(|a, b| a.0 < b.0), "{N} points");
        for power in 0..u32::try_from(2 * N).unwrap() {
            let power = i32::try_from(power).unwrap();
            let term = |(x, weight): (f64, f64)| 0.5 * weight * (0.5 + 0.5 * x).powi(power);
            let area: f64 = rule.into_iter().map(term).sum();
            // N terms of at most 1/(power + 1) in all, whose powers turn with the nodes.
            let exact = f64::from(power + 1).recip();
            assert_relative(area, exact, 2e-14);
        }
    }

    #[test]
    fn rules_of_any_order_integrate_polynomials() {
        check_rule::<1>();
        check_rule::<2>();
        check_rule::<3>();
        check_rule::<4>();
        check_rule::<5>();
        check_rule::<16>();
        check_rule::<33>();
    }

    #[test]
    fn nodes_and_weights_are_the_published_ones() {
        // Abramowitz & Stegun, table 25.4.
        let rule = gauss_legendre::<16>();
        assert_relative(rule[8].0, 0.095_012_509_837_637_44, 1e-15);
        assert_relative(rule[8].1, 0.189_450_610_455_068_5, 2e-15);
        assert_relative(rule[15].0, 0.989_400_934_991_649_9, 1e-15);
        assert_relative(rule[15].1, 0.027_152_459_411_754_095, 1e-14);
    }

    #[test]
    fn a_cosine_needs_one_panel_per_period() {
        for end in [0.3, 1.0, 17.2] {
            let area = integrate(|x| (2.0 * PI * x).cos(), [0.0, end], 1.0);
            let exact = (2.0 * PI * end).sin() / (2.0 * PI);
            assert_absolute(area, exact, 1e-14);
        }
        assert!(integrate(|_| 1.0, [1.0, 0.0], 1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn a_root_at_the_start_is_taken_away() {
        let area = integrate_from_root(|x| (x - 2.0).sqrt(), [2.0, 5.0], 1.0);
        assert_relative(area, 2.0 / 3.0 * 27.0_f64.sqrt(), 1e-14);
        let none = integrate_from_root(|x| x, [2.0, 1.0], 1.0);
        assert!(none.abs() < f64::MIN_POSITIVE, "{none}");
    }
}
