//! Patterns and fields behind a pupil at any position and defocus.

use core::f64::consts::PI;

use num_complex::Complex;
use tem00_numerics::{
    Fft2Scratch, Grid,
    cast::{to_c32, to_f32, to_signed},
};

use crate::{Aperture, PupilField, SpeckleField, SpecklePattern};

const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// Working memory of [`PupilField::pattern_into`] and [`PupilField::speckle_into`], kept between
/// calls.
///
/// It fits any field and grows to the size of the largest.
#[derive(Clone, Debug, Default)]
pub struct SpeckleScratch {
    transform: Fft2Scratch,
}

impl PupilField {
    /// Returns the intensity behind the undisplaced pupil in focus.
    pub fn pattern(&self) -> SpecklePattern {
        self.pattern_at([0.0; 2], 0.0)
    }

    /// Returns the intensity behind the pupil displaced by `offset` diameters and out of focus by
    /// `defocus`, as the type [defines](Self#defocus) it.
    ///
    /// Any displacement is exact, on a lattice point or between points: the pupil selects its
    /// points anew, and the sum over their squares normalises the pattern.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::new(256, 128, 3)?;
    /// let mean = |product: &dyn Fn(usize) -> f32| {
    ///     (0..256 * 256).map(|i| f64::from(product(i))).sum::<f64>() / 65_536.0
    /// };
    /// let (before, after) = (field.pattern(), field.pattern_at([0.25, 0.0], 0.0));
    /// let (a, b) = (before.values().values(), after.values().values());
    ///
    /// // A quarter of the pupil's diameter leaves the correlation chat(¼)² = 0.47.
    /// let correlation = mean(&|i| (a[i] - 1.0) * (b[i] - 1.0));
    /// assert!((correlation - 0.47).abs() < 0.03);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn pattern_at(&self, offset: [f64; 2], defocus: f64) -> SpecklePattern {
        let mut values = Grid::filled(self.size()[0], self.size()[1], 0.0);
        self.pattern_into(offset, defocus, &mut values, &mut SpeckleScratch::default());
        SpecklePattern::new(values, self.speckle_size())
    }

    /// Writes the intensity of [`pattern_at`](Self::pattern_at) into an existing grid, with
    /// existing working memory.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite and `intensity` has the size of the pattern.
    pub fn pattern_into(
        &self,
        offset: [f64; 2],
        defocus: f64,
        intensity: &mut Grid<f32>,
        scratch: &mut SpeckleScratch,
    ) {
        let aperture = self.aperture(offset, defocus);
        let scale = to_f32(1.0 / aperture.power());
        self.transform.forward_from(
            |columns, y, values| aperture.fill(columns, y, values),
            intensity,
            &mut scratch.transform,
            |_, _, value| scale * value.norm_sqr(),
        );
    }

    /// Returns the complex amplitude behind the undisplaced pupil in focus.
    pub fn field(&self) -> SpeckleField {
        self.speckle([0.0; 2], 0.0)
    }

    /// Returns the complex amplitude behind the pupil displaced by `offset` diameters and out of
    /// focus by `defocus`: the exact field, by one Fourier transform.
    ///
    /// The field is given in the pupil's own frame, with its band centred on zero frequency. To
    /// compare the fields of two displacements, use the frame of the lattice,
    /// `U(r) exp(−2πi c₀·r / Q)` with the lattice point c₀ nearest to `offset · C`.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::PupilField;
    ///
    /// let field = PupilField::new(256, 128, 3)?;
    /// let (a, b) = (field.speckle([0.0, 0.0], 0.0), field.speckle([0.0, 0.0], 0.5));
    /// let pairs = a.values().values().iter().zip(b.values().values());
    /// let mean = pairs.map(|(a, b)| a * b.conj()).sum::<tem00_speckle::Complex<f32>>() / 65_536.0;
    ///
    /// // Half-way to the first zero of the defocus γ is (2/π)² = 0.405.
    /// assert!((mean.norm_sqr() - 0.405).abs() < 5e-3);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn speckle(&self, offset: [f64; 2], defocus: f64) -> SpeckleField {
        let mut values = Grid::filled(self.size()[0], self.size()[1], ZERO);
        self.speckle_into(offset, defocus, &mut values, &mut SpeckleScratch::default());
        SpeckleField::new(values, self.speckle_size())
    }

    /// Writes the amplitude of [`speckle`](Self::speckle) into an existing grid, with existing
    /// working memory.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite and `amplitude` has the size of the pattern.
    pub fn speckle_into(
        &self,
        offset: [f64; 2],
        defocus: f64,
        amplitude: &mut Grid<Complex<f32>>,
        scratch: &mut SpeckleScratch,
    ) {
        self.amplitude_into(&self.aperture(offset, defocus), amplitude, scratch);
    }

    /// The amplitude, centred on zero frequency.
    pub(crate) fn amplitude_into(
        &self,
        aperture: &Aperture<'_>,
        amplitude: &mut Grid<Complex<f32>>,
        scratch: &mut SpeckleScratch,
    ) {
        // The normalisation is shared by the two axes.
        let scale = aperture.power().powf(-0.25);
        let [x, y] = [0, 1].map(|axis| self.centring_phase(aperture, axis, scale));
        self.transform.forward_from(
            |columns, y, values| aperture.fill(columns, y, values),
            amplitude,
            &mut scratch.transform,
            |i, j, value| value * x[i] * y[j],
        );
    }

    /// The field in the pupil about a lattice point, over the box of its mask. The squares of an
    /// external field sum to 1, or to 0 if the pupil contains no light.
    pub(crate) fn seen(&self, centre: [i64; 2]) -> Grid<Complex<f32>> {
        let aperture = self.aperture_of_point(centre, None);
        let [width, height] = aperture.extent();
        let mut seen = Grid::filled(width, height, ZERO);
        seen.for_each_row_mut(|y, values| aperture.fill(0..width, y, values));
        seen
    }

    /// scale · exp(−2πi corner x / Q): moves the pupil's centre from its position in the aperture
    /// to zero frequency.
    fn centring_phase(
        &self,
        aperture: &Aperture<'_>,
        axis: usize,
        scale: f64,
    ) -> Vec<Complex<f32>> {
        let size = to_signed(self.size()[axis]);
        let corner = aperture.corner()[axis];
        (0..size)
            .map(|x| {
                let turns = (-corner * x).rem_euclid(size) as f64 / size as f64;
                to_c32(Complex::from_polar(scale, 2.0 * PI * turns))
            })
            .collect()
    }

    /// The value at a lattice point.
    #[cfg(test)]
    pub(crate) fn phasor(&self, k: [i64; 2]) -> Complex<f32> {
        let mut value = [ZERO];
        self.lattice.fill_row(k, &mut value);
        value[0]
    }
}

#[cfg(test)]
mod tests;
