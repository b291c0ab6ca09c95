//! Look-ups of many points in single precision, the format of renderers.

use crate::SpeckleStack;

/// Number of points that are widened together, small enough for the cache.
const POINTS: usize = 512;

impl SpeckleStack {
    /// Writes the intensities at many points into `intensity`: the results of
    /// [`intensity_at`](Self::intensity_at) at these coordinates, rounded.
    ///
    /// # Validity
    ///
    /// Rounding changes the intensity by 6e−8 of its value. Coordinates that are `f32` from the
    /// start are exact; a coordinate rounded to `f32` moves by up to 3e−8 of its distance from 0,
    /// half of 2.4e−4 samples beyond 2048. Whole periods can be subtracted beforehand without loss.
    ///
    /// # Panics
    ///
    /// Panics unless all slices have the same length.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
    ///
    /// let stack = SpeckleStack::generate(&PupilField::new(64, 16, 7)?, SlicePath::Still)?;
    ///
    /// let mut intensity = [0.0_f32; 2];
    /// stack.intensity_batch_f32(&[0.5, 1.5], &[2.0, 2.0], &[0.0, 0.0], &mut intensity);
    /// assert_eq!(intensity[1], stack.intensity_at(1.5, 2.0, 0.0) as f32);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn intensity_batch_f32(&self, x: &[f32], y: &[f32], u: &[f32], intensity: &mut [f32]) {
        widened([x, y, u], intensity, |[x, y, u], intensity| {
            self.intensity_batch(x, y, u, intensity);
        });
    }

    /// Writes the means over boxes of `size` samples about many points into `average`: the results
    /// of [`average_over`](Self::average_over) at these coordinates, rounded.
    ///
    /// # Panics
    ///
    /// Panics unless all slices have the same length and `size` is not negative.
    pub fn average_batch_f32(
        &self,
        [x, y]: [&[f32]; 2],
        size: [f64; 2],
        u: &[f32],
        average: &mut [f32],
    ) {
        widened([x, y, u], average, |[x, y, u], average| {
            for (i, average) in average.iter_mut().enumerate() {
                *average = self.average_over([x[i], y[i]], size, u[i]);
            }
        });
    }
}

/// Evaluates `f` in double precision and rounds the results.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn widened(coordinates: [&[f32]; 3], out: &mut [f32], mut f: impl FnMut([&[f64]; 3], &mut [f64])) {
    let lengths = coordinates.map(<[f32]>::len);
    assert!(
        lengths == [out.len(); 3],
        "coordinates of lengths {lengths:?} for {} results",
        out.len()
    );
    let mut wide = [[0.0; POINTS]; 3];
    let mut answers = [0.0; POINTS];
    for (block, out) in out.chunks_mut(POINTS).enumerate() {
        let places = block * POINTS..block * POINTS + out.len();
        for (wide, single) in wide.iter_mut().zip(coordinates) {
            for (wide, &single) in wide.iter_mut().zip(&single[places.clone()]) {
                *wide = f64::from(single);
            }
        }
        let answers = &mut answers[..out.len()];
        f(wide.each_ref().map(|wide| &wide[..out.len()]), answers);
        for (out, answer) in out.iter_mut().zip(answers) {
            *out = *answer as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{PupilField, SlicePath, SpeckleStack};

    #[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
    fn rounded(x: f64) -> f32 {
        x as f32
    }

    #[test]
    fn single_precision_rounds_the_answers_to_its_coordinates() {
        let path = SlicePath::Straight {
            half_period: 3,
            length: 2,
        };
        let field = PupilField::new(64, 16, 7).unwrap();
        let stack = SpeckleStack::generate(&field, path).unwrap();
        // More than one block, and a remainder.
        let along = |step: f32| (0..1100_u16).map(move |i| f32::from(i) * step - 40.0);
        let (x, y): (Vec<f32>, Vec<f32>) = along(0.37).zip(along(0.113)).unzip();
        let u: Vec<f32> = along(0.0171).collect();
        let mut intensity = vec![0.0; x.len()];
        stack.intensity_batch_f32(&x, &y, &u, &mut intensity);
        let mut average = vec![0.0; x.len()];
        stack.average_batch_f32([&x, &y], [2.0, 3.0], &u, &mut average);
        for i in 0..x.len() {
            let [x, y, u] = [x[i], y[i], u[i]].map(f64::from);
            let wide = [
                stack.intensity_at(x, y, u),
                stack.average_over([x, y], [2.0, 3.0], u),
            ];
            for (single, wide) in [intensity[i], average[i]].into_iter().zip(wide) {
                assert_eq!(single.to_bits(), rounded(wide).to_bits(), "{x}, {y}, {u}");
            }
        }
    }

    #[test]
    #[should_panic(expected = "coordinates of lengths [2, 1, 1] for 1 results")]
    fn slices_of_other_lengths_are_refused() {
        let field = PupilField::new(64, 16, 7).unwrap();
        let stack = SpeckleStack::generate(&field, SlicePath::Still).unwrap();
        stack.intensity_batch_f32(&[0.0, 1.0], &[0.0], &[0.0], &mut [0.0]);
    }
}
