use core::f64::consts::PI;

use tem00_numerics::{check, quadrature::for_each_node, sinc};

use crate::{StatisticsError, centroid::row_spectrum::Row};

/// A column of pixels in a speckle pattern.
///
/// All lengths are in units of the speckle size h; behind an elliptical pupil, in units of the
/// speckle size along the same axis. The first of two numbers is across the column, along the rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelColumn {
    /// The width and height of the light-sensitive part of a pixel.
    pub size: [f64; 2],
    /// The distances between the centres of neighbouring pixels.
    pub pitch: [f64; 2],
    /// The number of pixels in the column.
    pub pixels: usize,
    /// The number of neighbouring columns that are averaged.
    pub averaged_columns: usize,
}

/// Covariance of the speckle in the pixels of a column, for a mean intensity of 1.
///
/// ```text
/// c_k = ∫∫ (4/π) chat(|f|) T²(f_x) sinc²(π s f_y) cos(2π k d f_y) df_x df_y
/// T(f) = sinc(π s_x f) sin(π N d_x f) / (N sin(π d_x f))      N averaged columns
/// ```
///
/// with the size s and the pitch d of the pixels. The variance of `Σ g_i E_i`, for pixels that
/// receive the irradiances `E_i` without speckle, is `Σ g_i E_i g_j E_j c_|i−j|`. N incoherent
/// patterns of equal strength divide the covariance by N; light with the degree of polarisation P
/// multiplies it by (1 + P²)/2.
///
/// # Validity
///
/// The speckle is fully developed behind a circular or elliptical pupil, and the irradiance hardly
/// changes within a pixel. The covariances are exact to 10⁻⁹.
///
/// # Examples
///
/// ```
/// use tem00_statistics::{pixel_contrast, laws::{PixelAutocovariance, PixelColumn}};
///
/// // Pixels half a speckle size wide, without gaps.
/// let column = PixelColumn {
///     size: [0.5, 0.5],
///     pitch: [0.5, 0.5],
///     pixels: 32,
///     averaged_columns: 1,
/// };
/// let speckle = PixelAutocovariance::new(&column)?;
/// let contrast = speckle.covariance(0).sqrt();
/// assert!((contrast - pixel_contrast(0.5)).abs() < 1e-8);
/// assert!(speckle.covariance(1) > 0.4 && speckle.covariance(4) < 0.01);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PixelAutocovariance {
    values: Vec<f64>,
}

/// The longest column and the widest average, in units of h: the computing time grows with both.
const LONGEST: f64 = 4096.0;

impl PixelAutocovariance {
    /// Integrates the covariances of the pixels of a column.
    ///
    /// # Errors
    ///
    /// Returns an error if a pixel is larger than the pitch, if a length is negative or not finite,
    /// if there are no pixels or no columns, or if they span more than 4096 speckle sizes.
    pub fn new(column: &PixelColumn) -> Result<Self, StatisticsError> {
        check_column(column)?;
        let row = Row::of_pixels(
            column.size[0],
            column.pitch[0],
            column.averaged_columns as f64,
        );
        let [height, pitch] = [column.size[1], column.pitch[1]];
        let extent = pitch * (column.pixels - 1) as f64 + height;
        let mut values = vec![0.0; column.pixels];
        // With f = t² the nodes concentrate at the kink of the spectrum. All lags share the nodes.
        let longest = (0.5 / extent).min(0.125);
        for_each_node([0.0, 1.0], longest, |t, weight| {
            let f = t * t;
            let pixel = sinc(PI * height * f);
            let spectrum = 4.0 * t * weight * row.spectrum(f) * pixel * pixel;
            add_cosines(&mut values, spectrum, 2.0 * PI * pitch * f);
        });
        Ok(Self { values })
    }

    /// Returns the covariance of two pixels of the column that are `lag` pixels apart; 0 beyond the
    /// column.
    pub fn covariance(&self, lag: usize) -> f64 {
        self.values.get(lag).copied().unwrap_or(0.0)
    }

    /// Returns the covariances of pixels 0, 1, 2 … apart.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the variance of `Σ amplitudes[i] s[i]`, where s is the speckle in the pixels of the
    /// column.
    ///
    /// An amplitude is the irradiance of a pixel times the sensitivity of a result to it.
    ///
    /// # Panics
    ///
    /// Panics unless `amplitudes.len() ≤ pixels`.
    pub fn variance(&self, amplitudes: &[f64]) -> f64 {
        assert!(
            amplitudes.len() <= self.values.len(),
            "more amplitudes than pixels"
        );
        let products = |lag: usize| {
            let pairs = amplitudes.iter().zip(&amplitudes[lag..]);
            pairs.map(|(a, b)| a * b).sum::<f64>()
        };
        let lags = 1..amplitudes.len();
        let beside: f64 = lags.map(|lag| products(lag) * self.values[lag]).sum();
        // A variance that consists of rounding errors may be negative.
        (products(0) * self.values[0] + 2.0 * beside).max(0.0)
    }
}

fn check_column(column: &PixelColumn) -> Result<(), StatisticsError> {
    let counts = [column.averaged_columns, column.pixels];
    for (axis, count) in counts.into_iter().enumerate() {
        let [size, pitch] = [column.size[axis], column.pitch[axis]];
        check::positive("pitch", pitch, "")?;
        let allowed = "at least 0 and at most the pitch";
        check::that((0.0..=pitch).contains(&size), "size", size, "", allowed)?;
        let name = ["averaged_columns", "pixels"][axis];
        let allowed = "at least 1 and span at most 4096 speckle sizes";
        let holds = count > 0 && count as f64 * pitch <= LONGEST;
        check::that(holds, name, count, "", allowed)?;
    }
    Ok(())
}

/// Adds `amplitude · cos(k angle)` to the value k.
fn add_cosines(values: &mut [f64], amplitude: f64, angle: f64) {
    // cos((k + 1) a) = 2 cos a cos(k a) − cos((k − 1) a) accumulates k² roundings for small angles:
    // each cosine is computed on its own.
    for (lag, value) in values.iter_mut().enumerate() {
        *value += amplitude * (lag as f64 * angle).cos();
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::{airy_autocovariance, laws::SpeckledLine, rectangular_pixel_contrast};

    const COLUMN: PixelColumn = PixelColumn {
        size: [0.6, 0.5],
        pitch: [0.8, 0.7],
        pixels: 24,
        averaged_columns: 1,
    };

    fn of(column: &PixelColumn) -> PixelAutocovariance {
        PixelAutocovariance::new(column).expect("a column")
    }

    #[test]
    fn a_pixel_has_the_contrast_of_its_area() {
        for size in [[0.1, 0.1], [0.5, 2.0], [3.0, 1.0]] {
            let pitch = size;
            let speckle = of(&PixelColumn {
                size,
                pitch,
                ..COLUMN
            });
            let contrast = rectangular_pixel_contrast(size);
            assert_absolute(speckle.covariance(0).sqrt(), contrast, 1e-8);
        }
    }

    #[test]
    fn points_have_the_autocovariance_of_the_speckle() {
        let point = PixelColumn {
            size: [0.0, 0.0],
            ..COLUMN
        };
        let pair = PixelColumn {
            averaged_columns: 2,
            ..point
        };
        let (one, two) = (of(&point), of(&pair));
        for lag in 0..COLUMN.pixels {
            let across = lag as f64 * COLUMN.pitch[1];
            let same = airy_autocovariance(across);
            let beside = airy_autocovariance(across.hypot(COLUMN.pitch[0]));
            assert_absolute(one.covariance(lag), same, 1e-9);
            assert_absolute(two.covariance(lag), 0.5 * (same + beside), 1e-9);
        }
        assert!(one.covariance(COLUMN.pixels).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn pixels_average_the_autocovariance_over_their_area() {
        // The midpoint rule over the differences of two points in two pixels has an error of the
        // second derivative, about 5, divided by 24 · 50², or less, as the triangles meet without a
        // step.
        const STEPS: u32 = 100;
        let difference = |step: u32| (f64::from(step) + 0.5) / 50.0 - 1.0;
        let speckle = of(&COLUMN);
        for lag in [0_u32, 1, 2, 5] {
            let across = f64::from(lag) * COLUMN.pitch[1];
            let mut sum = 0.0;
            for y in (0..STEPS).map(difference) {
                for x in (0..STEPS).map(difference) {
                    let weight = (1.0 - x.abs()) * (1.0 - y.abs()) / 2500.0;
                    let lag = (COLUMN.size[0] * x).hypot(across + COLUMN.size[1] * y);
                    sum += weight * airy_autocovariance(lag);
                }
            }
            assert_absolute(speckle.covariance(lag as usize), sum, 1e-4);
        }
    }

    #[test]
    fn columns_without_gaps_average_like_one_wide_pixel() {
        let many = of(&PixelColumn {
            size: [0.8, 0.5],
            averaged_columns: 30,
            ..COLUMN
        });
        let wide = of(&PixelColumn {
            size: [24.0, 0.5],
            pitch: [24.0, 0.7],
            ..COLUMN
        });
        for (many, wide) in many.values().iter().zip(wide.values()) {
            assert_absolute(*many, *wide, 1e-9);
        }
    }

    #[test]
    fn a_line_of_fine_pixels_has_the_noise_of_the_line() {
        let (radius, pitch) = (3.0, 0.25);
        let speckle = of(&PixelColumn {
            size: [1.0, pitch],
            pitch: [1.0, pitch],
            pixels: 64,
            averaged_columns: 1,
        });
        let places = (0..64_u32).map(|i| (f64::from(i) - 31.5) * pitch);
        let irradiance = |y: f64| (-2.0 * (y / radius).powi(2)).exp();
        let power: f64 = places.clone().map(irradiance).sum();
        let amplitudes: Vec<_> = places.map(|y| y * irradiance(y) / power).collect();
        let line = SpeckledLine::new(radius, 1.0).expect("a line");
        // Pixels hide the fraction (π 0.25 f)²/3 of the frequency f, where f² is about 3/(2π w)².
        let ratio = speckle.variance(&amplitudes).sqrt() / line.centroid_deviation();
        assert!((ratio - 1.0).abs() < 3e-3, "{ratio}");
    }
}
