use core::f64::consts::{FRAC_1_PI, PI};

use libm::erf;

use tem00_numerics::quadrature::integrate;

use crate::centroid::row_spectrum::Row;

/// Returns the standard deviation of the centroid of a laser line on a rough surface that a lens images,
/// first order in the fluctuations, for a line of the 1/e² half-width `radius` that is read in rows
/// of `row_height`; all three are in units of the speckle size h in the image.
///
/// ```text
/// σ² = (1/2π⁴) ∫∫ sinc²(π p (x − x')/2) √π L erf L dx dx'      over [−1, 1]²
/// L  = π w √(1 − max(x², x'²))      w = radius, p = row_height
/// σ  = √(w ℓ(p) / (8 √π)) (1 − O(h³/w³))      w → ∞
/// σ  = (√2/π) w      p = 0, w → 0
/// ```
///
/// The light of the line interferes in the image as waves do. x and x' are two places in the pupil
/// along the line, in radii of the pupil; what they have in common across the line, the chord of the outer
/// one, tells how much of the position of a scatterer on the line is left in the light from both. Already for
/// lines as wide as a speckle this is the [`line_centroid_deviation`](crate::line_centroid_deviation)
/// within one per cent. A speckle pattern times the irradiance, [`SpeckledLine`](crate::SpeckledLine),
/// falls short of it, by 20 % at w = h, 7 % at 2 h and 2 % at 4 h: the lens blurs the line as well.
/// The function is even in both.
///
/// # Validity
///
/// Circular pupil, a Gaussian line in focus on a surface of many scatterers in a speckle, and a detector
/// that sees all of the line's image; what it cuts off of the rings that a lens leaves beside a line
/// has a long lever. Beyond the first order, the power of a row fluctuates: simulations of lines as
/// wide as two speckles and more scatter by up to 3 % less than this law says. Lines narrower than a
/// speckle scatter by far more, as the centroids of weak rows are nearly free: by a quarter at w = 0.4 h.
///
/// # Examples
///
/// ```
/// use tem00_statistics::{imaged_line_centroid_deviation, line_centroid_deviation};
///
/// let ratio = |w| imaged_line_centroid_deviation(w, 0.25) / line_centroid_deviation(w, 0.25);
/// assert!((ratio(1.0) - 0.9912).abs() < 1e-4);
/// assert!((ratio(0.25) - 0.7662).abs() < 1e-4);
/// ```
///
/// # References
///
/// - Own derivation: the centroid as the mean of the operator i ∂/∂k over the light in the pupil, whose
///   correlation at a distance of k is the Fourier transform of the line's irradiance.
pub fn imaged_line_centroid_deviation(radius: f64, row_height: f64) -> f64 {
    if radius.is_infinite() {
        return f64::INFINITY;
    }
    let width = PI * radius.abs();
    let density = |g: f64| 2.0 / PI.powi(4) * over_chords(width, g);
    Row::of_height(row_height)
        .weigh(density, 0.0, 1.0)
        .max(0.0)
        .sqrt()
}

/// Returns ∫ √π L erf L dx for x from `least` to 1, with L = width √(1 − x²).
fn over_chords(width: f64, least: f64) -> f64 {
    // x = cos a
    let end = least.min(1.0).acos();
    let f = |a: f64| {
        let chord = width * a.sin();
        PI.sqrt() * chord * erf(chord) * a.sin()
    };
    // The error function rises over 1/width.
    let (mut start, mut next, mut sum) = (0.0, FRAC_1_PI.min(width.recip()), 0.0);
    while start < end {
        let stop = f64::min(next, end);
        sum += integrate(f, [start, stop], 1.0);
        (start, next) = (stop, 2.0 * next);
    }
    sum
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::line_centroid_deviation;

    #[test]
    fn points_of_rows_have_a_single_integral() {
        // (4w/π^(5/2)) ∫₀¹ m² erf(πwm) dm, by integrating over the smaller of |x| and |x'|.
        for radius in [0.05, 0.25, 1.0, 4.0, 50.0] {
            let f = |m: f64| m * m * erf(PI * radius * m);
            let single = integrate(f, [0.0, 1.0], 0.25 / (1.0 + radius));
            let expected = (4.0 * radius * single / PI.powf(2.5)).sqrt();
            // Quadratures of smooth functions.
            let deviation = imaged_line_centroid_deviation(radius, 0.0);
            assert_relative_eq!(deviation, expected, max_relative = 1e-9);
        }
    }

    #[test]
    fn wide_lines_have_the_closed_form_and_thin_ones_their_limit() {
        for row_height in [0.0, 0.5, 4.0, 700.0] {
            let ratio = |w| {
                imaged_line_centroid_deviation(w, row_height)
                    / line_centroid_deviation(w, row_height)
            };
            // Half of (∫ erfc) / ∫ = 1/(√π (πw)³) at p = 0, 7e-5 at 5 h; high rows see less of it.
            assert!((0.0..8e-5).contains(&(1.0 - ratio(5.0))), "{}", ratio(5.0));
            assert_relative_eq!(ratio(1e5), 1.0, epsilon = 1e-8);
        }
        // The next order of erf is (πw)²/3 · 4/6 … of it.
        let thin = imaged_line_centroid_deviation(1e-4, 0.0);
        assert_relative_eq!(thin, 2.0_f64.sqrt() * 1e-4 / PI, max_relative = 1e-6);
        assert!(imaged_line_centroid_deviation(0.0, 1.0).abs() < f64::MIN_POSITIVE);
        let endless = imaged_line_centroid_deviation(f64::INFINITY, 1.0);
        assert!(endless.is_infinite(), "{endless}");
    }
}
