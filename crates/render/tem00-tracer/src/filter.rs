mod table;

use core::f64::consts::PI;

use glam::DVec2;
use tem00_camera::IMAGE_MARGIN;
use tem00_numerics::sinc;

use self::table::HalfTable;
use crate::TracerError;

/// The largest radius of a filter, in pixels.
const MAXIMUM_RADIUS: f64 = IMAGE_MARGIN;

/// Reconstruction filter: a kernel k(x) k(y) that weights the samples around a pixel, with x and y
/// in pixels from the centre of the pixel, 0 beyond its radius.
///
/// # References
///
/// - D. P. Mitchell and A. N. Netravali, *Reconstruction Filters in Computer Graphics*, 1988, eq. 8.
/// - C. E. Duchon, *Lanczos Filtering in One and Two Dimensions*, 1979.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// k = 1. With the radius ½ pixels do not overlap and are what the pixels of a sensor are.
    Box {
        /// The radius, in pixels.
        radius: f64,
    },
    /// k = 1 − |x| / radius.
    Tent {
        /// The radius, in pixels.
        radius: f64,
    },
    /// k = exp(−x² / 2σ²), cut off at the radius.
    Gaussian {
        /// The radius, in pixels.
        radius: f64,
        /// The standard deviation σ, in pixels, at least an eighth of the radius.
        standard_deviation: f64,
    },
    /// The cubic splines of Mitchell and Netravali; B = C = ⅓ is their compromise between blur,
    /// ringing and blocks.
    MitchellNetravali {
        /// The radius, in pixels; 2 in the original.
        radius: f64,
        /// The parameter B, between 0 and 1.
        b: f64,
        /// The parameter C, between 0 and 1.
        c: f64,
    },
    /// k = sinc(x) sinc(x / radius), with sinc x = sin(πx) / (πx). Its negative lobes ring at edges.
    Lanczos {
        /// The radius, in pixels, at least 1.
        radius: f64,
    },
}

impl Default for Filter {
    /// The box of one pixel.
    fn default() -> Self {
        Self::Box { radius: 0.5 }
    }
}

impl Filter {
    /// Returns the radius beyond which the kernel is 0, in pixels.
    pub const fn radius(&self) -> f64 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::MitchellNetravali { radius, .. }
            | Self::Lanczos { radius } => radius,
        }
    }

    /// Returns the kernel k at `x`, in pixels, not normalised.
    ///
    /// # Examples
    ///
    /// A Lanczos filter leaves the neighbours of a pixel out:
    ///
    /// ```
    /// use tem00_tracer::Filter;
    ///
    /// let filter = Filter::Lanczos { radius: 3.0 };
    /// assert_eq!(filter.kernel(0.0), 1.0);
    /// assert!(filter.kernel(1.0).abs() < 1e-15);
    /// assert!(filter.kernel(1.5) < -0.1);
    /// ```
    pub fn kernel(&self, x: f64) -> f64 {
        let x = x.abs();
        if x > self.radius() {
            return 0.0;
        }
        match *self {
            Self::Box { .. } => 1.0,
            Self::Tent { radius } => 1.0 - x / radius,
            Self::Gaussian {
                standard_deviation, ..
            } => {
                let z = x / standard_deviation;
                libm::exp(-0.5 * z * z)
            }
            Self::MitchellNetravali { radius, b, c } => mitchell_netravali(2.0 * x / radius, b, c),
            Self::Lanczos { radius } => sinc(PI * x) * sinc(PI * x / radius),
        }
    }

    fn check(&self) -> Result<(), TracerError> {
        let smallest = if matches!(self, Self::Lanczos { .. }) {
            1.0
        } else {
            f64::MIN_POSITIVE
        };
        let radius = self.radius();
        check(
            "radius",
            radius,
            smallest..=MAXIMUM_RADIUS,
            "positive and at most 16 pixels, of a Lanczos filter at least 1",
        )?;
        match *self {
            Self::Gaussian {
                standard_deviation, ..
            } => check(
                "standard_deviation",
                standard_deviation,
                radius / 8.0..=f64::MAX,
                "finite and at least an eighth of the radius (in pixels)",
            ),
            Self::MitchellNetravali { b, c, .. } => {
                check("b", b, 0.0..=1.0, "between 0 and 1")?;
                check("c", c, 0.0..=1.0, "between 0 and 1")
            }
            _ => Ok(()),
        }
    }
}

/// Position and weight of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// The offset from the centre of the pixel, in pixels.
    pub offset: DVec2,
    /// The factor on what is seen there; negative in the negative lobes of the kernel.
    pub weight: f64,
}

/// Draws samples for a [`Filter`], in proportion to the magnitude of its kernel.
///
/// The mean of weight times value is the filtered value:
///
/// ```text
/// ∫∫ k(x) k(y) f(x, y) dx dy / (∫ k dx)²
/// ```
///
/// Each coordinate grows with its uniform number, so that strata of the square stay strata. The
/// density is a table of 256 straight pieces to each side of the kernel; as the weights are formed
/// with the density of the table itself, there is no error from it. They differ from
/// ±(∫|k| dx / ∫k dx)² by 1 % or less, except beside the zeros of the kernel.
///
/// # Examples
///
/// The default leaves samples where they are in their pixel:
///
/// ```
/// use glam::DVec2;
/// use tem00_tracer::{Filter, FilterSampler};
///
/// let sampler = FilterSampler::new(Filter::default())?;
/// let sample = sampler.sample([0.25, 0.75]);
/// assert_eq!((sample.offset, sample.weight), (DVec2::new(-0.25, 0.25), 1.0));
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FilterSampler {
    filter: Filter,
    /// `None` for the box, which needs none.
    table: Option<HalfTable>,
}

impl FilterSampler {
    /// Prepares a filter.
    ///
    /// # Errors
    ///
    /// Returns an error if the radius is not positive, exceeds 16 pixels or, of a Lanczos filter,
    /// falls below 1, or if another parameter is outside of its range.
    pub fn new(filter: Filter) -> Result<Self, TracerError> {
        filter.check()?;
        let tabulated = !matches!(filter, Filter::Box { .. });
        Ok(Self {
            filter,
            table: tabulated.then(|| HalfTable::new(|x| filter.kernel(x), filter.radius())),
        })
    }

    /// Returns the filter.
    pub const fn filter(&self) -> Filter {
        self.filter
    }

    /// Draws a sample by two uniform numbers in [0, 1).
    #[inline(always)]
    pub fn sample(&self, u: [f64; 2]) -> FilterSample {
        let [x, y] = u.map(|u| self.sample_axis(2.0 * u - 1.0));
        FilterSample {
            offset: DVec2::new(x.0, y.0),
            weight: x.1 * y.1,
        }
    }

    /// Returns offset and weight along one axis for a number in [−1, 1).
    #[inline(always)]
    fn sample_axis(&self, signed: f64) -> (f64, f64) {
        match &self.table {
            None => (self.filter.radius() * signed, 1.0),
            Some(table) => {
                let (x, density) = table.sample(signed.abs());
                let weight = if density > 0.0 {
                    self.filter.kernel(x) / (table.integral() * density)
                } else {
                    0.0
                };
                (x.copysign(signed), weight)
            }
        }
    }
}

/// The kernel for `x` in [0, 2].
fn mitchell_netravali(x: f64, b: f64, c: f64) -> f64 {
    let coefficients = if x < 1.0 {
        [
            6.0 - 2.0 * b,
            0.0,
            -18.0 + 12.0 * b + 6.0 * c,
            12.0 - 9.0 * b - 6.0 * c,
        ]
    } else {
        [
            8.0 * b + 24.0 * c,
            -12.0 * b - 48.0 * c,
            6.0 * b + 30.0 * c,
            -b - 6.0 * c,
        ]
    };
    let [k0, k1, k2, k3] = coefficients;
    (k0 + x * (k1 + x * (k2 + x * k3))) / 6.0
}

fn check(
    parameter: &'static str,
    value: f64,
    range: core::ops::RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), TracerError> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(TracerError::OutOfRange {
        parameter,
        value,
        allowed,
    })
}

#[cfg(test)]
mod tests;
