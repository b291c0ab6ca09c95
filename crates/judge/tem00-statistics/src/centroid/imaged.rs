use core::f64::consts::{FRAC_1_PI, PI};

use libm::erf;

use tem00_numerics::quadrature::integrate;

use crate::centroid::row_spectrum::Row;

/// Returns the standard deviation of the centroid of a laser line on a rough surface that a lens
/// images, to first order in the fluctuations, for a line with the 1/e² half-width `radius` that is
/// read in rows of `row_height`; all three lengths are in units of the speckle size h in the image.
///
/// ```text
/// σ² = (1/2π⁴) ∫∫ sinc²(π p (x − x')/2) √π L erf L dx dx'      over [−1, 1]²
/// L  = π w √(1 − max(x², x'²))      w = radius, p = row_height
/// σ  = √(w ℓ(p) / (8 √π)) (1 − O(h³/w³))      w → ∞
/// σ  = (√2/π) w      p = 0, w → 0
/// ```
///
/// The light of the line interferes in the image. x and x' are two positions in the pupil along the
/// line, in pupil radii; their common extent across the line, the chord of the outer one,
/// determines how much of the position of a scatterer on the line remains in the light from both.
/// For lines at least as wide as a speckle the result agrees with
/// [`line_centroid_deviation`](crate::laws::line_centroid_deviation) within one per cent. A speckle
/// pattern times the irradiance, [`SpeckledLine`](crate::laws::SpeckledLine), gives less, by 20 %
/// at w = h, 7 % at 2 h and 2 % at 4 h, because the lens blurs the line as well. The function is
/// even in both arguments.
///
/// # Validity
///
/// The law holds for a circular pupil, a Gaussian line in focus on a surface with many scatterers
/// in a speckle, and a detector that receives the whole image of the line: the rings that a lens
/// forms beside a line have a long lever, so that cutting them off changes the result. Beyond the
/// first order, the power of a row fluctuates: simulations of lines at least two speckles wide
/// scatter by up to 3 % less than this law predicts. Lines narrower than a speckle scatter by far
/// more, as the centroids of weak rows are nearly unconstrained: by a quarter at w = 0.4 h.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::{imaged_line_centroid_deviation, line_centroid_deviation};
///
/// let ratio = |w| imaged_line_centroid_deviation(w, 0.25) / line_centroid_deviation(w, 0.25);
/// assert!((ratio(1.0) - 0.9912).abs() < 1e-4);
/// assert!((ratio(0.25) - 0.7662).abs() < 1e-4);
/// ```
///
/// # References
///
/// - Own derivation: the centroid as the mean of the operator i ∂/∂k over the light in the pupil,
///   whose correlation over a distance in k is the Fourier transform of the line's irradiance.
pub fn imaged_line_centroid_deviation(radius: f64, row_height: f64) -> f64 {
    defocused_line_centroid_deviation(radius, row_height, 0.0)
}

/// Returns the standard deviation of the centroid of a laser line that a lens images out of focus,
/// as in [`imaged_line_centroid_deviation`]; a point is spread over a disc of the diameter `blur`
/// in the image. All lengths are in units of the speckle size h.
///
/// ```text
/// σ² = σ²(b = 0) + (2 b² / 3π²) ∫∫ sinc²(π p (x − x')/2) c⁴ Q(L) dx dx'      over [−1, 1]²
/// Q(L) = ∫₀¹ exp(−L² t²) (1 − 3t + 2t³) dt      c = √(1 − max(x², x'²)), L = π w c, b = blur
/// ```
///
/// Out of focus the light through one half of the pupil is displaced relative to the light through
/// the other half. The line's centroid therefore moves by b times the centroid, in diameters, of
/// the speckle that the line produces *in the pupil*, whose correlation length is h/w: a thinner
/// line has larger speckles in the pupil and more noise. The two parts are independent.
///
/// # Validity
///
/// The limits of the line in focus apply; the blur may have any size, and the sign of the defocus
/// does not matter.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::{defocused_line_centroid_deviation, imaged_line_centroid_deviation};
///
/// // A line four speckles in full width, blurred by as much: 1.44 times the noise.
/// let blurred = defocused_line_centroid_deviation(2.0, 0.0, 4.0);
/// let ratio = blurred / imaged_line_centroid_deviation(2.0, 0.0);
/// assert!((ratio - 1.4427).abs() < 1e-4, "{ratio}");
/// ```
///
/// # References
///
/// - Own derivation: the phase π b ρ² of defocus, ρ in diameters of the pupil, under the operator i
///   ∂/∂k of the centroid.
pub fn defocused_line_centroid_deviation(radius: f64, row_height: f64, blur: f64) -> f64 {
    if radius.is_infinite() {
        return f64::INFINITY;
    }
    let width = PI * radius.abs();
    let in_pupil = 4.0 / 3.0 * (PI * blur).powi(2);
    let of_chord = |chord: f64| {
        let length = width * chord;
        let in_focus = PI.sqrt() * length * erf(length);
        in_focus + in_pupil * chord.powi(4) * chord_centroid(length)
    };
    let density = |g: f64| 2.0 / PI.powi(4) * over_chords(of_chord, width, g);
    Row::of_height(row_height)
        .weigh(density, 0.0, 1.0)
        .max(0.0)
        .sqrt()
}

/// Returns the contrast, standard deviation over mean, of the power that rows of `row_height`
/// receive from a laser line with the 1/e² half-width `radius`, in or out of focus. Both lengths
/// are in units of the speckle size h in the image.
///
/// ```text
/// K² = (8/π²) ∫∫ sinc²(π p (x − x')/2) c² q(L) dx dx'      over [−1, 1]²
/// q(L) = ∫₀¹ exp(−L² t²) (1 − t) dt      c = √(1 − max(x², x'²)), L = π w c
/// K² → ℓ(p) / (√π w)                     w → ∞, ℓ the speckle length
/// ```
///
/// A centroid divides by this power. The part of the centroid due to defocus is a mean over the
/// light in the pupil, whose variance is 1 + K² times smaller than to first order, like the
/// variance of the mean position of 1/K² equal and independent modes; the part in focus hardly
/// changes.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::imaged_line_power_contrast;
///
/// // A line four speckles in full width on rows one speckle high.
/// assert!((imaged_line_power_contrast(2.0, 1.0) - 0.4343).abs() < 1e-4);
/// ```
///
/// # References
///
/// - Own derivation, as for [`defocused_line_centroid_deviation`].
pub fn imaged_line_power_contrast(radius: f64, row_height: f64) -> f64 {
    if radius.is_infinite() {
        return 0.0;
    }
    let width = PI * radius.abs();
    let of_chord = |chord: f64| chord * chord * chord_power(width * chord);
    let density = |g: f64| 32.0 * (FRAC_1_PI * FRAC_1_PI) * over_chords(of_chord, width, g);
    Row::of_height(row_height)
        .weigh(density, 0.0, 1.0)
        .max(0.0)
        .sqrt()
}

/// Returns ∫ exp(−L² t²) (1 − t) dt over [0, 1]: the variance of the power of speckle on a chord, L
/// coherence lengths long, divided by twice the square of its mean.
fn chord_power(length: f64) -> f64 {
    let squared = length * length;
    if squared < 1e-4 {
        // The next term is L⁴/60.
        return 0.5 - squared / 12.0;
    }
    let flat = 0.5 * PI.sqrt() * erf(length) / length;
    flat - 0.5 * (1.0 - (-squared).exp()) / squared
}

/// Returns ∫ exp(−L² t²) (1 − 3t + 2t³) dt over [0, 1]: the variance of the centroid of speckle on
/// a chord, L coherence lengths long, divided by (8/3) of the fourth power of half the chord.
fn chord_centroid(length: f64) -> f64 {
    let squared = length * length;
    if squared < 0.01 {
        // The next term is L⁸/800.
        return squared * (1.0 / 12.0 - squared * (1.0 / 40.0 - squared * 3.0 / 560.0));
    }
    let end = (-squared).exp();
    let flat = 0.5 * PI.sqrt() * erf(length) / length;
    flat - 1.5 * (1.0 - end) / squared + (1.0 - (1.0 + squared) * end) / (squared * squared)
}

/// Returns ∫ f(√(1 − x²)) dx for x from `min` to 1, for an f that rises over 1/width.
fn over_chords(f: impl Fn(f64) -> f64, width: f64, min: f64) -> f64 {
    // x = cos a
    let end = min.min(1.0).acos();
    let substituted = |a: f64| f(a.sin()) * a.sin();
    let (mut start, mut next, mut sum) = (0.0, FRAC_1_PI.min(width.recip()), 0.0);
    while start < end {
        let stop = f64::min(next, end);
        sum += integrate(substituted, [start, stop], 1.0);
        (start, next) = (stop, 2.0 * next);
    }
    sum
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::laws::line_centroid_deviation;

    #[test]
    fn points_of_rows_have_a_single_integral() {
        // (4w/π^(5/2)) ∫₀¹ m² erf(πwm) dm, by integrating over the smaller of |x| and |x'|.
        for radius in [0.05, 0.25, 1.0, 4.0, 50.0] {
            let f = |m: f64| m * m * erf(PI * radius * m);
            let single = integrate(f, [0.0, 1.0], 0.25 / (1.0 + radius));
            let expected = (4.0 * radius * single / PI.powf(2.5)).sqrt();
            // Both sides are quadratures of smooth functions.
            let deviation = imaged_line_centroid_deviation(radius, 0.0);
            assert_relative(deviation, expected, 1e-9);
        }
    }

    #[test]
    fn wide_lines_have_the_closed_form_and_thin_ones_their_limit() {
        for row_height in [0.0, 0.5, 4.0, 700.0] {
            let ratio = |w| {
                imaged_line_centroid_deviation(w, row_height)
                    / line_centroid_deviation(w, row_height)
            };
            // Half of (∫ erfc) / ∫ = 1/(√π (πw)³) at p = 0, 7e-5 at 5 h; for high rows the
            // difference is smaller.
            assert!((0.0..8e-5).contains(&(1.0 - ratio(5.0))), "{}", ratio(5.0));
            assert_absolute(ratio(1e5), 1.0, 1e-8);
        }
        // The next order of erf is (πw)²/3 · 4/6 … of it.
        let thin = imaged_line_centroid_deviation(1e-4, 0.0);
        assert_relative(thin, 2.0_f64.sqrt() * 1e-4 / PI, 1e-6);
        assert!(imaged_line_centroid_deviation(0.0, 1.0).abs() < f64::MIN_POSITIVE);
        let endless = imaged_line_centroid_deviation(f64::INFINITY, 1.0);
        assert!(endless.is_infinite(), "{endless}");
    }

    #[test]
    fn a_point_of_the_line_s_image_out_of_focus_moves_with_the_centroid_of_its_pupil() {
        // ∫∫ v v' |E(v − v')|² over the common chord of two places u, u' in the pupil, by the
        // midpoint rule.
        let (radius, row_height, blur) = (1.3, 0.8, 3.0);
        let steps = 60_i32;
        let places = || (0..steps).map(|i| (f64::from(i) + 0.5) / f64::from(steps) - 0.5);
        let cell = f64::from(steps).powi(-2);
        let in_chord = |u: f64| move |v: &f64| u * u + v * v < 0.25;
        let mut sum = 0.0;
        for (u, u2) in places().flat_map(|u| places().map(move |u2| (u, u2))) {
            let row = tem00_numerics::sinc(PI * row_height * (u - u2)).powi(2);
            let outer = u.abs().max(u2.abs());
            for v in places().filter(in_chord(outer)) {
                for v2 in places().filter(in_chord(outer)) {
                    sum += row * v * v2 * (-(PI * radius * (v - v2)).powi(2)).exp();
                }
            }
        }
        let in_pupil = (blur * 4.0 / PI * cell).powi(2) * sum;
        let expected = imaged_line_centroid_deviation(radius, row_height).hypot(in_pupil.sqrt());
        let deviation = defocused_line_centroid_deviation(radius, row_height, blur);
        // The staircase of the rim has an error of a hundredth of a chord.
        assert_relative(deviation, expected, 5e-3);
    }

    #[test]
    fn the_centroid_of_a_chord_has_no_step_where_its_series_ends() {
        let [below, above] = [0.1 - 1e-9, 0.1 + 1e-9].map(chord_centroid);
        assert_relative(below, above, 1e-7);
    }

    #[test]
    fn wide_lines_have_the_power_of_independent_speckles() {
        for row_height in [0.0, 0.7, 5.0] {
            let contrast = imaged_line_power_contrast(200.0, row_height);
            let expected = crate::laws::speckle_length(row_height) / (PI.sqrt() * 200.0);
            // The next order of q is 1/(√π L) of it, 1e-3.
            assert_relative(contrast * contrast, expected, 2e-3);
        }
    }

    #[test]
    fn rows_of_a_thin_line_share_what_chords_have_in_common() {
        // (4/π)² ∫∫ (2c)² du du' over the shorter chord, for a point of a row: ∫∫ 4 (1/4 − max²) =
        // 1/2.
        let contrast = imaged_line_power_contrast(1e-5, 0.0);
        assert_relative(contrast * contrast, 8.0 / (PI * PI), 1e-6);
        let [below, above] = [0.01 - 1e-9, 0.01 + 1e-9].map(chord_power);
        assert_relative(below, above, 1e-8);
    }
}
