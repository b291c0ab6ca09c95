//! Patterns and fields behind a pupil that stands anywhere and is out of focus.

use core::{
    f64::consts::{PI, TAU},
    ops::Range,
};
use std::borrow::Cow;

use num_complex::Complex;
use tem00_numerics::{
    Fft2Scratch, Grid,
    cast::{to_c32, to_c64, to_f32, to_i64, to_signed},
};

use crate::{
    PupilField, SpeckleField, SpecklePattern,
    pupil::{
        lattice::{Lattice, Source},
        mask::{Mask, Span},
    },
};

const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// Working memory of [`PupilField::pattern_into`] and [`PupilField::speckle_into`], kept between
/// calls.
///
/// It fits any field and grows to the largest.
#[derive(Clone, Debug, Default)]
pub struct SpeckleScratch {
    transform: Fft2Scratch,
}

/// A pupil that stands somewhere on the lattice.
pub(crate) struct View<'a> {
    /// The lattice point nearest to the pupil's centre.
    centre: [i64; 2],
    /// The way from there to the pupil's centre, in lattice points.
    fraction: [f64; 2],
    mask: Cow<'a, Mask>,
    defocus: f64,
}

/// Values that a pupil selects from the lattice, over the box of its mask.
struct Selection<'a> {
    lattice: &'a Lattice,
    view: &'a View<'a>,
    factors: Option<Separable>,
    /// Of external samples: the factor that makes the sum of their squares 1.
    gain: Option<f64>,
}

/// A factor for each column and each row of the aperture.
type Separable = [Vec<Complex<f32>>; 2];

impl PupilField {
    /// Returns the intensity behind the undisplaced pupil in focus.
    pub fn pattern(&self) -> SpecklePattern {
        self.pattern_at([0.0; 2], 0.0)
    }

    /// Returns the intensity behind the pupil displaced by `offset` diameters and out of focus by
    /// `defocus`, as the type [defines](Self#defocus) it.
    ///
    /// Any displacement is exact, on a lattice point or between: the pupil selects its points anew,
    /// and the sum over their squares normalises the pattern.
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

    /// Like [`pattern_at`](Self::pattern_at), into a grid and with working memory that already
    /// exist.
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
        let view = self.view(offset, defocus);
        let scale = to_f32(1.0 / self.power(&view));
        let selection = self.selection(&view, None);
        self.transform.forward_from(
            |columns, y, values| selection.fill(columns, y, values),
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
    /// It is seen in the pupil's own frame, its band about zero frequency. The fields of two
    /// displacements are compared in the frame of the lattice, `U(r) exp(−2πi c₀·r / Q)` with the
    /// lattice point c₀ nearest to `offset · C`.
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

    /// Like [`speckle`](Self::speckle), into a grid and with working memory that already exist.
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
        let view = self.view(offset, defocus);
        self.amplitude_into(&view, None, amplitude, scratch);
    }

    /// The amplitude, centred on zero frequency; `filter` weighs the pupil points of each axis.
    pub(crate) fn amplitude_into(
        &self,
        view: &View<'_>,
        filter: Option<&[Vec<f32>; 2]>,
        amplitude: &mut Grid<Complex<f32>>,
        scratch: &mut SpeckleScratch,
    ) {
        // The normalisation is shared by the two axes.
        let scale = self.power(view).powf(-0.25);
        let [x, y] = [0, 1].map(|axis| self.centring_phase(view, axis, scale));
        let selection = self.selection(view, filter);
        self.transform.forward_from(
            |columns, y, values| selection.fill(columns, y, values),
            amplitude,
            &mut scratch.transform,
            |i, j, value| value * x[i] * y[j],
        );
    }

    /// The pupil displaced by `offset` diameters.
    pub(crate) fn view(&self, offset: [f64; 2], defocus: f64) -> View<'_> {
        assert!(
            offset.iter().all(|x| x.is_finite()) && defocus.is_finite(),
            "the offset {offset:?} or the defocus {defocus} is not finite"
        );
        let position = |axis: usize| lattice_point(offset[axis], self.diameter()[axis]);
        let [(x, fx), (y, fy)] = [position(0), position(1)];
        let on_lattice = fx.abs() + fy.abs() <= 0.0;
        View {
            centre: [x, y],
            fraction: [fx, fy],
            mask: match on_lattice {
                true => Cow::Borrowed(&self.mask),
                false => Cow::Owned(Mask::new(self.pupil(), self.diameter(), [fx, fy])),
            },
            defocus,
        }
    }

    /// The pupil about a lattice point, in focus.
    pub(crate) fn view_of_point(&self, centre: [i64; 2]) -> View<'_> {
        View {
            centre,
            fraction: [0.0; 2],
            mask: Cow::Borrowed(&self.mask),
            defocus: 0.0,
        }
    }

    /// The field in the pupil about a lattice point, over the box of its mask. The squares of an
    /// external field sum to 1, or to 0 where there is no light.
    pub(crate) fn seen(&self, centre: [i64; 2]) -> Grid<Complex<f32>> {
        let view = self.view_of_point(centre);
        let selection = self.selection(&view, None);
        let [width, height] = view.mask.extent();
        let mut seen = Grid::filled(width, height, ZERO);
        seen.for_each_row_mut(|y, values| selection.fill(0..width, y, values));
        seen
    }

    /// The expected sum of squares in the aperture. That of samples is made 1 as they are filled in.
    fn power(&self, view: &View<'_>) -> f64 {
        match self.lattice.source {
            Source::Seeded(_) => view.mask.power(),
            Source::Measured(_) => 1.0,
        }
    }

    /// The values in the pupil, its box at the corner of the transform's array.
    fn selection<'a>(
        &'a self,
        view: &'a View<'a>,
        filter: Option<&[Vec<f32>; 2]>,
    ) -> Selection<'a> {
        let mut selection = Selection {
            lattice: &self.lattice,
            view,
            factors: None,
            gain: None,
        };
        selection.gain = match self.lattice.source {
            Source::Seeded(_) => None,
            Source::Measured(_) => Some(selection.gain()),
        };
        selection.factors = self.factors(view, filter);
        selection
    }

    /// The factors of defocus and of `filter`, if there are any.
    fn factors(&self, view: &View<'_>, filter: Option<&[Vec<f32>; 2]>) -> Option<Separable> {
        if filter.is_none() && view.defocus.abs() <= 0.0 {
            return None;
        }
        Some([0, 1].map(|axis| {
            let mut lens = self.lens(view, axis);
            if let Some(filter) = filter {
                for (factor, weight) in lens.iter_mut().zip(&filter[axis]) {
                    *factor *= weight;
                }
            }
            lens
        }))
    }

    /// exp(2πi a (2p)²) along one axis.
    fn lens(&self, view: &View<'_>, axis: usize) -> Vec<Complex<f32>> {
        let corner = view.mask.corner()[axis] as f64 - view.fraction[axis];
        (0..view.mask.extent()[axis])
            .map(|i| {
                let rho = 2.0 * (corner + i as f64) / self.diameter()[axis];
                // Whole turns are taken off before 2π rounds what is left.
                to_c32(Complex::cis(TAU * (view.defocus * rho * rho % 1.0)))
            })
            .collect()
    }

    /// scale · exp(−2πi corner x / Q): moves the pupil's centre from its position in the aperture to
    /// zero frequency.
    fn centring_phase(&self, view: &View<'_>, axis: usize, scale: f64) -> Vec<Complex<f32>> {
        let size = to_signed(self.size()[axis]);
        let corner = view.mask.corner()[axis];
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

impl Selection<'_> {
    /// Fills in the values at these columns of row `y` of the mask's box.
    fn fill(&self, columns: Range<usize>, y: usize, values: &mut [Complex<f32>]) {
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

    /// The same without gain and factors.
    fn fill_points(&self, columns: Range<usize>, y: usize, values: &mut [Complex<f32>]) {
        let View { centre, mask, .. } = self.view;
        let row = mask.row(y);
        // Where a span lies among the columns.
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

    /// The factor that makes the sum of squares of external samples 1; 0 without any light.
    fn gain(&self) -> f64 {
        let [width, height] = self.view.mask.extent();
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

/// The lattice point nearest to `offset` diameters, and the way from there.
fn lattice_point(offset: f64, diameter: f64) -> (i64, f64) {
    // So many diameters are a number of rounds of the lattice, which the remainder takes off exactly.
    let position = offset % Lattice::SIDE as f64 * diameter;
    let point = position.round();
    let fraction = position - point;
    // Whole numbers over the diameter, times the diameter, are whole but for this rounding.
    let rounding = 2.0 * f64::EPSILON * position.abs();
    let on_lattice = fraction.abs() <= rounding;
    (to_i64(point), if on_lattice { 0.0 } else { fraction })
}

fn scaled(z: Complex<f32>, gain: f64) -> Complex<f32> {
    to_c32(to_c64(z) * gain)
}

#[cfg(test)]
mod tests;
