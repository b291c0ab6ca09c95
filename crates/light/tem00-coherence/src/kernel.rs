//! Weights of the lags between the scatterers of a resolution cell, in speckles.

use core::f64::consts::{PI, TAU};
use std::sync::OnceLock;

use tem00_numerics::{cast::to_usize, disc_overlap, jinc, quadrature::for_each_node};

/// An isotropic weight of lags, of unit area: the kernel of the contrast, of the noise of tall
/// rows, or a mixture of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LagKernel {
    /// Weight of the contrast kernel in this kernel.
    pub(crate) contrast_like: f64,
}

impl LagKernel {
    /// The autocorrelation of the intensity of a point's image.
    pub(crate) const CONTRAST: Self = Self { contrast_like: 1.0 };

    /// Returns the weight of a lag.
    pub(crate) fn at(self, lag: f64) -> f64 {
        let mut weight = self.contrast_like * image_autocorrelation(lag);
        if self.contrast_like < 1.0 {
            weight += (1.0 - self.contrast_like) * image_of_point(lag);
        }
        weight
    }

    /// Returns the transform at a displacement of the pupil, in its diameters.
    pub(crate) fn transform(self, shift: f64) -> f64 {
        let chat = disc_overlap(shift);
        chat * (1.0 - self.contrast_like * (1.0 - chat))
    }
}

/// Lags per speckle in the table of the autocorrelation, and its last lag, beyond which a series is
/// equally accurate.
const LAGS: f64 = 64.0;
const LAST_LAG: f64 = 30.0;

/// Returns the intensity of a point's image, normalised to unit area, with lengths in speckles.
fn image_of_point(lag: f64) -> f64 {
    0.25 * PI * jinc(PI * lag).powi(2)
}

/// Returns the autocorrelation of the intensity of a point's image, normalised to unit area, with
/// lengths in speckles.
fn image_autocorrelation(lag: f64) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    if lag >= LAST_LAG {
        // Series from the cusp of chat² at 0: −8ρ/π + 4ρ³/3π.
        return 2.0 / (PI * lag).powi(3) + 0.75 / (PI * lag).powi(5);
    }
    let table = TABLE.get_or_init(|| {
        let count = to_usize(LAST_LAG * LAGS) + 3;
        (0..count)
            .map(|i| image_autocorrelation_by_frequencies(i as f64 / LAGS))
            .collect()
    });
    let at = lag * LAGS;
    let (first, t) = (to_usize(at), at.fract());
    // Interpolation through four points; the function is even.
    let [a, b, c, d] = [first.abs_diff(1), first, first + 1, first + 2].map(|i| table[i]);
    let [a, d] = [a * (1.0 - t) * (2.0 - t), d * (1.0 + t) * (1.0 - t)];
    let inner = b * (1.0 - t) * (2.0 - t) * (1.0 + t) + c * t * (1.0 + t) * (2.0 - t);
    0.5 * inner - t * (a + d) / 6.0
}

/// The transform of chat².
fn image_autocorrelation_by_frequencies(lag: f64) -> f64 {
    let mut sum = 0.0;
    for_each_node([0.0, 1.0], 1.0 / (1.0 + lag), |frequency, weight| {
        let transfer = disc_overlap(frequency).powi(2);
        sum += weight * TAU * frequency * transfer * libm::j0(TAU * frequency * lag);
    });
    sum
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;

    #[test]
    fn the_image_of_a_point_is_like_itself() {
        for lag in [0.0, 0.003, 0.31, 1.7, 12.345] {
            let exact = image_autocorrelation_by_frequencies(lag);
            assert_absolute(image_autocorrelation(lag), exact, 1e-7);
        }
        let [table, series] = [29.99, 30.01].map(image_autocorrelation);
        assert_relative(table, series, 0.05);
    }
}
