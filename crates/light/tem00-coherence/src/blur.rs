//! Overlap of a defocused pupil for two parts of the light.

use core::f64::consts::{FRAC_1_PI, PI};

use num_complex::Complex;
use tem00_numerics::disc_overlap;

use crate::{chebyshev::Grid, lens};

/// The mean phasor of the defocus over the lens-shaped overlap of two displaced pupils. Its phase
/// is `linear · s` along their displacement s, in diameters, and `bend · κ` at the edge for the
/// difference κ of two wave numbers.
#[derive(Debug)]
pub(crate) struct Blur {
    linear: f64,
    bend: f64,
    table: Option<Grid>,
}

/// Phases in radians beyond which the squared mean, at most the square of a jinc, is taken without
/// its oscillations.
const FAR: f64 = 60.0;

/// Phases in radians beyond which a mean is negligible.
const FARTHEST: f64 = 3e3;

impl Blur {
    /// Creates the blur of these phases, with a table if it `is_often` evaluated.
    pub(crate) fn new([linear, bend]: [f64; 2], is_often: bool) -> Self {
        let [linear, bend] = [linear, bend].map(f64::abs);
        Self {
            linear,
            bend,
            table: (is_often && linear > 0.0).then(|| Grid::new(shifts(linear), bends())),
        }
    }

    /// Returns the mean phasor.
    pub(crate) fn mean(&self, shift: f64, kappa: f64) -> Complex<f64> {
        let (linear, bend) = (self.linear * shift, self.bend * kappa);
        if linear == 0.0 && bend == 0.0 {
            return disc_overlap(shift).into();
        }
        let range = linear.abs() + bend.abs();
        if range > FARTHEST {
            return Complex::ZERO;
        }
        let along = |place: f64| (linear - bend * place) * place;
        let across = |chord: f64| lens::quadratic_across(bend, chord);
        lens::mean_over_lens(shift, range, along, across)
    }

    /// Returns the squared mean.
    pub(crate) fn squared(&self, shift: f64, kappa: f64) -> f64 {
        let shift = shift.abs();
        if self.linear == 0.0 || shift >= 1.0 {
            return disc_overlap(shift).powi(2);
        }
        let (phase, bend) = (self.linear * shift * (1.0 - shift), self.bend * kappa.abs());
        // All displacements beyond the first far one are far, too.
        if phase > FAR || bend > FAR || self.linear * (shift - 0.5) > 2.0 * FAR {
            return smooth(shift, phase, bend);
        }
        let squared = |shift: f64, bend: f64| self.mean(shift, bend / self.bend).norm_sqr();
        match &self.table {
            Some(table) => table.at([shift, bend], squared),
            None => squared(shift, bend),
        }
    }
}

/// Returns the squared mean of large phases without its oscillations. It is half of a jinc's
/// envelope or, where the phase is stationary within the lens, the contribution of the stationary
/// point and, without a displacement, of the edge.
fn smooth(shift: f64, phase: f64, bend: f64) -> f64 {
    if bend > FAR && phase < 2.0 * bend {
        let edge = if phase < 1.0 { 2.0 } else { 1.0 };
        return edge / (bend * bend);
    }
    disc_overlap(shift).powi(2) * 4.0 * FRAC_1_PI / phase.max(FAR).powi(3)
}

/// Breaks of displacements between which the phase changes by 2, up to the first far displacement.
fn shifts(linear: f64) -> Vec<f64> {
    let root = (0.25 - FAR / linear).max(0.0).sqrt();
    let end = if root > 0.0 { 0.5 - root } else { 1.0 };
    let panels = (0.5 * linear * end).max(4.0).ceil();
    let breaks = core::iter::successors(Some(0.0), |i| Some(i + 1.0));
    let breaks = breaks
        .take_while(|i| *i <= panels)
        .map(|i| i / panels * end);
    breaks.collect()
}

fn bends() -> Vec<f64> {
    let even = core::iter::successors(Some(PI), |bend| Some(bend + PI));
    let even = even.take_while(|bend| *bend < FAR + PI);
    [0.0, 0.25 * PI].into_iter().chain(even).collect()
}

#[cfg(test)]
mod tests {
    use tem00_numerics::jinc;

    use tem00_testkit::assert_absolute;

    use super::*;

    #[test]
    fn squares_are_those_of_means_and_far_away_without_their_oscillations() {
        for [linear, bend] in [[3.0, 1e-4], [90.0, 1e-3], [400.0, 1e-3], [1e7, 1e-2]] {
            let [table, exact] = [true, false].map(|often| Blur::new([linear, bend], often));
            for shift in [0.0, 0.01, 0.2, 0.5, 0.77, 0.99, 1.0, 1.3] {
                for kappa in [0.0, 30.0, 2e3, -9e3, 5e4] {
                    let [found, expected] = [&table, &exact].map(|blur| blur.squared(shift, kappa));
                    assert_absolute(found, expected, 1e-6);
                    let bound = jinc(FAR).powi(2).max(8.0 / FAR.powi(2));
                    let mean = exact.mean(shift, kappa).norm_sqr();
                    assert_absolute(found, mean, bound);
                }
            }
        }
        // The sums run over some periods of a defocused pupil.
        let blur = Blur::new([1e4, 1e-9], false);
        let places = || (0..400).map(|i| 0.0065 + 1e-6 * f64::from(i) * PI);
        let sum: f64 = places().map(|shift| blur.mean(shift, 0.0).norm_sqr()).sum();
        let far: f64 = places().map(|shift| blur.squared(shift, 0.0)).sum();
        assert!((far / sum - 1.0).abs() < 0.05, "{far} {sum}");
    }

    #[test]
    fn tables_are_bounded() {
        for linear in [1e-300, 1.0, 100.0, 239.9, 240.1, 1e9, f64::MAX] {
            let cells = shifts(linear).len() * bends().len();
            assert!(cells < 4_000, "{linear:e}: {cells}");
        }
    }
}
