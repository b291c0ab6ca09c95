use core::f64::consts::TAU;

use tem00_numerics::quadrature::integrate;

/// Argument from which the asymptotic series is exact: its smallest term is exp(−2x).
const ASYMPTOTIC_FROM: f64 = 25.0;

/// Returns exp(−|x|) I₀(x), the exponentially scaled modified Bessel function of order zero.
pub(crate) fn scaled_bessel_i0(x: f64) -> f64 {
    let x = x.abs();
    if x < ASYMPTOTIC_FROM {
        // Σ (x²/4)ᵏ / k!²: all terms are positive.
        let quarter = 0.25 * x * x;
        (-x).exp() * sum_of_terms(|k| quarter / (k * k))
    } else {
        // Σ (1·3 … (2k − 1))² / (k! (8x)ᵏ) over √(2πx), also without a change of sign.
        let eighth = 0.125 / x;
        sum_of_terms(|k| (2.0 * k - 1.0).powi(2) * eighth / k) / (TAU * x).sqrt()
    }
}

/// Returns 1 + q(1) + q(1) q(2) + …, until the terms are negligible.
fn sum_of_terms(quotient: impl Fn(f64) -> f64) -> f64 {
    let (mut term, mut sum, mut k) = (1.0, 1.0, 1.0);
    while term > f64::EPSILON / 16.0 * sum {
        term *= quotient(k);
        sum += term;
        k += 1.0;
    }
    sum
}

/// Returns the probability that a Rician amplitude, the magnitude of the sum of a constant `a` and
/// a circular complex Gaussian of unit variance per component, is at most `b`.
///
/// ```text
/// 1 − Q₁(a, b) = ∫₀ᵇ x exp(−(x² + a²)/2) I₀(ax) dx      Q₁ Marcum's function
/// ```
///
/// The absolute error is below 10⁻¹⁴.
pub(crate) fn rician_cumulative(a: f64, b: f64) -> f64 {
    // exp(−9²/2) = 3e−18.
    const REACH: f64 = 9.0;
    let density = |offset: f64| {
        let x = a + offset;
        x * scaled_bessel_i0(a * x) * (-0.5 * offset * offset).exp()
    };
    let offset = b - a;
    if b <= a.max(1.0) {
        integrate(density, [-a.min(REACH), offset], 1.0)
    } else {
        1.0 - integrate(density, [offset, REACH], 1.0)
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    /// exp(−x) I₀(x) = (1/n) Σ exp(x (cos θ − 1)) over n equidistant angles: the trapezoidal rule
    /// omits `I_n(x)` and higher orders, which vanish for n ≫ x.
    fn by_definition(x: f64) -> f64 {
        const ANGLES: u32 = 4_000;
        let angle = |i| TAU * f64::from(i) / f64::from(ANGLES);
        // 1 − cos θ without cancellation.
        let wave = |i| (-2.0 * x * (0.5_f64 * angle(i)).sin().powi(2)).exp();
        (0..ANGLES).map(wave).sum::<f64>() / f64::from(ANGLES)
    }

    #[test]
    fn scaled_bessel_function_is_its_integral() {
        for x in [0.0, 1e-3, 0.7, 3.0, 11.0, 24.999, 25.0, 31.0, 400.0] {
            assert_relative(scaled_bessel_i0(x), by_definition(x), 1e-14);
        }
        assert!(scaled_bessel_i0(f64::INFINITY).abs() < f64::MIN_POSITIVE);
        // 1/√(2πx), to 1/8x.
        let far = scaled_bessel_i0(-1e30);
        assert_relative(far, (TAU * 1e30).sqrt().recip(), 1e-15);
    }

    #[test]
    fn rician_distribution_is_its_series() {
        // 1 − Q₁(a, b) = exp(−(a² + b²)/2) Σₖ (b/a)ᵏ Iₖ(ab), k from 1 on; here as the Poisson
        // mixture Σⱼ e^(−a²/2) (a²/2)ʲ / j! · P(j + 1, b²/2).
        for (a, b) in [(0.0, 0.3), (0.5, 2.0), (1.0, 1.0), (3.0, 1.5), (4.0, 9.0)] {
            let half = 0.5 * a * a;
            let mut weight = f64::exp(-half);
            let mut sum = 0.0;
            for j in 0..120_u32 {
                let shape = f64::from(j) + 1.0;
                sum += weight * statrs::function::gamma::gamma_lr(shape, 0.5 * b * b);
                weight *= half / shape;
            }
            assert_absolute(rician_cumulative(a, b), sum, 2e-14);
        }
    }

    #[test]
    fn rician_distribution_stays_a_probability_at_any_scale() {
        for a in [0.0, 1e-30, 1.0, 1e8, 1e30, 1e200] {
            for factor in [0.0, 4.6e-14, 0.5, 1.0, 2.0, f64::INFINITY] {
                let b = if a > 0.0 { a * factor } else { factor };
                let value = rician_cumulative(a, b);
                assert!(
                    (0.0..=1.0).contains(&value),
                    "a = {a:e}, b = {b:e}: {value}"
                );
            }
        }
    }
}
