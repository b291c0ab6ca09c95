use crate::{
    SpeckleStack,
    interpolation::covariance::{EVEN, SHAPES},
};

/// The closed forms of a slice, for look-ups that run where no library can be called.
///
/// A kernel on a GPU, or of a renderer that compiles its own, interpolates the
/// [`coefficients`](SpeckleStack::coefficients) of the slice i and of the next in one plane. With the
/// fraction f of the way between them and the fractions `fx`, `fy` of the way between the samples, the
/// intensity is
///
/// ```text
/// U = (1 − f) U_i + f U_{i+1} exp(2πi (turns[0] x + turns[1] y))
/// I = |U|² / ((1 − f)² v_i + f² v_{i+1} + 2 f (1 − f) w_i)
///
/// v = Σ mean_square[ny][nx] s[ny](fy) s[nx](fx)
/// w = Σ covariance[ny][nx] s[ny](fy) s[nx](fx)
/// s(f) = 1, p, p², p³, o, o p          p = f (1 − f),  o = p (1 − 2 f)
/// ```
///
/// as [`intensity_at`](SpeckleStack::intensity_at) has it. On a slice, where f is 0, it is |`U_i`|² / `v_i`.
/// x and y lie in one period, from 0 to the [size](SpeckleStack::size). For the nearest sample
/// both are those of the sample, and `fx` and `fy` are 0.
///
/// # Examples
///
/// ```
/// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
///
/// let field = PupilField::new(64, 16, 7)?;
/// let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 4 })?;
/// let law = stack.slice_law(3);
///
/// // At a sample only the terms without p are left: near 1, and near the overlap of the two pupils.
/// let overlap = stack.correlation_between(3.0, 4.0).sqrt();
/// assert!((law.mean_square[0][0] - 1.0).abs() < 2e-3);
/// assert!((f64::from(law.covariance[0][0]) - overlap).abs() < 2e-3);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceLaw {
    /// The mean square v of the interpolated amplitude: coefficients `[ny][nx]` of the even shapes.
    pub mean_square: [[f32; EVEN]; EVEN],
    /// The covariance w with the next slice: coefficients `[ny][nx]` of all shapes.
    pub covariance: [[f32; SHAPES]; SHAPES],
    /// The turns of phase per sample, along x and y, from the frame of the next slice to that of this
    /// one.
    pub turns: [f64; 2],
}

impl SpeckleStack {
    /// Returns the closed forms of slice `index` and of its join to the next.
    ///
    /// # Panics
    ///
    /// Panics unless `index < slice_count`.
    pub fn slice_law(&self, index: usize) -> SliceLaw {
        let slice = &self.slices[index];
        SliceLaw {
            mean_square: slice.mean_square,
            covariance: slice.join.covariance.table(),
            turns: slice.join.turns,
        }
    }
}

#[cfg(test)]
mod tests;
