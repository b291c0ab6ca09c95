use core::f64::consts::PI;
use std::sync::LazyLock;

/// The points of the rule on one panel.
const POINTS: u32 = 16;

/// The positive nodes on [−1, 1] and their weights.
static RULE: LazyLock<Vec<(f64, f64)>> =
    LazyLock::new(|| (0..POINTS / 2).map(node_and_weight).collect());

/// Returns ∫ f over `[start, end]` by the rule of Gauss and Legendre with sixteen points on panels
/// that are at most `longest` wide; 0 where `end ≤ start`.
///
/// On one panel polynomials up to the order 31 are exact, and a cosine of one period to 10⁻¹⁵.
pub(crate) fn integrate(f: impl Fn(f64) -> f64, [start, end]: [f64; 2], longest: f64) -> f64 {
    let mut sum = 0.0;
    for_each_node([start, end], longest, |x, weight| sum += weight * f(x));
    sum
}

/// Calls `visit` with the nodes of the rule of [`integrate`] and their weights, for integrals that share
/// them.
pub(crate) fn for_each_node([start, end]: [f64; 2], longest: f64, mut visit: impl FnMut(f64, f64)) {
    if end <= start {
        return;
    }
    let panels = ((end - start) / longest).ceil().max(1.0);
    let half = 0.5 * (end - start) / panels;
    let mut panel = 0.0;
    while panel < panels {
        let centre = start + (2.0 * panel + 1.0) * half;
        for &(node, weight) in RULE.iter() {
            let offset = node * half;
            visit(centre - offset, weight * half);
            visit(centre + offset, weight * half);
        }
        panel += 1.0;
    }
}

/// Returns ∫ f over `[start, end]` for an f that has a root `√(x − start)` at its start, by the
/// substitution `x = start + (end − start) t²` on panels of t at most `longest` wide.
pub(crate) fn integrate_from_root(
    f: impl Fn(f64) -> f64,
    [start, end]: [f64; 2],
    longest: f64,
) -> f64 {
    let width = end - start;
    let substituted = |t: f64| 2.0 * width * t * f(start + width * t * t);
    if width > 0.0 {
        integrate(substituted, [0.0, 1.0], longest)
    } else {
        0.0
    }
}

/// Returns the zero number `index` of the Legendre polynomial, from the largest on, by Newton's
/// method, and the weight 2 / ((1 − x²) P′(x)²).
fn node_and_weight(index: u32) -> (f64, f64) {
    let mut x = (PI * (f64::from(index) + 0.75) / (f64::from(POINTS) + 0.5)).cos();
    let mut slope = 1.0;
    // The start is good to three digits, which each step doubles.
    for _ in 0..5 {
        let (value, derivative) = legendre(x);
        slope = derivative;
        x -= value / slope;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// Returns the Legendre polynomial of the order [`POINTS`] and its derivative.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for order in 2..=POINTS {
        let n = f64::from(order);
        (before, value) = (
            value,
            ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n,
        );
    }
    let slope = f64::from(POINTS) * (before - x * value) / (1.0 - x * x);
    (value, slope)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn polynomials_up_to_the_order_31_are_exact() {
        for order in [0, 1, 2, 17, 30, 31] {
            let area = integrate(|x| x.powi(order), [0.0, 2.0], 2.0);
            let exact = 2.0_f64.powi(order + 1) / f64::from(order + 1);
            assert_relative_eq!(area, exact, epsilon = 0.0, max_relative = 1e-14);
        }
        let missed = integrate(|x| x.powi(32), [-1.0, 1.0], 2.0) * 16.5;
        // P₁₆² is x³² less what the rule takes for it: 2¹⁶ · 16!³ · … = 4e−10 of the area.
        assert!((1e-11..1e-7).contains(&(1.0 - missed)), "{missed}");
    }

    #[test]
    fn a_cosine_needs_one_panel_per_period() {
        for end in [0.3, 1.0, 17.2] {
            let area = integrate(|x| (2.0 * PI * x).cos(), [0.0, end], 1.0);
            let exact = (2.0 * PI * end).sin() / (2.0 * PI);
            assert_relative_eq!(area, exact, epsilon = 1e-14);
        }
        assert!(integrate(|_| 1.0, [1.0, 0.0], 1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn a_root_at_the_start_is_taken_away() {
        let area = integrate_from_root(|x| (x - 2.0).sqrt(), [2.0, 5.0], 1.0);
        assert_relative_eq!(area, 2.0 / 3.0 * 27.0_f64.sqrt(), max_relative = 1e-14);
        let none = integrate_from_root(|x| x, [2.0, 1.0], 1.0);
        assert!(none.abs() < f64::MIN_POSITIVE, "{none}");
    }
}
