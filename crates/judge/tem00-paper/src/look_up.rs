use core::f64::consts::PI;

use tem00_numerics::{Grid, available_memory};
use tem00_speckle::{Phasors, PupilField, SlicePath, SpeckleError, SpeckleScratch};

/// A stack of intensity slices on the circular path, interpolated as printed.
///
/// The mean is 1 everywhere, but the contrast falls between samples and between slices, and the
/// last interval along each axis is lost: coordinates are wrapped into [0, Q − 1] and [0, 2M − 1],
/// so that the pattern jumps where it repeats, in the plane and in time. Use
/// [`SpeckleStack`](tem00_speckle::SpeckleStack) for anything but comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct BilinearStack {
    field: PupilField,
    slices: Vec<Grid<f32>>,
}

impl BilinearStack {
    /// Generates the 2M slices of `field`, with M = `half_period`.
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ half_period ≤ SlicePath::MAX_HALF_PERIOD`, or if the memory, 4
    /// bytes per sample, cannot be allocated.
    pub fn generate(field: &PupilField, half_period: usize) -> Result<Self, SpeckleError> {
        let path = SlicePath::Circle { half_period };
        path.check()?;
        // A stack of amplitudes has 8 bytes per sample.
        let bytes = path.memory_bytes(field.size()) / 2;
        if available_memory().is_some_and(|available| bytes > available) {
            return Err(SpeckleError::Memory { bytes });
        }
        let [width, height] = field.size();
        let mut scratch = SpeckleScratch::default();
        let slice = |index| {
            let mut intensity = Grid::filled(width, height, 0.0);
            let offset = circle_offset(field, index, half_period);
            field.pattern_into(offset, 0.0, &mut intensity, &mut scratch);
            intensity
        };
        Ok(Self {
            slices: (0..path.slice_count()).map(slice).collect(),
            field: field.clone(),
        })
    }

    /// Returns the number of slices, 2M.
    pub const fn slice_count(&self) -> usize {
        self.slices.len()
    }

    /// Returns the number of samples along each axis; as printed, the period is one less.
    pub const fn size(&self) -> [usize; 2] {
        self.field.size()
    }

    /// Returns the intensity at (x, y) in samples and u in slices, as printed: bilinear in the
    /// plane, linear between slices, x and y wrapped into [0, Q − 1] and u into [0, 2M − 1]. If a
    /// coordinate is not finite, the result is the mean, 1.
    pub fn intensity_at(&self, x: f64, y: f64, u: f64) -> f64 {
        if ![x, y, u].iter().all(|coordinate| coordinate.is_finite()) {
            return 1.0;
        }
        let (index, f) = wrap_as_printed(u, self.slices.len());
        let here = bilinear(&self.slices[index], x, y);
        let next = bilinear(&self.slices[index + 1], x, y);
        (1.0 - f) * here + f * next
    }

    /// Returns the contrast after bilinear interpolation of the intensity at the fractions `fx` and
    /// `fy` between samples.
    ///
    /// ```text
    /// C² = a_x a_y + b_x a_y ρ₁₀ + a_x b_y ρ₀₁ + b_x b_y ρ₁₁ − 1/N
    /// a = (1 − f)² + f²,  b = 2 f (1 − f),  ρ = μ² at a lag of one sample
    /// ```
    ///
    /// The term 1/N belongs to unit phasors; ρ₁₁ is the mean over both diagonals.
    pub fn contrast_between_samples(&self, fx: f64, fy: f64) -> f64 {
        let rho = |x, y| self.field.amplitude_correlation([x, y]).norm_sqr();
        let (ax, bx) = square_and_cross(fx);
        let (ay, by) = square_and_cross(fy);
        let diagonal = 0.5 * (rho(1.0, 1.0) + rho(1.0, -1.0));
        let squared =
            ax * ay + bx * ay * rho(1.0, 0.0) + ax * by * rho(0.0, 1.0) + bx * by * diagonal;
        (squared - self.fixed_mean()).max(0.0).sqrt()
    }

    /// Returns the contrast after the linear blend at the fraction `f` between the slices `index`
    /// and `index + 1`.
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
        let half_period = self.slices.len() / 2;
        let [from, to] = [index, index + 1].map(|i| circle_centre(&self.field, i, half_period));
        let shift = [0, 1].map(|axis| to[axis] - from[axis]);
        let rho = self.field.overlap(shift).re;
        let (a, b) = square_and_cross(f);
        (a + b * rho * rho - self.fixed_mean() * (a + b * rho))
            .max(0.0)
            .sqrt()
    }

    /// The variance that is missing from a pattern because its mean is fixed.
    fn fixed_mean(&self) -> f64 {
        match self.field.phasors() {
            Some(Phasors::Gaussian) => 0.0,
            Some(Phasors::Unit) | None => self.field.effective_phasor_count().recip(),
        }
    }
}

/// The centre of the pupil of slice `index` on the circle of §6.4, rounded to lattice points so
/// that all pupils hold the same points.
#[expect(clippy::cast_possible_truncation, reason = "lattice points are small")]
fn circle_centre(field: &PupilField, index: usize, half_period: usize) -> [i64; 2] {
    let angle = PI * index as f64 / half_period as f64;
    let [x, y] = field.diameter().map(|diameter| 0.5 * diameter);
    [x * angle.cos(), y * angle.sin()].map(|centre| centre.round() as i64)
}

/// Offset of a slice on the circle, in pupil diameters.
fn circle_offset(field: &PupilField, index: usize, half_period: usize) -> [f64; 2] {
    let centre = circle_centre(field, index, half_period);
    [0, 1].map(|axis| centre[axis] as f64 / field.diameter()[axis])
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

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;

    fn stack(size: usize, diameter: usize, half_period: usize, seed: u64) -> BilinearStack {
        let field = PupilField::new(size, diameter, seed).unwrap();
        BilinearStack::generate(&field, half_period).unwrap()
    }

    /// Mean and variance of the look-up at one fraction of every printed cell, over seeds.
    fn moments(
        [size, diameter, half_period]: [usize; 3],
        [fx, fy]: [f64; 2],
        u: f64,
        seeds: u64,
    ) -> (f64, f64) {
        let (mut sum, mut square, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..seeds {
            let stack = stack(size, diameter, half_period, seed);
            let cells = u32::try_from(size).unwrap() - 1;
            for index in 0..cells * cells {
                let (x, y) = (f64::from(index % cells), f64::from(index / cells));
                let intensity = stack.intensity_at(x + fx, y + fy, u);
                sum += intensity;
                square += intensity * intensity;
                count += 1.0;
            }
        }
        let mean = sum / count;
        (mean, square / count - mean * mean)
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "exact by definition")]
    fn a_place_that_is_none_has_the_mean() {
        let stack = stack(16, 8, 1, 0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for [x, y, u] in [[bad, 0.0, 0.0], [0.0, bad, 0.0], [0.0, 0.0, bad]] {
                assert_eq!(stack.intensity_at(x, y, u), 1.0, "{x}, {y}, {u}");
            }
        }
    }

    #[test]
    fn bilinear_intensity_has_the_contrast_of_the_closed_form() {
        const SEEDS: u32 = 16;
        for (size, fractions) in [
            (64, [0.0, 0.0]),
            (64, [0.5, 0.5]),
            (64, [0.5, 0.0]),
            (64, [0.25, 0.75]),
            (128, [0.5, 0.5]),
            (256, [0.5, 0.5]),
        ] {
            let (mean, variance) = moments([size, 32, 1], fractions, 0.0, SEEDS.into());
            let [fx, fy] = fractions;
            let expected = stack(size, 32, 1, 0).contrast_between_samples(fx, fy);
            // The spread of a tile's squared contrast is 1.53/C; α = 6e−5. The row and the column
            // that the printed wrap omits shift the mean by about 1/64 · 2/√(2C).
            let tolerance = 4.0 * 1.53 / 32.0 / f64::from(SEEDS).sqrt();
            assert_absolute(variance, expected * expected, tolerance);
            assert!((mean - 1.0).abs() < 0.01, "{fractions:?}: mean {mean}");
        }
    }

    #[test]
    fn bilinear_contrast_has_its_known_values() {
        for (size, contrast) in [(256, 0.7566), (512, 0.9271), (1_024, 0.9809)] {
            let got = stack(size, 128, 1, 0).contrast_between_samples(0.5, 0.5);
            // 1/(2N) = 4e−5 for unit phasors, and the rounding of the four digits.
            assert!((got - contrast).abs() < 2e-4, "Q/C = {}: {got}", size / 128);
        }
    }

    #[test]
    fn blended_intensity_has_the_contrast_of_the_closed_form() {
        const SEEDS: u32 = 16;
        for f in [0.25, 0.5] {
            let (_, variance) = moments([64, 32, 8], [0.0, 0.0], 2.0 + f, SEEDS.into());
            let expected = stack(64, 32, 8, 0).contrast_between_slices(2, f);
            // The same tolerance as above.
            let tolerance = 4.0 * 1.53 / 32.0 / f64::from(SEEDS).sqrt();
            assert_absolute(variance, expected * expected, tolerance);
        }
        // √(1 − ½ (1 − γ₁)) with γ₁ = 0.5673 for M = 8, for a pupil large enough to count as a
        // disc.
        let got = stack(1_024, 512, 8, 0).contrast_between_slices(0, 0.5);
        assert!((got - 0.885).abs() < 2e-3, "contrast {got}");
    }

    #[test]
    fn a_stack_beyond_the_memory_is_refused() {
        let field = PupilField::new(1 << 15, 8, 0).unwrap();
        let refused = BilinearStack::generate(&field, 1 << 15);
        assert!(matches!(refused, Err(SpeckleError::Memory { .. })));
    }

    #[test]
    fn printed_wraps_lose_the_last_interval() {
        let printed = stack(32, 16, 3, 4);
        let pattern = |index: usize| {
            let field = &printed.field;
            field
                .pattern_at(circle_offset(field, index, 3), 0.0)
                .into_values()
        };
        let first = pattern(0);
        let at = |x, y, u| printed.intensity_at(x, y, u);
        // Sample Q − 1 is never reached: the look-up is back at sample 0.
        assert_absolute(at(31.0, 5.0, 0.0), f64::from(first[(0, 5)]), 1e-12);
        assert_absolute(at(5.0, 31.0, 0.0), f64::from(first[(5, 0)]), 1e-12);
        // Just before, the look-up was at sample Q − 1, so that the value jumps.
        let (last, jump) = (f64::from(first[(31, 5)]), at(31.0 - 1e-9, 5.0, 0.0));
        assert!((jump - last).abs() < 1e-6, "{jump} before the wrap");
        // The same for slice 2M − 1 = 5.
        assert_absolute(at(7.0, 5.0, 5.0), f64::from(first[(7, 5)]), 1e-12);
        let (last, jump) = (f64::from(pattern(5)[(7, 5)]), at(7.0, 5.0, 5.0 - 1e-9));
        assert!((jump - last).abs() < 1e-6, "{jump} before the wrap in u");
    }
}
