//! The values that a pupil selects from the lattice: the input of a pattern's transform.

use core::{f64::consts::TAU, ops::Range};
use std::borrow::Cow;

use num_complex::Complex;
use tem00_numerics::{
    Grid,
    cast::{to_c32, to_c64, to_i64, to_signed},
};

use crate::{
    PupilField,
    pupil::{
        lattice::{Lattice, Source},
        mask::{Mask, Span},
    },
};

const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// The field in a pupil at any position on the lattice, over the bounding box of its points, for
/// the caller's own Fourier transform, as on a graphics card.
///
/// The value at column i and row j of the box is
///
/// ```text
/// A(i, j) = t(i, j) P(start + (i, j)) factors[0][i] factors[1][j]
///           inside the spans of row j, else 0
/// ```
///
/// with the [`transmission`](Self::transmission) t, or 1, and the phasor P of word kx of the
/// `ChaCha8` stream ky, where (kx, ky) is the representative nearest to the origin on a lattice
/// that closes after [`period`](Self::period), displaced by the [`origin`](PupilField::origin) of
/// the field. With its box at the corner of an array of W × H zeros the aperture transforms to the
/// pattern and, centred on zero frequency, to the amplitude:
///
/// ```text
/// I(x, y) = |F(x, y)|² / power          F = Σ A(i, j) exp(−2πi (i x / W + j y / H))
/// U(x, y) = F(x, y) exp(−2πi (corner[0] x / W + corner[1] y / H)) / √power
/// ```
///
/// # Examples
///
/// ```
/// use tem00_speckle::{Complex, PupilField};
///
/// let field = PupilField::new(32, 8, 1)?;
/// let aperture = field.aperture([0.0; 2], 0.0);
/// let [columns, rows] = aperture.extent();
///
/// // The sample at the origin is the sum of all values.
/// let mut sum = Complex::new(0.0, 0.0);
/// let mut row = vec![sum; columns];
/// for y in 0..rows {
///     aperture.fill(0..columns, y, &mut row);
///     sum += row.iter().sum::<Complex<f32>>();
/// }
/// let intensity = f64::from(sum.norm_sqr()) / aperture.power();
/// assert!((intensity - f64::from(field.pattern().values()[(0, 0)])).abs() < 1e-5);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Aperture<'a> {
    lattice: &'a Lattice,
    mask: Cow<'a, Mask>,
    /// The lattice point nearest to the pupil's centre.
    centre: [i64; 2],
    factors: Option<Factors>,
    /// Factor that normalises the sum of squares of external samples to 1.
    gain: Option<f64>,
}

/// A factor for each column and each row of the aperture.
type Factors = [Vec<Complex<f32>>; 2];

impl PupilField {
    /// Returns the values in the pupil displaced by `offset` diameters and out of focus by
    /// `defocus`.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    pub fn aperture(&self, offset: [f64; 2], defocus: f64) -> Aperture<'_> {
        assert!(
            offset.iter().all(|x| x.is_finite()) && defocus.is_finite(),
            "the offset {offset:?} or the defocus {defocus} is not finite"
        );
        let position = |axis: usize| lattice_point(offset[axis], self.diameter()[axis]);
        let [(x, fx), (y, fy)] = [position(0), position(1)];
        let on_lattice = fx.abs() + fy.abs() <= 0.0;
        let mask = match on_lattice {
            true => Cow::Borrowed(&self.mask),
            false => Cow::Owned(Mask::new(self.pupil(), self.diameter(), [fx, fy])),
        };
        let factors = (defocus.abs() > 0.0)
            .then(|| [0, 1].map(|axis| self.lens(&mask, axis, [fx, fy][axis], defocus)));
        Aperture::new(self, mask, [x, y], factors)
    }

    /// The pupil about a lattice point, in focus; `filter` weighs the pupil points of each axis.
    pub(crate) fn aperture_of_point(
        &self,
        centre: [i64; 2],
        filter: Option<&[Vec<f32>; 2]>,
    ) -> Aperture<'_> {
        let complex = |weights: &Vec<f32>| weights.iter().map(|w| Complex::from(*w)).collect();
        let factors = filter.map(|filter| filter.each_ref().map(complex));
        Aperture::new(self, Cow::Borrowed(&self.mask), centre, factors)
    }

    /// exp(2πi a (2p)²) along one axis, for a centre at `fraction`.
    fn lens(&self, mask: &Mask, axis: usize, fraction: f64, defocus: f64) -> Vec<Complex<f32>> {
        let corner = mask.corner()[axis] as f64 - fraction;
        (0..mask.extent()[axis])
            .map(|i| {
                let rho = 2.0 * (corner + i as f64) / self.diameter()[axis];
                // Whole turns are removed before the multiplication by 2π rounds the rest.
                to_c32(Complex::cis(TAU * (defocus * rho * rho % 1.0)))
            })
            .collect()
    }
}

impl<'a> Aperture<'a> {
    fn new(
        field: &'a PupilField,
        mask: Cow<'a, Mask>,
        centre: [i64; 2],
        factors: Option<Factors>,
    ) -> Self {
        let mut aperture = Self {
            lattice: &field.lattice,
            mask,
            centre,
            factors,
            gain: None,
        };
        aperture.gain = match field.lattice.source {
            Source::Seeded(_) => None,
            Source::Measured(_) => Some(aperture.gain()),
        };
        aperture
    }

    /// Returns the number of columns and rows of the box.
    pub fn extent(&self) -> [usize; 2] {
        self.mask.extent()
    }

    /// Returns the first column and row of the box, counted from the lattice point nearest to the
    /// pupil's centre.
    pub fn corner(&self) -> [i64; 2] {
        self.mask.corner()
    }

    /// Returns the lattice point of the first column and row of the box.
    pub fn start(&self) -> [i64; 2] {
        let corner = self.mask.corner();
        self.lattice
            .nearest([0, 1].map(|axis| self.centre[axis] + corner[axis]))
    }

    /// Returns the number of points along each axis after which the lattice closes, at most 2³².
    pub const fn period(&self) -> [i64; 2] {
        self.lattice.period
    }

    /// Returns the outer span of the columns of row `y` of the box that belong to the pupil, and
    /// the span of the hole within it.
    ///
    /// # Panics
    ///
    /// Panics unless the box has the row.
    pub fn spans(&self, y: usize) -> [Range<usize>; 2] {
        let row = self.mask.row(y);
        [row.outer.range(), row.hole.range()]
    }

    /// Returns the transmission over the box, unless it is 1 in all spans.
    pub fn transmission(&self) -> Option<&Grid<Complex<f32>>> {
        self.mask.transmission()
    }

    /// Returns the factors of each column and of each row, from lens and prefilter, or `None` if
    /// all are 1.
    pub const fn factors(&self) -> Option<&[Vec<Complex<f32>>; 2]> {
        self.factors.as_ref()
    }

    /// Returns the expected sum of squares of the values, before the factors.
    pub fn power(&self) -> f64 {
        match self.gain {
            None => self.mask.power(),
            // Samples are normalised to a power of 1 as they are filled in.
            Some(_) => 1.0,
        }
    }

    /// Writes the values at these columns of row `y` of the box.
    ///
    /// # Panics
    ///
    /// Panics unless the box has the row and the columns, and `values` has as many elements as
    /// there are columns.
    pub fn fill(&self, columns: Range<usize>, y: usize, values: &mut [Complex<f32>]) {
        self.fill_points(columns.clone(), y, values);
        if let Some(gain) = self.gain {
            values
                .iter_mut()
                .for_each(|value| *value = scaled(*value, gain));
        }
        if let Some([by_column, by_row]) = &self.factors {
            for (value, factor) in values.iter_mut().zip(&by_column[columns]) {
                *value *= factor * by_row[y];
            }
        }
    }

    /// Fills points without gain and factors.
    fn fill_points(&self, columns: Range<usize>, y: usize, values: &mut [Complex<f32>]) {
        let Self { centre, mask, .. } = self;
        let row = mask.row(y);
        // Position of a span among the columns.
        let part = |span: Span| {
            let column = |x: usize| x.clamp(columns.start, columns.end) - columns.start;
            column(span.start)..column(span.end)
        };
        let inside = part(row.outer);
        values[..inside.start].fill(ZERO);
        values[inside.end..].fill(ZERO);
        let kx = centre[0] + mask.corner()[0] + to_signed(columns.start + inside.start);
        let ky = centre[1] + mask.corner()[1] + to_signed(y);
        self.lattice.fill_row([kx, ky], &mut values[inside]);
        values[part(row.hole)].fill(ZERO);
        if let Some(weights) = mask.weights(y) {
            for (value, weight) in values.iter_mut().zip(&weights[columns]) {
                *value *= weight;
            }
        }
    }

    /// The factor that normalises the sum of squares of external samples to 1; 0 without light.
    fn gain(&self) -> f64 {
        let [width, height] = self.extent();
        let mut row = vec![ZERO; width];
        let mut power = 0.0;
        for y in 0..height {
            self.fill_points(0..width, y, &mut row);
            let square = |z: &Complex<f32>| f64::from(z.re).powi(2) + f64::from(z.im).powi(2);
            power += row.iter().map(square).sum::<f64>();
        }
        if power > 0.0 {
            power.sqrt().recip()
        } else {
            0.0
        }
    }
}

/// The lattice point nearest to `offset` diameters, and the remaining distance.
fn lattice_point(offset: f64, diameter: f64) -> (i64, f64) {
    // `SIDE` diameters are a whole number of rounds of the lattice, which the remainder removes
    // exactly.
    let position = offset % Lattice::SIDE as f64 * diameter;
    let point = position.round();
    let fraction = position - point;
    // An integer divided by the diameter and multiplied by it again is an integer up to this
    // rounding.
    let rounding = 2.0 * f64::EPSILON * position.abs();
    let on_lattice = fraction.abs() <= rounding;
    (to_i64(point), if on_lattice { 0.0 } else { fraction })
}

fn scaled(z: Complex<f32>, gain: f64) -> Complex<f32> {
    to_c32(to_c64(z) * gain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_of_whole_lattice_points_are_on_the_lattice() {
        for diameter in [49.0, 50.0, 64.0, 57.6, 333.25] {
            for point in (-3_000..3_000).chain([1 << 35, (1 << 35) + 1]) {
                let offset = point as f64 / diameter;
                assert_eq!(
                    lattice_point(offset, diameter),
                    (point, 0.0),
                    "C = {diameter}"
                );
            }
            let (point, fraction) = lattice_point(17.25 / diameter, diameter);
            assert!(
                point == 17 && (fraction - 0.25).abs() < 1e-14,
                "{point} + {fraction}"
            );
        }
    }
}
