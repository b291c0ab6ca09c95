use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{Fft2Scratch, Grid, cast::to_c32, cast::to_f32, sinc};

use super::transform::{frequency, plan, wave};
use crate::{SpeckleError, SpecklePattern};

/// The pixels of a sensor on a pattern: boxes of any size at any pitch.
///
/// Lengths are in samples of the pattern: a pixel of the size w on the sensor, where speckles are h
/// wide, is `w / h` [speckle sizes](SpecklePattern::speckle_size). The pixel (i, j) lies about
/// `origin + (i, j) · pitch`, the sample (0, 0) of the pattern about (0, 0). Beyond its period the
/// pattern repeats.
///
/// # Validity
///
/// The mean over each box is exact. The intensity has no frequencies above half the sampling
/// frequency, so its samples determine it everywhere; at a speckle size of just 2 samples, what lies at
/// that half itself counts in part. Pixels do not overlap the light of their neighbours by diffusion.
///
/// # Cost
///
/// n × m pixels of a pattern of W × H take `m W (H + n)` multiplications and `4 (n W + m H)` bytes.
///
/// # Examples
///
/// Pixels as large as a speckle see the contrast 0.711:
///
/// ```
/// use tem00_speckle::{PixelArray, PupilField};
///
/// let pattern = PupilField::new(256, 128, 1)?.pattern();
/// let pixels = PixelArray::new([128, 128], [2.0, 2.0])?;
/// let image = pixels.image(&pattern);
///
/// let values = image.values().iter().map(|&i| f64::from(i));
/// let square = values.map(|i| (i - 1.0).powi(2)).sum::<f64>() / 16_384.0;
/// assert!((square.sqrt() - 0.711).abs() < 0.02);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelArray {
    count: [usize; 2],
    pitch: [f64; 2],
    size: [f64; 2],
    origin: [f64; 2],
}

impl PixelArray {
    /// The largest number of pixels along an axis.
    pub const MAX_COUNT: usize = 1 << 15;
    /// The largest length, in samples: the position of a pixel is known to 10⁻⁴ of a sample there.
    pub const MAX_LENGTH: f64 = 1e12;

    /// Creates an array of `count` pixels, of the size of their `pitch` in samples, along x and y.
    ///
    /// The first pixel lies about the sample (0, 0).
    ///
    /// # Errors
    ///
    /// Returns an error unless `1 ≤ count ≤ MAX_COUNT` and `0 < pitch · count ≤ MAX_LENGTH` along
    /// both axes.
    pub fn new(count: [usize; 2], pitch: [f64; 2]) -> Result<Self, SpeckleError> {
        for axis in [0, 1] {
            if !(1..=Self::MAX_COUNT).contains(&count[axis]) {
                let (count, allowed) = (count[axis] as f64, "1 to 32768 pixels along each axis");
                return Err(SpeckleError::out_of_range("count", count, allowed));
            }
            let maximum = Self::MAX_LENGTH / count[axis] as f64;
            if !(pitch[axis] > 0.0 && pitch[axis] <= maximum) {
                let allowed = "positive, all pixels together at most 1e12 samples";
                return Err(SpeckleError::out_of_range("pitch", pitch[axis], allowed));
            }
        }
        Ok(Self {
            count,
            pitch,
            size: pitch,
            origin: [0.0; 2],
        })
    }

    /// Returns the same array with pixels of another size, smaller than the pitch or larger. Pixels
    /// of the size 0 are points.
    ///
    /// # Errors
    ///
    /// Returns an error unless `0 ≤ size ≤ MAX_LENGTH` along both axes.
    pub fn with_size(mut self, size: [f64; 2]) -> Result<Self, SpeckleError> {
        let good = |x: &f64| (0.0..=Self::MAX_LENGTH).contains(x);
        match size.into_iter().find(|x| !good(x)) {
            Some(bad) => Err(SpeckleError::out_of_range("size", bad, "0 to 1e12 samples")),
            None => {
                self.size = size;
                Ok(self)
            }
        }
    }

    /// Returns the same array with the middle of its first pixel at `origin`, in samples.
    ///
    /// # Errors
    ///
    /// Returns an error unless the origin is within ±`MAX_LENGTH` along both axes.
    pub fn with_origin(mut self, origin: [f64; 2]) -> Result<Self, SpeckleError> {
        let good = |x: &f64| x.abs() <= Self::MAX_LENGTH;
        match origin.into_iter().find(|x| !good(x)) {
            Some(bad) => {
                let allowed = "within ±1e12 samples";
                Err(SpeckleError::out_of_range("origin", bad, allowed))
            }
            None => {
                self.origin = origin;
                Ok(self)
            }
        }
    }

    /// Returns the number of pixels along x and y.
    pub const fn count(&self) -> [usize; 2] {
        self.count
    }

    /// Returns the distance of neighbours along x and y, in samples.
    pub const fn pitch(&self) -> [f64; 2] {
        self.pitch
    }

    /// Returns the width and the height of a pixel, in samples.
    pub const fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Returns where the middle of the first pixel lies, in samples.
    pub const fn origin(&self) -> [f64; 2] {
        self.origin
    }

    /// Returns the mean intensity over each pixel.
    pub fn image(&self, pattern: &SpecklePattern) -> Grid<f32> {
        let size = pattern.size();
        let [x, y] = [self.weights(0, size[0]), self.weights(1, size[1])];
        let mut image = Grid::filled(self.count[0], self.count[1], 0.0);
        image.for_each_row_mut(|j, pixels| {
            let mut line = vec![0.0; size[0]];
            for (&weight, samples) in y.row(j).iter().zip(pattern.values().rows()) {
                let weight = f64::from(weight);
                let pairs = line.iter_mut().zip(samples);
                pairs.for_each(|(sum, &sample)| *sum += weight * f64::from(sample));
            }
            for (pixel, weights) in pixels.iter_mut().zip(x.rows()) {
                let pairs = weights.iter().zip(&line);
                *pixel = to_f32(pairs.map(|(&weight, sum)| f64::from(weight) * sum).sum());
            }
        });
        image
    }

    /// For each pixel along an axis a row of weights of the `period` samples.
    ///
    /// ```text
    /// B(x) = 1/Q Σ_K sinc(πKw/Q) exp(2πi K (p − x)/Q)          −Q/2 < K ≤ Q/2
    /// ```
    ///
    /// The real part is taken: at K = Q/2, where samples hold a cosine only, it is what they hold.
    fn weights(&self, axis: usize, period: usize) -> Grid<f32> {
        let transform = plan([period, 1]);
        let length = period as f64;
        let box_spectrum: Vec<f64> = (0..period)
            .map(|k| sinc(PI * frequency(k, period) * (self.size[axis] / length)) / length)
            .collect();
        let mut spectrum = Grid::filled(period, 1, Complex::new(0.0, 0.0));
        let mut line = Grid::filled(period, 1, 0.0);
        let mut scratch = Fft2Scratch::default();
        let mut weights = Grid::filled(period, self.count[axis], 0.0);
        for (i, row) in weights.values_mut().chunks_exact_mut(period).enumerate() {
            let position = self.origin[axis] + i as f64 * self.pitch[axis];
            let turns = position.rem_euclid(length) / length;
            for (k, value) in spectrum.values_mut().iter_mut().enumerate() {
                *value = to_c32(wave(frequency(k, period) * turns) * box_spectrum[k]);
            }
            transform.forward_into(&spectrum, &mut line, &mut scratch, |_, _, value| value.re);
            row.copy_from_slice(line.values());
        }
        weights
    }
}

#[cfg(test)]
mod tests;
