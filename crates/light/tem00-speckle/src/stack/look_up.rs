//! Look-ups of a stack: at a point, at many points, and as the mean over a box.

use core::f64::consts::TAU;

use num_complex::Complex;
use tem00_numerics::{cast::to_i64, vectorised};

use crate::{
    SpeckleStack,
    interpolation::taps::Taps,
    stack::quadrature::{Node, mean_nodes},
};

mod layer;
mod single;

/// Points of a batch that are looked up together.
const LANES: usize = 16;

impl SpeckleStack {
    /// Returns the intensity, with mean 1, at (x, y) in samples and u in slices.
    ///
    /// For a coordinate that is not finite, as from a degenerate ray, the result is the mean
    /// intensity, 1, so that the light it multiplies does not change.
    #[inline(always)]
    pub fn intensity_at(&self, x: f64, y: f64, u: f64) -> f64 {
        if !is_place([x, y, u]) {
            return 1.0;
        }
        let positions = self.positions(&[u]);
        let layer = self.layer(positions.slices[0], positions.between[0]);
        let [along_x, along_y, _] = &self.periods;
        let (x, y) = (Taps::around(&[x], along_x), Taps::around(&[y], along_y));
        let [intensity] = layer.intensities(&x, &y, &positions.fractions);
        intensity
    }

    /// Returns the amplitude, of mean square 1, whose squared magnitude
    /// [`intensity_at`](Self::intensity_at) returns: for light whose fields add up.
    ///
    /// It is the field in the frame of the pupil of the slice at or before u. Stacks along one path
    /// share this frame, so that their amplitudes at one position can be added; amplitudes of other
    /// positions and slices can be added after [`ramp_at`](Self::ramp_at). The amplitude is 1 if a
    /// coordinate is not finite.
    pub fn amplitude_at(&self, x: f64, y: f64, u: f64) -> Complex<f64> {
        if !is_place([x, y, u]) {
            return Complex::new(1.0, 0.0);
        }
        let positions = self.positions(&[u]);
        let layer = self.layer(positions.slices[0], positions.between[0]);
        let [along_x, along_y, _] = &self.periods;
        let (x, y) = (Taps::around(&[x], along_x), Taps::around(&[y], along_y));
        let ([re, im], mean_square) = layer.amplitudes(&x, &y, &positions.fractions);
        Complex::new(f64::from(re[0]), f64::from(im[0])) / f64::from(mean_square[0]).sqrt()
    }

    /// Returns the phase, in radians, that transforms the [`amplitude_at`](Self::amplitude_at) a
    /// position into the frame of slice 0: `exp(−i ramp)` times the amplitude is continuous from
    /// slice to slice.
    ///
    /// ```text
    /// ramp = 2π (x c_x / Q_x + y c_y / Q_y)     c the lattice point about which the pupil of the
    ///                                           slice stands
    /// ```
    ///
    /// The phase is 0 if a coordinate is not finite.
    pub fn ramp_at(&self, x: f64, y: f64, u: f64) -> f64 {
        let centre = self.path().centre(to_i64(u.floor()), &self.field);
        let [width, height] = self.size().map(|samples| samples as f64);
        let turns = x * centre[0] as f64 / width + y * centre[1] as f64 / height;
        if turns.is_finite() { TAU * turns } else { 0.0 }
    }

    /// Writes the intensities at many points into `intensity`, with the same bits as from
    /// [`intensity_at`](Self::intensity_at) one by one.
    ///
    /// Consecutive points between the same two slices are looked up together; points that also lie
    /// close to each other are fastest. The feature `simd` uses the widest vector instructions of
    /// the processor, with the same bits.
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
    /// let field = PupilField::new(64, 16, 7)?;
    /// let stack = SpeckleStack::generate(&field, SlicePath::Still)?;
    ///
    /// let mut intensity = [0.0; 2];
    /// stack.intensity_batch(&[0.5, 1.5], &[2.0, 2.0], &[0.0, 0.0], &mut intensity);
    /// assert_eq!(intensity[1], stack.intensity_at(1.5, 2.0, 0.0));
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn intensity_batch(&self, x: &[f64], y: &[f64], u: &[f64], intensity: &mut [f64]) {
        let lengths = [x.len(), y.len(), u.len()];
        assert!(
            lengths == [intensity.len(); 3],
            "coordinates of lengths {lengths:?} for {} intensities",
            intensity.len()
        );
        self.batch([x, y, u], intensity);
    }

    /// Returns the mean of the intensity over a box of `size` samples about `centre`, at u: the
    /// value of a pixel with its full area.
    ///
    /// For renderers that multiply speckle onto a finished image, and for pixels that are not much
    /// smaller than a speckle: looked up at its centre, such a pixel would show too much contrast.
    ///
    /// The mean is a sum over 5 × 5 Gauss–Legendre points for each speckle of the box, and over at
    /// most one period of the pattern along each axis for a box of any size. Its error is below
    /// 4e−5 of the amplitude of the finest fringes, at the intensity's cut-off, and far smaller for
    /// all other fringes. The cubic spline leaves images of the finest fringes, with the relative
    /// amplitude (2s − 1)⁻⁴ for speckles of s samples, which such a sum samples at random. The mean
    /// is 1 if `centre`, `size` or `u` is not finite.
    ///
    /// # Panics
    ///
    /// Panics if `size` is negative.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
    ///
    /// let field = PupilField::new(64, 16, 7)?;
    /// let stack = SpeckleStack::generate(&field, SlicePath::Still)?;
    ///
    /// // All of the pattern, and a point of it.
    /// assert!((stack.average_over([3.0, 8.5], [64.0, 128.0], 0.0) - 1.0).abs() < 1e-4);
    /// let point = stack.average_over([3.0, 8.5], [0.0, 0.0], 0.0);
    /// assert!((point - stack.intensity_at(3.0, 8.5, 0.0)).abs() < 1e-6);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn average_over(&self, centre: [f64; 2], size: [f64; 2], u: f64) -> f64 {
        assert!(
            !size.iter().any(|side| *side < 0.0),
            "a box of the size {size:?} about {centre:?}"
        );
        if !(is_place([centre[0], centre[1], u]) && is_place([size[0], size[1], 0.0])) {
            return 1.0;
        }
        let positions = self.positions(&[u]);
        let layer = self.layer(positions.slices[0], positions.between[0]);
        let nodes = [0, 1].map(|axis| {
            let period = self.size()[axis] as f64;
            let finest = layer.finest(axis, period, self.speckle_size());
            mean_nodes(centre[axis], size[axis], period, finest)
        });
        self.weighted(&nodes, u)
    }

    fn batch(&self, [x, y, u]: [&[f64]; 3], intensity: &mut [f64]) {
        let (x, x_rest) = x.as_chunks();
        let (y, y_rest) = y.as_chunks();
        let (u, u_rest) = u.as_chunks();
        let (blocks, rest) = intensity.as_chunks_mut();
        vectorised(
            #[inline(always)]
            || {
                for (i, block) in blocks.iter_mut().enumerate() {
                    self.block([&x[i], &y[i], &u[i]], block);
                }
            },
        );
        self.one_by_one([x_rest, y_rest, u_rest], rest);
    }

    /// Points of one layer are looked up together.
    #[inline(always)]
    fn block(&self, [x, y, u]: [&[f64; LANES]; 3], intensity: &mut [f64; LANES]) {
        let positions = self.positions(u);
        let (slice, between) = (positions.slices[0], positions.between[0]);
        let alike = positions
            .slices
            .iter()
            .fold(true, |alike, s| alike & (*s == slice));
        let alike = positions
            .between
            .iter()
            .fold(alike, |alike, b| alike & (*b == between));
        let together = (0..LANES).fold(alike, |all, i| all & is_place([x[i], y[i], u[i]]));
        if !together {
            self.one_by_one([x, y, u], intensity);
            return;
        }
        let [along_x, along_y, _] = &self.periods;
        let (x, y) = (Taps::around(x, along_x), Taps::around(y, along_y));
        let layer = self.layer(slice, between);
        *intensity = layer.intensities(&x, &y, &positions.fractions);
    }

    fn one_by_one(&self, [x, y, u]: [&[f64]; 3], intensity: &mut [f64]) {
        let points = x.iter().zip(y).zip(u);
        for (intensity, ((&x, &y), &u)) in intensity.iter_mut().zip(points) {
            *intensity = self.intensity_at(x, y, u);
        }
    }

    /// Σ over the nodes of both axes of weight · intensity.
    fn weighted(&self, [columns, rows]: &[Vec<Node>; 2], u: f64) -> f64 {
        let positions = self.positions(&[u]);
        let layer = self.layer(positions.slices[0], positions.between[0]);
        let [along_x, along_y, _] = &self.periods;
        let columns: Vec<(Taps<1>, f64)> = columns
            .iter()
            .map(|node| (Taps::around(&[node.position], along_x), node.weight))
            .collect();
        let along = |y: &Taps<1>| -> f64 {
            let terms = columns.iter();
            terms
                .map(|(x, weight)| weight * layer.intensities(x, y, &positions.fractions)[0])
                .sum()
        };
        rows.iter()
            .map(|node| node.weight * along(&Taps::around(&[node.position], along_y)))
            .sum()
    }
}

/// Returns whether all coordinates are finite, without a branch, so that a loop fills vector units.
#[inline(always)]
fn is_place([x, y, u]: [f64; 3]) -> bool {
    (0.0 * x + 0.0 * y + 0.0 * u).is_finite()
}

#[cfg(test)]
mod tests;
