//! Normal distribution: density, and variates by inversion.

use core::f64::consts::FRAC_1_SQRT_2;

use tem00_numerics::normal_quantile;

use crate::exponential::exponential;

/// Half the spacing of uniform variates in [0, 1).
pub(crate) const HALF_SPACING: f64 = f64::EPSILON / 4.0;

/// The density of a normal distribution of mean 0.
#[inline(always)]
pub(crate) fn normal_density(x: f64, sigma: f64) -> f64 {
    const INV_SQRT_TAU: f64 = 0.398_942_280_401_432_7;
    let t = x / sigma;
    INV_SQRT_TAU / sigma * exponential(-0.5 * t * t)
}

/// The density of two independent normal variates of mean 0.
pub(crate) fn joint_normal_density(x: [f64; 2], sigma: [f64; 2]) -> f64 {
    const INV_TAU: f64 = 0.159_154_943_091_895_35;
    let t = [x[0] / sigma[0], x[1] / sigma[1]];
    INV_TAU / sigma[0] / sigma[1] * exponential(-0.5 * (t[0] * t[0] + t[1] * t[1]))
}

/// The probability that a standard normal variate lies between `a` and `b`, `a` ≤ `b`.
pub(crate) fn normal_between(a: f64, b: f64) -> f64 {
    let beyond = |t: f64| 0.5 * libm::erfc(t * FRAC_1_SQRT_2);
    // A tail keeps its digits where 1 minus the tail loses them.
    if a > 0.0 {
        beyond(a) - beyond(b)
    } else if b < 0.0 {
        beyond(-b) - beyond(-a)
    } else {
        1.0 - beyond(b) - beyond(-a)
    }
}

/// The standard normal variate below which the fraction `u` in [0, 1) lies.
pub(crate) fn standard_normal(u: f64) -> f64 {
    normal_quantile(interior(u))
}

/// Moves a uniform variate of [0, 1) off the ends, by half its own spacing.
#[expect(clippy::manual_clamp, reason = "NaN must not come out")]
pub(crate) fn interior(u: f64) -> f64 {
    u.max(HALF_SPACING).min(1.0 - f64::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variates_are_finite_over_the_whole_range_of_uniforms() {
        for u in [0.0, f64::MIN_POSITIVE, 0.5, 1.0 - f64::EPSILON / 2.0] {
            let x: f64 = standard_normal(u);
            assert!(x.abs() < 8.3, "u = {u}: {x}");
        }
    }
}
