use core::f64::consts::PI;

use libm::erf;

use tem00_numerics::{check, quadrature::integrate};

use crate::{
    StatisticsError, airy_autocovariance,
    contrast::rectangular_pixel::{AVERAGED_FROM, averaged_autocovariance},
    laws::speckle_length,
};

/// Returns the standard deviation of the centroid of a laser line under speckle, for a line with
/// the 1/e² half-width `radius` that is much wider than a speckle and read in rows of `row_height`.
/// It is the typical distance of the measured position from the true one. All three lengths are in
/// units of the speckle size h in the image.
///
/// ```text
/// σ = √(w ℓ(p) / (8 √π))      w = radius, p = row_height along the line, ℓ the speckle length
/// ```
///
/// The function is even in both arguments. The noise grows with the square root of the line's
/// width: a wider line averages over more speckles, but these have a longer lever. Sums of N equal
/// patterns divide it by √N, and light with the degree of polarisation P multiplies it by √((1 +
/// P²)/2): it is proportional to the contrast.
///
/// # Validity
///
/// The line is Gaussian and is weighted over its full width by pixels much smaller than the line;
/// the law is the limit of wide lines, to first order in the fluctuations. The necessary width
/// depends on the formation of the line:
///
/// - a line on a rough surface that a lens images obeys the law within 1 % from w = h on, see
///   [`imaged_line_centroid_deviation`](crate::laws::imaged_line_centroid_deviation);
/// - a speckle pattern times the irradiance, as in renderers, scatters less: within 5 % of the law
///   from w = 4.2 h on, within 5 % of the [`SpeckledLine`] from 2 h on, within 7 % of the
///   `SpeckledLine` from h on.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::{SpeckledLine, line_centroid_deviation};
///
/// let deviation = line_centroid_deviation(8.0, 0.5);
/// assert!((deviation - 0.7415).abs() < 1e-4);
/// // First order at the same width: half a per cent less.
/// let line = SpeckledLine::new(8.0, 0.5)?;
/// assert!((line.centroid_deviation() / deviation - 0.9933).abs() < 1e-3);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
pub fn line_centroid_deviation(radius: f64, row_height: f64) -> f64 {
    (radius.abs() * speckle_length(row_height) / (8.0 * PI.sqrt())).sqrt()
}

/// A laser line of any width under speckle, read by a row across it, to first order in the
/// fluctuations.
///
/// ```text
/// σ² = ∫ |G(f)|² S(f) df      S the spectrum of speckle averaged along the row
/// |G(f)|² = (2π s² f)² exp(−4π² s² f²)      s = w/2, without a window
/// ```
///
/// G is the Fourier transform of the weight y E(y) / ∫ E of a centroid. All lengths are in units of
/// the speckle size h.
///
/// # Validity
///
/// The model is a speckle pattern times a Gaussian irradiance, as in renderers. It is exact for the
/// moment `Σ y I` divided by the mean power. A centroid divides by a power that fluctuates itself,
/// and scatters less than to first order: by 7 % at most at w = h, 5 % at w = 2 h and 2.7 % at w =
/// 4 h.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::SpeckledLine;
///
/// let line = SpeckledLine::new(4.0, 1.0)?;
/// assert!((line.centroid_deviation() - 0.45281).abs() < 1e-5);
/// // The wings of the line have a long lever.
/// let window = line.with_window(2.0)?;
/// assert!(window.centroid_deviation() < line.centroid_deviation());
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckledLine {
    /// Standard deviation of the Gaussian, w/2.
    spread: f64,
    row_height: f64,
    /// Half the width of the window.
    window: f64,
}

impl SpeckledLine {
    /// Creates a line with the 1/e² half-width `radius` that is read in rows of `row_height`.
    ///
    /// # Errors
    ///
    /// Returns an error if the half-width is below 0.01, if the height is negative, or if either is
    /// above 10⁶.
    pub fn new(radius: f64, row_height: f64) -> Result<Self, StatisticsError> {
        check_range("radius", radius, [0.01, 1e6], "from 0.01 to 1e6")?;
        check_range("row_height", row_height, [0.0, 1e6], "from 0 to 1e6")?;
        Ok(Self {
            spread: 0.5 * radius,
            row_height,
            window: f64::INFINITY,
        })
    }

    /// Returns the line as seen through a window that reaches `half_width` to either side of its
    /// middle.
    ///
    /// # Errors
    ///
    /// Returns an error if the half-width is below a tenth of the half-width of the line.
    pub fn with_window(self, half_width: f64) -> Result<Self, StatisticsError> {
        let min = 0.2 * self.spread;
        let allowed = "at least a tenth of the half-width of the line";
        check_range("half_width", half_width, [min, f64::INFINITY], allowed)?;
        Ok(Self {
            window: half_width,
            ..self
        })
    }

    /// Returns the standard deviation of the centroid.
    pub fn centroid_deviation(&self) -> f64 {
        // Beyond fourteen standard deviations the weights do not overlap.
        let end = (2.0 * self.window).min(14.0 * self.spread);
        let longest = self.spread.min(self.window).min(1.0);
        let near = |lag: f64| self.weight_overlap(lag) * self.row_autocovariance(lag);
        let mut sum = integrate(near, [0.0, end.min(AVERAGED_FROM)], longest);
        let mut start = AVERAGED_FROM;
        while start < end {
            let next = (2.0 * start).min(end);
            sum += integrate(near, [start, next], self.spread.min(self.window));
            start = next;
        }
        let share = erf(self.window / (self.spread * 2.0_f64.sqrt()));
        (2.0 * sum).max(0.0).sqrt() / share
    }

    /// Returns the autocorrelation ∫ g(y) g(y + lag) dy of the weight g = y N(y), N being the
    /// normal density, over the window.
    fn weight_overlap(&self, lag: f64) -> f64 {
        let s = self.spread;
        let reach = (self.window - 0.5 * lag).max(0.0) / s;
        let inside = 0.5 * PI.sqrt() * erf(reach);
        // `u e^(−u²)` of an infinite window is NaN.
        let edge = if reach < 30.0 {
            reach * (-reach * reach).exp()
        } else {
            0.0
        };
        let half = 0.5 * lag / s;
        let moments = inside - edge - 2.0 * half * half * inside;
        moments * s * (-half * half).exp() / (2.0 * PI)
    }

    /// Returns the autocovariance of speckle that is averaged along the row, at a lag across the
    /// row.
    ///
    /// ```text
    /// (2/p) ∫₀ᵖ (1 − x/p) c(√(lag² + x²)) dx
    /// ```
    fn row_autocovariance(&self, lag: f64) -> f64 {
        let p = self.row_height;
        // The mean square distance in a row, p²/6, is then negligible.
        if p < 1e-8 {
            return autocovariance(lag);
        }
        let f = |x: f64| 2.0 / p * (1.0 - x / p) * autocovariance(lag.hypot(x));
        let oscillating = (AVERAGED_FROM * AVERAGED_FROM - lag * lag).max(0.0).sqrt();
        let mut start = oscillating.min(p);
        let mut sum = integrate(f, [0.0, start], 1.0);
        while start < p {
            let next = (2.0 * start.max(lag)).min(p);
            sum += integrate(f, [start, next], f64::INFINITY);
            start = next;
        }
        sum
    }
}

fn autocovariance(lag: f64) -> f64 {
    if lag < AVERAGED_FROM {
        airy_autocovariance(lag)
    } else {
        averaged_autocovariance(lag)
    }
}

fn check_range(
    parameter: &'static str,
    value: f64,
    [min, max]: [f64; 2],
    allowed: &'static str,
) -> Result<(), StatisticsError> {
    let holds = (min..=max).contains(&value);
    Ok(check::that(holds, parameter, value, "", allowed)?)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;
    use crate::centroid::row_spectrum::Row;

    /// The variance from the frequencies, for a line without a window: the spectrum of the weight
    /// times the spectrum of the rows.
    fn by_spectrum(radius: f64, row_height: f64) -> f64 {
        let s = 0.5 * radius;
        let row = Row::of_height(row_height);
        let density = |f: f64| {
            let weight = 2.0 * PI * s * s * f * (-2.0 * (PI * s * f).powi(2)).exp();
            2.0 * weight * weight * row.spectrum(f)
        };
        let end = (1.1 / s).min(1.0);
        let ends = [0.0, 1.0 / 256.0, 1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0].map(|x| x * end);
        let pieces = ends.windows(2);
        let pieces = pieces.map(|ends| integrate(density, [ends[0], ends[1]], end / 8.0));
        pieces.sum::<f64>().sqrt()
    }

    #[test]
    fn lags_and_frequencies_give_the_same_noise() {
        for radius in [0.25, 1.0, 4.0, 60.0, 3e4] {
            for row_height in [0.0, 0.25, 4.0, 300.0] {
                let line = SpeckledLine::new(radius, row_height).expect("a line");
                // Both sides are quadratures; the part averaged beyond 128 speckles is about 1e-9.
                assert_relative(
                    line.centroid_deviation(),
                    by_spectrum(radius, row_height),
                    3e-8,
                );
            }
        }
    }

    #[test]
    fn wide_lines_have_the_noise_of_the_closed_form() {
        // The spectrum of a point of a row is ℓ (1 − (3/4) ln(1/f) f² …) near 0, with f² of the
        // order of 1/w²: 1e-3 from w = 60 on.
        for row_height in [0.0, 0.5, 2.0] {
            let exact = SpeckledLine::new(200.0, row_height).expect("a line");
            let wide = line_centroid_deviation(200.0, row_height);
            assert_relative(exact.centroid_deviation(), wide, 1e-3);
        }
    }

    #[test]
    fn windows_cut_what_the_closed_form_of_wide_lines_says() {
        // σ² = ℓ s/(4√π) (erf t − 2t e^(−t²)/√π) / erf²(t/√2), with t the window in standard
        // deviations.
        for t in [0.5_f64, 1.0, 2.0, 3.0, 9.0] {
            let (radius, row_height) = (3e3, 0.7);
            let line = SpeckledLine::new(radius, row_height).expect("a line");
            let line = line.with_window(0.5 * radius * t).expect("a window");
            let part = erf(t) - 2.0 * t / PI.sqrt() * (-t * t).exp();
            let ratio = part.sqrt() / erf(t / 2.0_f64.sqrt());
            // The edges of the window blur over a speckle, t/3000 of it.
            assert_relative(
                line.centroid_deviation(),
                ratio * line_centroid_deviation(radius, row_height),
                5e-3,
            );
        }
    }
}
