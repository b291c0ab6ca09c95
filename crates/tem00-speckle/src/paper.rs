//! The look-up as printed in Bergmann et al. 2016, to reproduce its figures and show the
//! difference.
//!
//! | printed | here | consequence |
//! |---|---|---|
//! | bilinear interpolation of the intensity | [`BilinearStack::intensity_at`] | contrast 0.757 half-way between samples at a speckle size of 2 |
//! | linear blend of two intensity slices | [`BilinearStack::intensity_at`] | contrast 0.885 half-way between 2M = 16 slices |
//! | coordinates wrapped into [0, Q − 1] | [`BilinearStack::intensity_at`] | a jump in the pattern: samples Q − 1 and 0 coincide |
//! | slice coordinate wrapped into [0, 2M − 1] | [`BilinearStack::intensity_at`] | slices 2M − 1 and 0 coincide: a jump in time |

use tem00_numerics::Grid;

use crate::{Phasors, PupilField, SlicePath, SpeckleError, field::nearest_shift, mask::to_f64};

/// A stack of intensity slices on the circular path, interpolated as printed.
///
/// The mean is 1 everywhere, but the contrast falls between samples and between slices, and the
/// last interval along each axis is lost. Use [`SpeckleStack`](crate::SpeckleStack) for anything
/// but comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct BilinearStack {
    field: PupilField,
    path: SlicePath,
    slices: Vec<Grid<f32>>,
}

impl BilinearStack {
    /// Generates the 2M slices of `field`, with M = `half_period`.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ half_period ≤ SlicePath::MAX_HALF_PERIOD`.
    pub fn generate(field: &PupilField, half_period: usize) -> Result<Self, SpeckleError> {
        let path = SlicePath::Circle { half_period };
        path.check()?;
        let slice = |index| field.pattern_at(path.centre(index, field)).into_values();
        Ok(Self {
            slices: (0..path.slice_count()).map(slice).collect(),
            field: field.clone(),
            path,
        })
    }

    /// Returns the number of slices, 2M.
    pub const fn slice_count(&self) -> usize {
        self.slices.len()
    }

    /// Returns the number of samples Q along each axis; as printed, the period is Q − 1.
    pub const fn size(&self) -> usize {
        self.field.size()
    }

    /// Returns the intensity at (x, y) in samples and u in slices, as printed: bilinear in the
    /// plane, linear between slices, x and y wrapped into [0, Q − 1] and u into [0, 2M − 1].
    ///
    /// # Panics
    ///
    /// Panics unless `x`, `y` and `u` are finite.
    pub fn intensity_at(&self, x: f64, y: f64, u: f64) -> f64 {
        let (index, f) = wrap_as_printed(u, self.slices.len());
        let here = bilinear(&self.slices[index], x, y);
        let next = bilinear(&self.slices[index + 1], x, y);
        (1.0 - f) * here + f * next
    }

    /// Returns the contrast that bilinear interpolation of the intensity leaves at the fractions
    /// `fx` and `fy` between samples.
    ///
    /// ```text
    /// C² = a_x a_y + b_x a_y ρ₁₀ + a_x b_y ρ₀₁ + b_x b_y ρ₁₁ − 1/N
    /// a = (1 − f)² + f²,  b = 2 f (1 − f),  ρ = μ² at a lag of one sample
    /// ```
    ///
    /// The term 1/N belongs to unit phasors; ρ₁₁ is the mean over both diagonals.
    pub fn contrast_between_samples(&self, fx: f64, fy: f64) -> f64 {
        let rho = |x, y| self.field.amplitude_correlation([x, y]).powi(2);
        let (ax, bx) = square_and_cross(fx);
        let (ay, by) = square_and_cross(fy);
        let diagonal = 0.5 * (rho(1.0, 1.0) + rho(1.0, -1.0));
        let squared =
            ax * ay + bx * ay * rho(1.0, 0.0) + ax * by * rho(0.0, 1.0) + bx * by * diagonal;
        (squared - self.fixed_mean()).max(0.0).sqrt()
    }

    /// Returns the contrast that the linear blend leaves at the fraction `f` between the slices
    /// `index` and `index + 1`.
    ///
    /// ```text
    /// C² = (1 − f)² + f² + 2 f (1 − f) ρ² − 1/N [(1 − f)² + f² + 2 f (1 − f) ρ]
    /// ```
    ///
    /// with the overlap ρ of the two pupils; the bracket with 1/N belongs to unit phasors.
    ///
    /// # Panics
    ///
    /// Panics unless `index < slice_count`.
    pub fn contrast_between_slices(&self, index: usize, f: f64) -> f64 {
        assert!(
            index < self.slices.len(),
            "slice {index} of a stack of {}",
            self.slices.len()
        );
        let centre = |i: usize| self.path.centre(i % self.slices.len(), &self.field);
        let step = nearest_shift(centre(index), centre(index + 1), self.size());
        let rho = self.field.overlap(step);
        let (a, b) = square_and_cross(f);
        (a + b * rho * rho - self.fixed_mean() * (a + b * rho))
            .max(0.0)
            .sqrt()
    }

    /// The variance that a pattern lacks because its mean is fixed.
    fn fixed_mean(&self) -> f64 {
        match self.field.phasors() {
            Phasors::Unit => 1.0 / to_f64(self.field.phasor_count()),
            Phasors::Gaussian => 0.0,
        }
    }
}

/// (1 − f)² + f² and 2 f (1 − f).
fn square_and_cross(f: f64) -> (f64, f64) {
    let g = 1.0 - f;
    (g * g + f * f, 2.0 * f * g)
}

/// The interval and the fraction of a coordinate wrapped into [0, count − 1].
fn wrap_as_printed(x: f64, count: usize) -> (usize, f64) {
    tem00_numerics::wrap_coordinate(x, count - 1)
}

fn bilinear(slice: &Grid<f32>, x: f64, y: f64) -> f64 {
    let (column, fx) = wrap_as_printed(x, slice.width());
    let (row, fy) = wrap_as_printed(y, slice.height());
    let along = |row: usize| {
        let values = slice.row(row);
        (1.0 - fx) * f64::from(values[column]) + fx * f64::from(values[column + 1])
    };
    (1.0 - fy) * along(row) + fy * along(row + 1)
}
