mod table;

use glam::DVec2;
use tem00_camera::IMAGE_MARGIN;

use self::table::HalfTable;
use crate::{TracerError, error::check};

/// The largest radius of a filter, in pixels.
const MAXIMUM_RADIUS: f64 = IMAGE_MARGIN;

/// Reconstruction filter: a kernel k(x) k(y) that weights the samples around a pixel, with x and y
/// in pixels from the centre of the pixel, 0 beyond its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// k = 1. With the radius ½, pixels do not overlap, like the pixels of a sensor.
    Box {
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
            Self::Box { radius } | Self::Gaussian { radius, .. } => radius,
        }
    }

    /// Returns the kernel k at `x`, in pixels, not normalised.
    pub fn kernel(&self, x: f64) -> f64 {
        if x.abs() > self.radius() {
            return 0.0;
        }
        match *self {
            Self::Box { .. } => 1.0,
            Self::Gaussian {
                standard_deviation, ..
            } => {
                let z = x / standard_deviation;
                libm::exp(-0.5 * z * z)
            }
        }
    }

    fn check(&self) -> Result<(), TracerError> {
        let radius = self.radius();
        check(
            "radius",
            radius,
            f64::MIN_POSITIVE..=MAXIMUM_RADIUS,
            "positive and at most 16 pixels",
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
            Self::Box { .. } => Ok(()),
        }
    }
}

/// Position and weight of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample {
    /// The offset from the centre of the pixel, in pixels.
    pub offset: DVec2,
    /// The factor on the light found there, of mean 1.
    pub weight: f64,
}

/// Draws samples for a [`Filter`], in proportion to its kernel.
///
/// The mean of weight times value is the filtered value:
///
/// ```text
/// ∫∫ k(x) k(y) f(x, y) dx dy / (∫ k dx)²
/// ```
///
/// Each coordinate grows with its uniform number, so that strata of the square stay strata. The
/// density is a table of 256 straight pieces to each side of the kernel; as the weights are formed
/// with the density of the table itself, there is no error from it. They differ from 1 by 1 % or
/// less, except in the faint tail of a Gaussian.
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
    /// Returns an error if the radius is not positive or exceeds 16 pixels, or if the standard
    /// deviation is below an eighth of it.
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

#[cfg(test)]
mod tests;
