use core::f64::consts::{FRAC_PI_4, PI, SQRT_2};

use tem00_numerics::quadrature::integrate;

use crate::airy_autocovariance;

/// Returns the contrast of fully developed speckle seen by square pixels that integrate over
/// their whole area, `pixel_size` being their side in units of the speckle size h.
///
/// ```text
/// C² = 4 ∫₀¹∫₀¹ (1−x)(1−y) c(q √(x²+y²)) dx dy      q = pixel_size, c the Airy autocovariance
/// C² = 1 − π²q²/12 + …      q → 0
/// C² = (4/π) / q² − …       q → ∞
/// ```
///
/// Pixels as large as a speckle (q = 1) see the contrast 0.711, pixels twice as large 0.440. The
/// function is even.
///
/// # Validity
///
/// Circular pupil, no gaps between the pixels, no diffusion in the sensor. The result is exact to
/// 10⁻⁹.
///
/// # Examples
///
/// ```
/// use tem00_statistics::pixel_contrast;
///
/// assert!((pixel_contrast(0.0) - 1.0).abs() < 1e-12);
/// assert!((pixel_contrast(1.0) - 0.711_268).abs() < 1e-6);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4 (integrated speckle).
pub fn pixel_contrast(pixel_size: f64) -> f64 {
    let q = pixel_size.abs();
    if q < ASYMPTOTIC_FROM {
        squared_by_quadrature(q).sqrt()
    } else {
        contrast_of_large_pixels(q)
    }
}

/// From here on the terms left out of the asymptotic form are below 10⁻⁹ of C.
const ASYMPTOTIC_FROM: f64 = 64.0;

/// C² as the mean of the Airy autocovariance over the distance r of two random points of the unit
/// square, whose density has a closed form on either side of r = 1 ("square line picking").
fn squared_by_quadrature(q: f64) -> f64 {
    // Two points closer than the side.
    let near = |r: f64| 2.0 * r * (PI - 4.0 * r + r * r) * airy_autocovariance(q * r);
    // Two points further apart: r = sec θ takes the root √(r² − 1) = tan θ away.
    let far = |theta: f64| {
        let (tan, sec) = (theta.tan(), theta.cos().recip());
        let density = 2.0 * sec * (4.0 * tan - tan * tan - 3.0 + PI - 4.0 * theta);
        density * airy_autocovariance(q * sec) * sec * tan
    };
    // J₁(πqr)² has the period 1/q.
    let period = q.recip();
    integrate(near, [0.0, 1.0], period) + integrate(far, [0.0, FRAC_PI_4], 0.5 * period)
}

/// The contrast without the oscillating terms of C², which fall as q^(−9/2):
///
/// ```text
/// C² = 4/(πq²) − (8/π³ − 8/π⁴ + (32/π⁴)(ln πq + γ + 3 ln 2 − 2) − (4/π⁴) J) / q³
/// ```
///
/// The first term integrates c over the plane and 8/π³ is what of it lies beyond r = 1; the
/// logarithm comes from ∫₀ˣ J₁² = (ln x + γ + 3 ln 2 − 2)/π + …; J weighs the corner r > 1 with
/// r⁻³.
fn contrast_of_large_pixels(q: f64) -> f64 {
    const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;
    if q.is_infinite() {
        return 0.0;
    }
    let logarithm = q.ln() + PI.ln() + EULER_GAMMA + 8.0_f64.ln() - 2.0;
    let correction = 8.0 * (PI - 1.0) + 32.0 * logarithm - 4.0 * corner_integral();
    (4.0 / PI - correction / PI.powi(4) / q).sqrt() / q
}

/// Returns J = ∫ 2 (4 tan θ − tan² θ − 3 + π − 4θ) sin θ dθ over [0, π/4].
fn corner_integral() -> f64 {
    let half_root = SQRT_2 / 2.0;
    let sin_tan = 1.0_f64.asinh() - half_root;
    let sin_tan_squared = SQRT_2 + half_root - 2.0;
    let sin = 1.0 - half_root;
    let angle_sin = half_root * (1.0 - FRAC_PI_4);
    2.0 * (4.0 * sin_tan - sin_tan_squared + (PI - 3.0) * sin - 4.0 * angle_sin)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use tem00_numerics::{disc_overlap, sinc};

    use super::*;

    /// C² from the frequencies: the pixel's transfer function times the speckle's power spectrum.
    ///
    /// ```text
    /// C² = (32/π) ∫₀^(π/4) ∫₀¹ sinc²(πqρ cos φ) sinc²(πqρ sin φ) chat(ρ) ρ dρ dφ
    /// ```
    ///
    /// The substitution ρ = 1 − t² takes the root of chat at ρ = 1 away.
    fn squared_by_spectrum(q: f64) -> f64 {
        let radial = |phi: f64| {
            let (sin, cos) = phi.sin_cos();
            let integrand = |t: f64| {
                let rho = 1.0 - t * t;
                let transfer = sinc(PI * q * rho * cos) * sinc(PI * q * rho * sin);
                transfer * transfer * disc_overlap(rho) * rho * 2.0 * t
            };
            simpson(integrand, 1.0)
        };
        32.0 / PI * simpson(radial, FRAC_PI_4)
    }

    fn simpson(f: impl Fn(f64) -> f64, end: f64) -> f64 {
        const INTERVALS: u32 = 400;
        let h = end / f64::from(INTERVALS);
        let weighted = |i: u32| {
            let weight = match i {
                0 | INTERVALS => 1.0,
                i if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * f(f64::from(i) * h)
        };
        (0..=INTERVALS).map(weighted).sum::<f64>() * h / 3.0
    }

    #[test]
    fn squared_contrast_is_the_filtered_power_spectrum() {
        for q in [0.0_f64, 0.05, 0.5, 1.0, 3.0, 10.0] {
            // Simpson's rule errs by h⁴/180 of the fourth derivative, which is (2πq)⁴ once the two
            // squares oscillate and some 2000 before, for the substituted chat.
            let tolerance = (2_000.0 + (2.0 * PI * q).powi(4)) / 400.0_f64.powi(4) / 180.0;
            let contrast = pixel_contrast(q);
            assert_relative_eq!(
                contrast * contrast,
                squared_by_spectrum(q),
                epsilon = tolerance
            );
        }
    }

    #[test]
    fn squared_contrast_has_its_known_values() {
        // Six digits, from three equivalent double integrals evaluated independently.
        let table = [
            (0.05, 0.997_947),
            (0.1, 0.991_823),
            (0.25, 0.950_419),
            (0.5, 0.821_415),
            (1.0, 0.505_902),
            (1.5, 0.299_155),
            (2.0, 0.194_010),
            (3.0, 0.099_706),
            (5.0, 0.040_565),
            (10.0, 0.011_209),
        ];
        for (q, squared) in table {
            assert_relative_eq!(pixel_contrast(q).powi(2), squared, epsilon = 6e-7);
            assert_relative_eq!(pixel_contrast(-q).powi(2), squared, epsilon = 6e-7);
        }
    }

    #[test]
    fn quadrature_and_asymptotic_form_meet() {
        for q in [64.0, 64.3, 81.7] {
            let exact = squared_by_quadrature(q).sqrt();
            assert_relative_eq!(exact, contrast_of_large_pixels(q), epsilon = 1e-9);
        }
    }

    #[test]
    fn contrast_falls_from_one_to_zero() {
        // The fourth-order term (5π⁴/192)(17/90) q⁴ at q = 1e−2 is 5e−9.
        let small = 1.0 - PI * PI * 1e-4 / 12.0;
        assert_relative_eq!(pixel_contrast(1e-2).powi(2), small, epsilon = 1e-8);
        let sizes = (0..2_000).map(|i| 0.05 * f64::from(i));
        let contrasts: Vec<_> = sizes.map(pixel_contrast).collect();
        assert!(
            contrasts.windows(2).all(|pair| pair[1] < pair[0]),
            "the contrast rises somewhere"
        );
        // √(4/π) / q, and the next order is ln q / q.
        let huge = 1e200 * pixel_contrast(1e200);
        assert_relative_eq!(huge, (4.0 / PI).sqrt(), max_relative = 1e-12);
        assert!(pixel_contrast(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }
}
