//! Integrals over the lens-shaped overlap of two displaced pupils.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::quadrature::for_each_node;

/// Returns `(1/π) ∫ exp(iφ)` over the overlap of two unit discs whose centres are 2 `shift` apart
/// along the first axis. The phase is the sum of a phase along this axis, which changes by about
/// `range` at most from the centre to the edge, and of a phase across it. `across` maps the half
/// length of a chord to the integral of `exp(iφ)` over the chord.
pub(crate) fn mean_over_lens(
    shift: f64,
    range: f64,
    along: impl Fn(f64) -> f64,
    across: impl Fn(f64) -> Complex<f64>,
) -> Complex<f64> {
    let shift = shift.abs();
    let half = 1.0 - shift;
    if half <= 0.0 {
        return Complex::ZERO;
    }
    let mut sum = Complex::ZERO;
    // The overlap ends like a square root: place = half (1 − t²).
    for_each_node([0.0, 1.0], 4.0 / range.max(4.0), |t, weight| {
        let place = half * (1.0 - t * t);
        let chord = ((1.0 - place - shift) * (1.0 + place + shift)).sqrt();
        let pair = Complex::cis(along(place)) + Complex::cis(along(-place));
        sum += pair * across(chord) * (weight * 2.0 * half * t);
    });
    sum / PI
}

/// Returns `∫ exp(i q y) dy` from −c to c.
pub(crate) fn linear_across(q: f64, c: f64) -> Complex<f64> {
    let x = q * c;
    let sinc = if x.abs() < 1e-4 {
        1.0 - x * x / 6.0
    } else {
        x.sin() / x
    };
    (2.0 * c * sinc).into()
}

/// Returns `∫ exp(−i b y²) dy` from −c to c, a Fresnel integral.
///
/// # References
///
/// - M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions*, 1964, 7.1.5 and 7.1.14.
pub(crate) fn quadratic_across(b: f64, c: f64) -> Complex<f64> {
    let phase = b.abs() * c * c;
    let of_positive = if phase < 4.0 {
        // The terms cycle through the powers of −i.
        let (mut term, mut parts, mut n) = (1.0, [0.0; 4], 0);
        while term > 1e-18 {
            let order = f64::from(n);
            parts[n as usize % 4] += term / (2.0 * order + 1.0);
            term *= phase / (order + 1.0);
            n += 1_u32;
        }
        2.0 * c * Complex::new(parts[0] - parts[2], parts[3] - parts[1])
    } else {
        // Integral over the whole axis minus both tails: exp(−z²) / (z + ½/(z + 1/(z + 3/2/(z +
        // …)))) for z = √i y √b.
        let z = Complex::from_polar(phase.sqrt(), 0.25 * PI);
        let fraction = (1..=60)
            .rev()
            .fold(z, |below, n| z + 0.5 * f64::from(n) / below);
        let tails = Complex::cis(-phase) / fraction;
        (PI.sqrt() - tails) * Complex::cis(-0.25 * PI) / b.abs().sqrt()
    };
    if b < 0.0 {
        of_positive.conj()
    } else {
        of_positive
    }
}

#[cfg(test)]
mod tests {
    use tem00_numerics::quadrature::integrate;

    use super::*;

    #[test]
    fn chords_are_integrated_in_closed_form() {
        for b in [0.0, 0.3, -3.9, 4.1, -25.0, 300.0] {
            for c in [0.1, 0.99, 1.0] {
                let by = |part: fn(f64) -> f64, of: &dyn Fn(f64) -> f64| {
                    integrate(|y| part(of(y)), [-c, c], 0.01)
                };
                let square = |y: f64| -b * y * y;
                let expected = Complex::new(by(f64::cos, &square), by(f64::sin, &square));
                let found = quadratic_across(b, c);
                assert!(
                    (found - expected).norm() < 1e-12,
                    "{b} {c}: {found} {expected}"
                );
                let line = |y: f64| b * y;
                let found = linear_across(b, c);
                assert!(
                    (found - by(f64::cos, &line)).norm() < 1e-12,
                    "{b} {c}: {found}"
                );
            }
        }
    }
}
