//! Slices of a stack, and their joins to the next slice.

use num_complex::Complex;
use tem00_numerics::{Grid, cast::to_c64, cast::to_signed, parallel};

use crate::{
    PupilField, SlicePath,
    interpolation::{
        covariance::{Covariance, Even, Responses, mean_square},
        spline::Variance,
    },
};

/// The interpolation coefficients of one slice, and its join to the next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slice<C = Grid<Complex<f32>>> {
    pub(crate) coefficients: C,
    pub(crate) centre: [i64; 2],
    /// The mean square of the interpolated amplitude.
    pub(crate) mean_square: Even,
    pub(crate) join: Join,
}

/// The join of one slice to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Join {
    /// Displacement of the next slice's pupil.
    pub(crate) step: [f64; 2],
    /// Turns of phase per sample, from the next slice's own frame to this one's: −step / Q.
    pub(crate) turns: [f64; 2],
    /// Overlap of both pupils.
    pub(crate) overlap: f64,
    /// The covariance of the interpolated amplitudes: the overlap, modified by the interpolation.
    pub(crate) covariance: Covariance,
}

/// Data that the slices of one stack share.
struct Joiner<'a> {
    field: &'a PupilField,
    responses: Responses,
    /// The variance of all slices of random phasors.
    expected: Variance,
}

/// Joins the coefficients of the slices of `field`, and returns the variances: one for all slices
/// with random phasors, one for each slice of an external field.
pub(super) fn join_all<C: Send>(
    field: &PupilField,
    path: SlicePath,
    coefficients: Vec<C>,
) -> (Vec<Slice<C>>, Vec<Variance>) {
    let count = coefficients.len();
    let joiner = Joiner {
        field,
        responses: Responses::new(field),
        expected: Variance::expected(field),
    };
    let centre = |index: usize| path.centre(to_signed(index % count), field);
    let joined = parallel::map_items_with(coefficients, |(), index, coefficients| {
        let (centre, next) = (centre(index), centre(index + 1));
        let (join, variance) = joiner.join(centre, next);
        let slice = Slice {
            coefficients,
            centre,
            mean_square: mean_square(&variance),
            join,
        };
        (slice, variance)
    });
    let (slices, mut variances): (Vec<_>, Vec<_>) = joined.into_iter().unzip();
    if field.samples().is_none() {
        variances.truncate(1);
    }
    (slices, variances)
}

impl Joiner<'_> {
    /// The join from the slice of the pupil at `centre` to the slice at `next`, and the variance of
    /// the first.
    fn join(&self, centre: [i64; 2], next: [i64; 2]) -> (Join, Variance) {
        let shift = self.field.shift(centre, next);
        if self.field.samples().is_none() {
            let overlap = self.field.overlap(shift).re;
            let covariance = self.responses.of_phasors(self.field, shift);
            return (self.with(shift, overlap, covariance), self.expected);
        }
        let (here, next) = (self.field.seen(centre), self.field.seen(next));
        let overlap = shared(&here, &next, shift);
        let covariance = self.responses.of_light(&here, &next, shift);
        let variance = Variance::of_light(&here, self.field);
        (self.with(shift, overlap, covariance), variance)
    }

    fn with(&self, shift: [i64; 2], overlap: f64, covariance: Covariance) -> Join {
        let step = shift.map(|n| n as f64);
        let size = self.field.size();
        Join {
            step,
            turns: [0, 1].map(|axis| -step[axis] / size[axis] as f64),
            overlap,
            covariance,
        }
    }
}

/// Re Σ a(k) b*(k − shift).
fn shared(a: &Grid<Complex<f32>>, b: &Grid<Complex<f32>>, [dx, dy]: [i64; 2]) -> f64 {
    let (width, height) = (to_signed(a.width()), to_signed(a.height()));
    let both = |shift: i64, size: i64| shift.clamp(0, size)..(size + shift).clamp(0, size);
    let at = |grid: &Grid<_>, x, y| to_c64(*grid.wrapped(x, y));
    both(dy, height)
        .flat_map(|y| both(dx, width).map(move |x| (x, y)))
        .map(|(x, y)| (at(a, x, y) * at(b, x - dx, y - dy).conj()).re)
        .sum()
}
