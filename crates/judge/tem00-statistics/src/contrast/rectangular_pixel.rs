use core::f64::consts::{FRAC_PI_2, PI};

use tem00_numerics::{
    disc_overlap,
    quadrature::{integrate, integrate_from_root},
};

use crate::{airy_autocovariance, laws::translation_contrast};

/// Returns the contrast of fully developed speckle on rectangular pixels that integrate over their
/// area, where `pixel_size` is their width and height in units of the speckle size h.
///
/// ```text
/// C² = 4 ∫₀¹∫₀¹ (1−x)(1−y) c(√(q_x²x² + q_y²y²)) dx dy      c the Airy autocovariance
/// ```
///
/// The size is the size of the light-sensitive area: the pitch of the pixels and the gaps between
/// them do not matter. For pixels of one speckle size by two the contrast is 0.559. The function is
/// even in both sizes, and for zero height it equals
/// [`translation_contrast`](crate::laws::translation_contrast).
///
/// The approximation that uses only the coherence area `A_c = (4/π) h²`,
///
/// ```text
/// C² ≈ G(q_x) G(q_y)      G(q) = √(A_c)/q erf(√π q/√A_c) − (A_c/πq²)(1 − exp(−πq²/A_c))
/// ```
///
/// which replaces the autocovariance by a Gaussian, is larger by up to 11 % of C² for a square.
///
/// # Validity
///
/// The pupil is circular, the sensitivity is uniform within the rectangle, and there is no
/// diffusion in the sensor. The relative error is below 10⁻⁸.
///
/// # Examples
///
/// ```
/// use tem00_statistics::{pixel_contrast, rectangular_pixel_contrast};
///
/// let square = rectangular_pixel_contrast([1.0, 1.0]);
/// assert!((square - pixel_contrast(1.0)).abs() < 1e-8);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4 (integrated speckle).
pub fn rectangular_pixel_contrast(pixel_size: [f64; 2]) -> f64 {
    let [width, height] = pixel_size.map(f64::abs);
    let pixel = Sides {
        long: width.max(height),
        short: width.min(height),
    };
    // The contrast is even in the short side, whose square is then negligible.
    if pixel.short < 1e-9 {
        return translation_contrast(pixel.long);
    }
    if pixel.short.is_infinite() || pixel.long.is_infinite() {
        return 0.0;
    }
    2.0 * pixel.integral().sqrt() / pixel.long.sqrt() / pixel.short.sqrt()
}

/// The sides of a rectangle, in units of h.
#[derive(Clone, Copy, Debug)]
struct Sides {
    long: f64,
    short: f64,
}

/// Distance from which the autocovariance is replaced by its mean over its oscillation, at a zero
/// of the integral of the oscillation.
pub(crate) const AVERAGED_FROM: f64 = 128.25;

impl Sides {
    /// Returns ∫ c(r) r g(r) dr, where r g is the density of the distance of two random points of
    /// the rectangle up to a factor 4 / (long · short). It has a root where r equals either side.
    fn integral(&self) -> f64 {
        let diagonal = self.long.hypot(self.short);
        let within = |r: f64| {
            let (x, y) = (r / self.long, r / self.short);
            FRAC_PI_2 - x - y + 0.5 * x * y
        };
        weigh(within, [0.0, self.short])
            + self.integral_across()
            + weigh(|r| self.corner(r), [self.long, diagonal])
    }

    /// Returns the part between the short and the long side, in pieces: g changes over distances of
    /// the order of r.
    fn integral_across(&self) -> f64 {
        let (mut start, mut sum) = (self.short, 0.0);
        while start < self.long {
            let end = (8.0 * start).min(self.long);
            sum += weigh(|r| self.across(r), [start, end]);
            start = end;
        }
        sum
    }

    /// Returns g between the short and the long side.
    fn across(&self, r: f64) -> f64 {
        let root = distance(r, self.short);
        let angle = self.short.atan2(root);
        angle - self.short / (r + root) - 0.5 * self.short / self.long
    }

    /// Returns g beyond the long side.
    fn corner(&self, r: f64) -> f64 {
        let (root, other) = (distance(r, self.short), distance(r, self.long));
        let angle = self.short.atan2(root) - other.atan2(self.long);
        let (rest, share) = (self.short - other, other / self.long);
        let missing = rest / self.short * (self.short + other) / (root + self.long);
        angle - 0.5 * self.short / self.long - missing + share - 0.5 * share * (other / self.short)
    }
}

/// Returns √(r² − side²) for r ≥ side.
fn distance(r: f64, side: f64) -> f64 {
    ((r - side).max(0.0)).sqrt() * (r + side).sqrt()
}

/// Returns ∫ c(r) r g(r) dr over a range of distances at whose start g has a root.
fn weigh(g: impl Fn(f64) -> f64, [start, end]: [f64; 2]) -> f64 {
    let near_end = end.min(AVERAGED_FROM);
    let near = |r: f64| airy_autocovariance(r) * r * g(r);
    // One period of the oscillation per panel where r grows fastest, at t = 1.
    let panels = 2.0 * (near_end - start).max(0.0) + 2.0;
    let sum = integrate_from_root(near, [start, near_end], panels.recip());
    // The integral is in the logarithm of r; the part beyond e⁴⁵ is below 10⁻¹⁹ of the rest.
    let far_start = start.max(AVERAGED_FROM);
    let far = |s: f64| {
        let r = far_start * s.exp();
        averaged_autocovariance(r) * r * r * g(r)
    };
    let far_end = (end.max(far_start) / far_start).ln().min(45.0);
    sum + integrate_from_root(far, [0.0, far_end], 1.0 / 32.0)
}

/// Returns the mean of the Airy autocovariance over its oscillation, far from the centre: J₁² is
/// (1 + 3/8x²)/πx on average.
pub(crate) fn averaged_autocovariance(r: f64) -> f64 {
    let x = PI * r;
    4.0 / (PI * x) / (x * x) * (1.0 + 0.375 / (x * x))
}

/// Returns the contrast of fully developed speckle behind a Gaussian filter: a sensor whose pixels
/// weight the intensity with a Gaussian of the standard deviation `spread` along both axes, in
/// units of the speckle size h, or a renderer with such a reconstruction filter.
///
/// ```text
/// C² = 8 ∫₀¹ chat(ρ) exp(−(2π spread ρ)²) ρ dρ
/// C² ≈ 1 / (1 + 4π spread² / A_c)        spread → ∞, with A_c = 4/π
/// ```
///
/// # Validity
///
/// The pupil is circular, and the cut-off of the filter is negligible. The function is even.
///
/// # Examples
///
/// ```
/// use tem00_statistics::laws::gaussian_filter_contrast;
///
/// assert!((gaussian_filter_contrast(0.0) - 1.0).abs() < 1e-12);
/// assert!((gaussian_filter_contrast(0.5) - 0.513).abs() < 1e-3);
/// ```
pub fn gaussian_filter_contrast(spread: f64) -> f64 {
    let steepness = 2.0 * PI * spread.abs();
    // exp(−6.5²) = 5e−19.
    let reach = steepness.min(6.5);
    let end = (6.5 / steepness).min(1.0);
    // The integration starts at the end, where chat has its root if `end` is 1.
    let integrand = |t: f64| {
        let share = 1.0 - t * t;
        let filter = (-(reach * share).powi(2)).exp();
        16.0 * t * disc_overlap(end * share) * share * filter
    };
    end * integrate(integrand, [0.0, 1.0], 0.125).sqrt()
}

#[cfg(test)]
mod tests {
    use tem00_numerics::sinc;
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use crate::intensity::bessel::scaled_bessel_i0;

    /// C² from the frequencies: the transfer function of the box times the power spectrum.
    fn squared_by_spectrum([q_x, q_y]: [f64; 2]) -> f64 {
        let radial = |phi: f64| {
            let (sin, cos) = phi.sin_cos();
            let integrand = |t: f64| {
                let rho = 1.0 - t * t;
                let transfer = sinc(PI * q_x * rho * cos) * sinc(PI * q_y * rho * sin);
                transfer * transfer * disc_overlap(rho) * rho * 2.0 * t
            };
            integrate(integrand, [0.0, 1.0], 0.05)
        };
        16.0 / PI * integrate(radial, [0.0, FRAC_PI_2], 0.02)
    }

    #[test]
    fn squared_contrast_is_the_filtered_power_spectrum() {
        let sizes = [
            [0.5, 0.5],
            [1.0, 2.0],
            [3.0, 2.999],
            [1e-6, 1.5],
            [0.2, 7.0],
            [20.0, 1.0],
        ];
        for size in sizes {
            let squared = squared_by_spectrum(size);
            let contrast = rectangular_pixel_contrast(size);
            assert_relative(contrast * contrast, squared, 1e-9);
            let turned = rectangular_pixel_contrast([-size[1], size[0]]);
            assert_relative(turned, contrast, 1e-15);
        }
    }

    #[test]
    fn a_pixel_without_height_is_a_drift() {
        for length in [0.3, 2.0, 40.0, 1e3, 1e30] {
            let drift = translation_contrast(length);
            let line = rectangular_pixel_contrast([1e-8, length]);
            assert_relative(line, drift, 1e-8);
        }
        let point = rectangular_pixel_contrast([1e-30, 0.0]);
        assert_absolute(point, 1.0, 1e-14);
    }

    #[test]
    fn large_pixels_hold_their_area_in_coherence_areas() {
        // C² → (4/π) / (q_x q_y), with a relative correction of about ln q / q.
        for size in [[1e8, 1e9], [1e30, 1e12], [1e200, 1e200]] {
            let [long, short] = size.map(f64::sqrt);
            let scaled = rectangular_pixel_contrast(size) * long * short;
            assert_relative(scaled, (4.0 / PI).sqrt(), 1e-6);
        }
        assert!(rectangular_pixel_contrast([f64::INFINITY, 1.0]).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn gaussian_filter_has_its_closed_form() {
        // With z = (2π spread)²/2: C² = (2/z) (1 − e⁻ᶻ (I₀(z) + I₁(z))), by parts; the derivative
        // of I₀ is I₁.
        let scaled_i1 = |z: f64| {
            let step = 1e-4;
            let value = |z: f64| scaled_bessel_i0(z);
            let slope = (8.0 * (value(z + step) - value(z - step)) - value(z + 2.0 * step)
                + value(z - 2.0 * step))
                / (12.0 * step);
            slope + value(z)
        };
        for spread in [0.1, 0.5, 1.0, 3.0] {
            let z = 0.5 * (2.0 * PI * spread).powi(2);
            let squared = 2.0 / z * (1.0 - scaled_bessel_i0(z) - scaled_i1(z));
            let contrast = gaussian_filter_contrast(spread);
            // The difference quotient has an error of 1e−12, times 2/z = 10.
            assert_absolute(contrast * contrast, squared, 3e-11);
        }
        let far = gaussian_filter_contrast(1e30) * 1e30;
        // 1/(4π spread²/A_c) = 1/(π spread)².
        assert_relative(far, PI.recip(), 1e-12);
        assert!(gaussian_filter_contrast(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }
}
