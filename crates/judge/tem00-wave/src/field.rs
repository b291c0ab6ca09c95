use num_complex::Complex;
use tem00_numerics::Grid;

/// The complex amplitude of light at the samples of a plane or an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    amplitude: Grid<Complex<f64>>,
}

impl Field {
    pub(crate) const fn new(amplitude: Grid<Complex<f64>>) -> Self {
        Self { amplitude }
    }

    /// Returns the complex amplitude.
    pub const fn amplitude(&self) -> &Grid<Complex<f64>> {
        &self.amplitude
    }

    /// Returns the intensity: squared magnitude divided by its mean over the grid.
    ///
    /// A dark field has the intensity zero.
    pub fn intensity(&self) -> Grid<f32> {
        let values = self.amplitude.values();
        let largest = largest_magnitude(values);
        if largest == 0.0 {
            return self.amplitude.map(|_| 0.0);
        }
        let relative = |value: &Complex<f64>| (value / largest).norm_sqr();
        let count = values.len() as f64;
        let scale = count / values.iter().map(relative).sum::<f64>();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "intensities are stored as f32"
        )]
        self.amplitude.map(|value| (scale * relative(value)) as f32)
    }
}

/// The largest magnitude; divided by it, squares neither overflow nor vanish.
pub(crate) fn largest_magnitude(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|v| v.norm()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;

    #[test]
    fn intensity_has_the_mean_one_on_any_scale() {
        for scale in [1e-200, 1.0, 1e200] {
            let field = Field::new(Grid::from_fn(2, 1, |x, _| {
                Complex::new(scale, if x == 0 { 0.0 } else { scale })
            }));
            let intensity = field.intensity();
            // |1|² and |1 + i|² over their mean 1.5, rounded to f32.
            assert_absolute(intensity[(0, 0)].into(), 2.0 / 3.0, 1e-7);
            assert_absolute(intensity[(1, 0)].into(), 4.0 / 3.0, 2e-7);
        }
        let dark = Field::new(Grid::filled(2, 2, Complex::new(0.0, 0.0)));
        assert_eq!(dark.intensity(), Grid::filled(2, 2, 0.0));
    }
}
