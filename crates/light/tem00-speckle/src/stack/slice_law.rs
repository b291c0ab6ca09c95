use core::array::from_fn;

use tem00_numerics::cast::to_f32;

use crate::{
    interpolation::covariance::{EVEN, SHAPES},
    stack::Slice,
};

/// Closed forms of a slice, for look-ups where no library can be called.
///
/// A kernel on a GPU, or of a renderer that compiles its own, interpolates the
/// [`coefficients`](crate::SpeckleStack::coefficients) of the slice i and of the next in one plane.
/// With the fraction f of the distance between the slices and the fractions `fx`, `fy` of the
/// distance between the samples, the intensity is
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
/// as in [`intensity_at`](crate::SpeckleStack::intensity_at). On a slice, where f is 0, it is
/// |`U_i`|² / `v_i`. x and y lie in one period, from 0 to the [size](crate::SpeckleStack::size).
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
/// // At a sample only the terms without p are left: near 1, and near the overlap of the two
/// // pupils.
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
    /// The turns of phase per sample, along x and y, from the frame of the next slice to the frame
    /// of this one.
    pub turns: [f64; 2],
}

impl SliceLaw {
    /// The number of [`rows`](Self::rows).
    pub const ROWS: usize = 14;

    pub(crate) fn of<C>(slice: &Slice<C>) -> Self {
        Self {
            mean_square: slice.mean_square,
            covariance: slice.join.covariance.table(),
            turns: slice.join.turns,
        }
    }

    /// Returns the law in rows of four numbers, as the functions of
    /// [`closed_form`](crate::closed_form) read it, for a stack of `size` samples.
    ///
    /// ```text
    /// 0 to 3     mean_square[ny]
    /// 4 to 9     covariance[ny], nx = 0 to 3
    /// 10 to 12   covariance[ny], nx = 4 and 5, of ny = 0 and 1, 2 and 3, 4 and 5
    /// 13         the step −turns · size in lattice points along x and y, 1 if a term with an odd
    ///            shape is not 0, 0
    /// ```
    pub fn rows(&self, size: [usize; 2]) -> [[f32; 4]; Self::ROWS] {
        let table = &self.covariance;
        let step = [0, 1].map(|axis| to_f32((-self.turns[axis] * size[axis] as f64).round()));
        let even = |ny: usize, nx: usize| ny < EVEN && nx < EVEN;
        let is_odd = (0..SHAPES * SHAPES)
            .map(|entry| (entry / SHAPES, entry % SHAPES))
            .any(|(ny, nx)| !even(ny, nx) && table[ny][nx].abs() > 0.0);
        from_fn(|row| match row {
            0..4 => self.mean_square[row],
            4..10 => from_fn(|nx| table[row - 4][nx]),
            10..13 => from_fn(|i| table[2 * (row - 10) + i / 2][EVEN + i % 2]),
            _ => [step[0], step[1], f32::from(u8::from(is_odd)), 0.0],
        })
    }
}

#[cfg(test)]
mod tests;
