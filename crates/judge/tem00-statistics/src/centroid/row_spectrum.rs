use core::f64::consts::PI;

use tem00_numerics::{
    quadrature::{integrate, integrate_from_root},
    sinc,
};

use crate::laws::airy_power_spectrum;

/// Returns the speckle length of rows: the integral over all distances across the rows of the
/// autocovariance of speckle that is averaged over `row_height` along the line; both lengths are in
/// units of the speckle size h.
///
/// ```text
/// ℓ(p) = (8/π) ∫₀¹ chat(ρ) sinc²(π p ρ) dρ      p = row_height
/// ℓ(0) = 32 / 3π² = 1.081
/// ℓ(p) = (4/π) / p − (16/π⁴) (ln 4πp + γ) / p² + …      p → ∞
/// ```
///
/// The signal of pixels of the height p along a line across them fluctuates like a sequence of
/// independent values, each ℓ(p) / C² long, where C is their contrast. A detector that weights the
/// irradiance E(y) across a laser line with g(y) has, to first order in the fluctuations and for
/// lines much wider than a speckle, the variance `ℓ(p) ∫ g² E² dy`. The function is even, and
/// decreases from p = 0 on.
///
/// # Validity
///
/// The speckle is fully developed behind a circular pupil. Behind an elliptical pupil, p is in
/// units of the speckle size along the line and ℓ in units of the speckle size across it. The
/// relative error is below 10⁻¹⁰.
///
/// # Examples
///
/// ```
/// use core::f64::consts::PI;
/// use tem00_statistics::laws::speckle_length;
///
/// assert!((speckle_length(0.0) - 32.0 / (3.0 * PI * PI)).abs() < 1e-12);
/// // Rows one speckle high.
/// assert!((speckle_length(1.0) - 0.763_68).abs() < 1e-5);
/// ```
///
/// # References
///
/// - R. G. Dorsch, G. Häusler, J. M. Herrmann, *Laser triangulation: fundamental uncertainty in
///   distance measurement*, Appl. Opt. 33, 1306, 1994, for the resulting noise of a spot.
pub fn speckle_length(row_height: f64) -> f64 {
    Row::of_height(row_height).spectrum(0.0)
}

/// Neighbouring pixels of one row, which average speckle along a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// The width of the sensitive part of a pixel along the line, in units of h.
    size: f64,
    /// The distance between pixels along the line, in units of h.
    pitch: f64,
    /// The number of pixels.
    pixels: f64,
}

/// The number of periods of the transfer function of one pixel after which only its mean is used: a
/// zero of the integral of the omitted part, which is then about 10⁻¹¹ of the total.
const AVERAGED_FROM: f64 = 512.0;

impl Row {
    /// A pixel with a given height along the line.
    pub(crate) fn of_height(size: f64) -> Self {
        let size = size.abs();
        Self {
            size,
            pitch: size,
            pixels: 1.0,
        }
    }

    /// Equal pixels at equal distances that are averaged.
    pub(crate) const fn of_pixels(size: f64, pitch: f64, pixels: f64) -> Self {
        Self {
            size,
            pitch,
            pixels,
        }
    }

    /// Returns the power spectrum, at a `frequency` across the row, of speckle that is averaged
    /// along it.
    ///
    /// ```text
    /// S(f) = (8/π) ∫ chat(√(f² + g²)) T²(g) dg      from 0 to √(1 − f²)
    /// ```
    pub(crate) fn spectrum(&self, frequency: f64) -> f64 {
        let end = (1.0 - frequency * frequency).max(0.0).sqrt();
        let density = |g: f64| airy_power_spectrum(frequency.hypot(g));
        self.weigh(density, frequency.abs(), end)
    }

    /// Returns 2 ∫ density(g) T²(g) dg over the frequencies g along the row from 0 to `end`.
    ///
    /// The density has a kink of the width `kink` at 0, beyond which the pieces grow, and a root of
    /// the order 3/2 at the end.
    pub(crate) fn weigh(&self, density: impl Fn(f64) -> f64, kink: f64, end: f64) -> f64 {
        if self.size.is_nan() {
            return f64::NAN;
        }
        if self.size.is_infinite() || end <= 0.0 {
            return 0.0;
        }
        let averaged_from = self.averaged_from();
        let (mut start, mut sum) = (0.0, 0.0);
        for next in pieces(kink, averaged_from, end) {
            let averaged = start >= averaged_from;
            let longest = if averaged { 1.0 } else { self.period() };
            let f = |g: f64| density(g) * self.transfer(g, averaged);
            sum += if next < end {
                integrate(f, [start, next], longest)
            } else {
                // The mirrored integrand has its root at the start.
                let panel = longest / (2.0 * (end - start));
                integrate_from_root(|u| f(start + end - u), [start, end], panel)
            };
            start = next;
        }
        2.0 * sum
    }

    /// From this frequency on the transfer function of a single large pixel is averaged over its
    /// oscillation.
    fn averaged_from(&self) -> f64 {
        if self.pixels > 1.0 {
            f64::INFINITY
        } else {
            AVERAGED_FROM / self.size
        }
    }

    /// Returns the shortest period of the squared transfer function, along the frequencies.
    fn period(&self) -> f64 {
        (self.pitch * (self.pixels - 1.0) + self.size).recip()
    }

    /// Returns the squared transfer function of the pixels: the function of one pixel times the
    /// interference of their positions. If `averaged`, it is averaged over its oscillation.
    fn transfer(&self, frequency: f64, averaged: bool) -> f64 {
        if averaged {
            return 0.5 * (PI * self.size * frequency).powi(-2);
        }
        let one = sinc(PI * self.size * frequency);
        let angle = PI * (self.pitch * frequency).rem_euclid(1.0);
        let angle = if angle > 0.5 * PI { PI - angle } else { angle };
        let places = sinc(self.pixels * angle) / sinc(angle);
        (one * places).powi(2)
    }
}

/// Returns the ends of pieces of `[0, end]` that grow by four from where the integrand first
/// changes.
fn pieces(kink: f64, averaged_from: f64, end: f64) -> impl Iterator<Item = f64> {
    let first = if kink > 0.0 { kink } else { averaged_from };
    let mut next = first.min(averaged_from);
    let mut ended = false;
    core::iter::from_fn(move || {
        if ended {
            return None;
        }
        if next >= 0.5 * end {
            ended = true;
            return Some(end);
        }
        let current = next;
        next *= 4.0;
        if current < averaged_from {
            next = next.min(averaged_from);
        }
        Some(current)
    })
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;
    use crate::laws::translation_contrast;

    #[test]
    fn points_of_rows_and_high_rows_have_their_closed_forms() {
        let point = 32.0 / (3.0 * PI * PI);
        assert_relative(speckle_length(0.0), point, 1e-12);
        assert_relative(speckle_length(-0.5), speckle_length(0.5), f64::EPSILON);
        for p in [40.0_f64, 300.0, 1e4, 1e9] {
            const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;
            let logarithm = (4.0 * PI * p).ln() + EULER_GAMMA;
            let high = (4.0 / PI - 16.0 / PI.powi(4) * logarithm / p) / p;
            // The next terms are the root of chat at its end, (2πp)^(−5/2)/p², and the cube of chat
            // at 0, 1/p⁴.
            let tolerance = (2.0 * PI * p).powf(-2.5) / p + p.powi(-3) / 1e3 + 1e-10;
            assert_relative(speckle_length(p), high, tolerance);
        }
        assert!(speckle_length(f64::INFINITY).abs() < f64::MIN_POSITIVE);
        assert!(speckle_length(f64::NAN).is_nan(), "NaN has no length");
    }

    #[test]
    fn the_spectrum_holds_the_contrast_of_the_row() {
        for p in [0.0, 0.3, 2.0, 17.0] {
            let row = Row::of_height(p);
            // The nodes concentrate at the kink of S at 0.
            let spectrum = |t: f64| 4.0 * t * row.spectrum(t * t);
            let squared = integrate(spectrum, [0.0, 1.0], 0.05);
            let contrast = translation_contrast(p);
            assert_relative(squared, contrast * contrast, 1e-8);
        }
    }
}
