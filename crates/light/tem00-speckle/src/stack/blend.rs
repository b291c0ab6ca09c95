//! Blends of slices in a look-up, and the correlation of two of them.

use std::collections::BTreeMap;

use num_complex::Complex;
use tem00_numerics::cast::to_signed;

use crate::SpeckleStack;

/// The centre of a pupil relative to the first pupil of a blend, and its weight.
type Part = ([i64; 2], f64);

impl SpeckleStack {
    /// Returns the exact correlation γ of the intensities looked up at the samples at two
    /// coordinates u and v, on slices or between them, from the counted overlaps of their pupils.
    ///
    /// It is periodic in both coordinates with the period of the stack; for a still stack it is 1.
    /// For coordinates that are not finite it is 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
    ///
    /// let field = PupilField::new(256, 128, 7)?;
    /// let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 6 })?;
    ///
    /// // A slice from a slice, and half-way from half-way.
    /// assert!((stack.correlation_between(0.0, 1.0) - 0.455).abs() < 0.01);
    /// assert!((stack.correlation_between(0.5, 1.5) - 0.669).abs() < 0.01);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn correlation_between(&self, u: f64, v: f64) -> f64 {
        if !(u.is_finite() && v.is_finite()) {
            return 0.0;
        }
        let (u, v) = (self.blended_at(u), self.blended_at(v));
        let power = |blend: &[_]| self.covariances(blend, blend)[&[0; 2]].re;
        let shared: f64 = self
            .covariances(&u, &v)
            .values()
            .map(Complex::norm_sqr)
            .sum();
        // Rounding may end a unit above 1.
        (shared / (power(&u) * power(&v))).min(1.0)
    }

    /// The centres of the pupils that are blended at a coordinate, with their weights.
    fn blended_at(&self, u: f64) -> Vec<Part> {
        let [_, _, period] = &self.periods;
        let ([slice], [fraction]) = period.split(&[u]);
        let centre = self.slices[slice].centre;
        if fraction > 0.0 && self.slices.len() > 1 {
            let next = self.slices[period.wrap(slice + 1)].centre;
            let step = self.field.shift(centre, next);
            let next = [centre[0] + step[0], centre[1] + step[1]];
            vec![(centre, 1.0 - fraction), (next, fraction)]
        } else {
            vec![(centre, 1.0)]
        }
    }

    /// The covariances of the amplitudes of two blends. Where the lattice closes early, the pupils
    /// may overlap from both sides. The two overlaps are waves that average out over the tile
    /// unless they differ by periods of it.
    fn covariances(&self, a: &[Part], b: &[Part]) -> BTreeMap<[i64; 2], Complex<f64>> {
        let nearest = self.field.shift(a[0].0, b[0].0);
        let way = [0, 1].map(|axis| nearest[axis] - (b[0].0[axis] - a[0].0[axis]));
        let pairs = || a.iter().flat_map(|a| b.iter().map(move |b| (a, b)));
        let mut waves = BTreeMap::new();
        for side in self.field.sides() {
            let term = |((from, own), (to, other)): (&Part, &Part)| {
                let shift = [0, 1].map(|axis| to[axis] - from[axis] + way[axis] + side[axis]);
                self.field.overlap_on_one_side(shift) * (own * other)
            };
            let wave = [0, 1].map(|axis| side[axis].rem_euclid(to_signed(self.size()[axis])));
            *waves.entry(wave).or_default() += pairs().map(term).sum::<Complex<f64>>();
        }
        waves
    }
}
