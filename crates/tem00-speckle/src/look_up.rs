//! The look-up of a stack: at a point, at many, and as the mean over a box.

use num_complex::Complex;
use tem00_numerics::wrap_coordinate;

use crate::{
    Interpolation, SpeckleStack,
    lattice::unit_phasor,
    mask::to_f64,
    quadrature::{Node, mean_nodes},
    spline::{Along, Axis, Variance, amplitude},
    stack::{Join, Slice},
};

/// The slices on either side of a coordinate u.
#[derive(Clone, Copy)]
struct Between<'a> {
    here: Side<'a>,
    /// The next slice and the fraction of the way to it, unless u lies on a slice.
    next: Option<(Side<'a>, f64)>,
    /// Whether both sides have the same variance.
    alike: bool,
}

#[derive(Clone, Copy)]
struct Side<'a> {
    slice: &'a Slice,
    variance: &'a Variance,
}

impl SpeckleStack {
    /// Returns the intensity, with mean 1, at (x, y) in samples and u in slices.
    ///
    /// # Panics
    ///
    /// Panics unless `x`, `y` and `u` are finite.
    pub fn intensity_at(&self, x: f64, y: f64, u: f64) -> f64 {
        match self.interpolation {
            Interpolation::CubicSpline => self.intensity::<4>(x, y, u),
            Interpolation::Bilinear => self.intensity::<2>(x, y, u),
            Interpolation::Nearest => self.intensity::<1>(x, y, u),
        }
    }

    /// Writes the intensities at many points into `intensity`, the same bits as
    /// [`intensity_at`](Self::intensity_at) one by one.
    ///
    /// Points that lie close to each other, one after the other, are looked up fastest.
    ///
    /// # Panics
    ///
    /// Panics unless all slices have the same length and all coordinates are finite.
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
        match self.interpolation {
            Interpolation::CubicSpline => self.batch::<4>([x, y, u], intensity),
            Interpolation::Bilinear => self.batch::<2>([x, y, u], intensity),
            Interpolation::Nearest => self.batch::<1>([x, y, u], intensity),
        }
    }

    /// Returns the mean of the intensity over a box of `size` samples about `centre`, at u: what a
    /// pixel sees whose whole area takes part.
    ///
    /// For renderers that multiply speckle onto a finished image, and for pixels that are not much
    /// smaller than a speckle: looked up at its centre, such a pixel would show too much contrast.
    ///
    /// The mean is a sum over 5 × 5 points of Gauss and Legendre for each speckle of the box, and over
    /// at most one period of the pattern along each axis, however large the box. It errs by less than
    /// 4e−5 of the amplitude of the finest fringes, those at the intensity's cut-off, and by far less of
    /// all others. Bilinear amplitudes have kinks and nearest samples jumps, which such a sum meets by
    /// chance.
    ///
    /// # Panics
    ///
    /// Panics unless `centre`, `size` and `u` are finite and `size` is not negative.
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
            centre.iter().all(|c| c.is_finite()) && size.iter().all(|s| s.is_finite() && *s >= 0.0),
            "a box of the size {size:?} about {centre:?}"
        );
        let between = self.between(u);
        let nodes = [0, 1].map(|axis| {
            let period = to_f64(self.size()[axis]);
            let finest = between.finest(axis, period, self.speckle_size());
            mean_nodes(centre[axis], size[axis], period, finest)
        });
        match self.interpolation {
            Interpolation::CubicSpline => self.weighted::<4>(&nodes, &between),
            Interpolation::Bilinear => self.weighted::<2>(&nodes, &between),
            Interpolation::Nearest => self.weighted::<1>(&nodes, &between),
        }
    }

    #[inline]
    fn intensity<const N: usize>(&self, x: f64, y: f64, u: f64) -> f64
    where
        Axis<N>: Along,
    {
        let [width, height] = self.size();
        let (x, y) = (Axis::along(x, width), Axis::along(y, height));
        self.between(u).intensity(&x, &y, self.size())
    }

    fn batch<const N: usize>(&self, [x, y, u]: [&[f64]; 3], intensity: &mut [f64])
    where
        Axis<N>: Along,
    {
        let points = x.iter().zip(y).zip(u);
        for (intensity, ((&x, &y), &u)) in intensity.iter_mut().zip(points) {
            *intensity = self.intensity::<N>(x, y, u);
        }
    }

    /// Σ over the nodes of both axes of weight · intensity.
    fn weighted<const N: usize>(
        &self,
        [columns, rows]: &[Vec<Node>; 2],
        between: &Between<'_>,
    ) -> f64
    where
        Axis<N>: Along,
    {
        let [width, height] = self.size();
        let columns: Vec<(Axis<N>, f64)> = columns
            .iter()
            .map(|node| (Axis::along(node.place, width), node.weight))
            .collect();
        let along = |y: &Axis<N>| -> f64 {
            let terms = columns.iter();
            terms
                .map(|(x, weight)| weight * between.intensity(x, y, self.size()))
                .sum()
        };
        rows.iter()
            .map(|node| node.weight * along(&Axis::along(node.place, height)))
            .sum()
    }

    #[inline]
    fn between(&self, u: f64) -> Between<'_> {
        let count = self.slices.len();
        let (index, fraction) = wrap_coordinate(u, count);
        let on_a_slice = fraction <= 0.0 || count == 1;
        Between {
            here: self.side(index),
            next: (!on_a_slice).then(|| (self.side((index + 1) % count), fraction)),
            alike: self.variances.len() == 1,
        }
    }

    #[inline]
    fn side(&self, index: usize) -> Side<'_> {
        Side {
            slice: &self.slices[index],
            variance: self.variances.get(index).unwrap_or(&self.variances[0]),
        }
    }
}

impl Between<'_> {
    /// The period of the finest fringes along an axis. Between two slices these are finer than a
    /// speckle: the pupils together are wider than one.
    fn finest(&self, axis: usize, period: f64, speckle_size: f64) -> f64 {
        let step = self.next.map_or(0.0, |_| self.here.slice.join.step[axis]);
        period / (period / speckle_size + step.abs())
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "amplitudes are f32")]
    fn intensity<const N: usize>(&self, x: &Axis<N>, y: &Axis<N>, size: [usize; 2]) -> f64 {
        let variance = self.here.variance.at(x, y);
        let here = self.here.amplitude(x, y);
        let Some((next, f)) = self.next else {
            return f64::from(here.norm_sqr() / variance);
        };
        let join = &self.here.slice.join;
        let mut other = next.amplitude(x, y) * join.phase_to_next([x.place, y.place], size);
        if !self.alike {
            other *= (variance / next.variance.at(x, y)).sqrt();
        }
        let blend = here * (1.0 - f) as f32 + other * f as f32;
        f64::from(blend.norm_sqr()) / join.variance(f) / f64::from(variance)
    }
}

impl Side<'_> {
    #[inline]
    fn amplitude<const N: usize>(&self, x: &Axis<N>, y: &Axis<N>) -> Complex<f32> {
        amplitude(&self.slice.coefficients, x, y)
    }
}

impl Join {
    /// exp(−2πi step·r / Q): from the next slice's own frame to this one's, at r in one period.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a fraction of a turn in units of 2⁻³²"
    )]
    fn phase_to_next(&self, [x, y]: [f64; 2], size: [usize; 2]) -> Complex<f32> {
        // Steps are whole numbers, so that whole periods of x and y only add whole turns.
        let turns = -(self.step[0] * x / to_f64(size[0]) + self.step[1] * y / to_f64(size[1]));
        unit_phasor(((turns - turns.floor()) * 4_294_967_296.0) as u32)
    }

    /// The mean square of the blend of two amplitudes of mean square 1.
    #[inline]
    fn variance(&self, f: f64) -> f64 {
        let g = 1.0 - f;
        g * g + f * f + 2.0 * f * g * self.overlap
    }
}

#[cfg(test)]
mod tests;
