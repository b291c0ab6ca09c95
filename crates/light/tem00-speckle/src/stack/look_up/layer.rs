//! Look-ups on a slice, or between two slices.

use crate::{
    SpeckleStack,
    interpolation::{
        covariance::even_at,
        taps::{Taps, amplitudes},
    },
    pupil::lattice::unit_phasor,
    stack::Slice,
};

/// A slice, or the blend of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer<'a> {
    here: &'a Slice,
    /// The next slice, unless u lies on a slice.
    next: Option<&'a Slice>,
}

/// Positions of coordinates u: the slice, whether u lies beyond it, and the fraction to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Positions<const L: usize> {
    pub(super) slices: [usize; L],
    pub(super) between: [bool; L],
    pub(super) fractions: [f32; L],
}

impl SpeckleStack {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
    pub(super) fn positions<const L: usize>(&self, u: &[f64; L]) -> Positions<L> {
        let (slices, f) = self.periods[2].split(u);
        let moves = self.slices.len() > 1;
        let (mut between, mut fractions) = ([false; L], [0.0; L]);
        for i in 0..L {
            between[i] = moves & (f[i] > 0.0);
            fractions[i] = f[i] as f32;
        }
        Positions {
            slices,
            between,
            fractions,
        }
    }

    /// The layer on a slice, or between it and the next.
    #[inline(always)]
    pub(super) fn layer(&self, slice: usize, between: bool) -> Layer<'_> {
        let next = self.periods[2].wrap(slice + 1);
        Layer {
            here: &self.slices[slice],
            next: between.then(|| &self.slices[next]),
        }
    }
}

impl Layer<'_> {
    /// The period of the finest fringes along an axis. Between two slices the fringes are finer
    /// than a speckle, since two pupils together are wider than one.
    pub(super) fn finest(&self, axis: usize, period: f64, speckle_size: f64) -> f64 {
        let step = self.next.map_or(0.0, |_| self.here.join.step[axis]);
        period / (period / speckle_size + step.abs())
    }

    /// The amplitudes, as real and imaginary parts, at points whose fractions of the way to the
    /// next slice are `f`, and their mean squares.
    #[inline(always)]
    pub(super) fn amplitudes<const L: usize>(
        &self,
        x: &Taps<L>,
        y: &Taps<L>,
        f: &[f32; L],
    ) -> ([[f32; L]; 2], [f32; L]) {
        let mut amplitude = amplitudes(&self.here.coefficients, x, y);
        let mut mean_square = even_at(&self.here.mean_square, &x.fractions, &y.fractions);
        if let Some(next) = self.next {
            self.blend(next, &mut amplitude, [x, y], f);
            mean_square = self.blended_square(next, &mean_square, [x, y], f);
        }
        (amplitude, mean_square)
    }

    /// The intensities at points whose fractions of the way to the next slice are `f`.
    #[inline(always)]
    pub(super) fn intensities<const L: usize>(
        &self,
        x: &Taps<L>,
        y: &Taps<L>,
        f: &[f32; L],
    ) -> [f64; L] {
        let (amplitude, mean_square) = self.amplitudes(x, y, f);
        let mut intensity = [0.0; L];
        for (i, intensity) in intensity.iter_mut().enumerate() {
            let [re, im] = [amplitude[0][i], amplitude[1][i]];
            *intensity = f64::from((re * re + im * im) / mean_square[i]);
        }
        intensity
    }

    /// (1 − f) U + f U' exp(2πi turns), in the frame of this slice.
    #[inline(always)]
    fn blend<const L: usize>(
        &self,
        next: &Slice,
        amplitude: &mut [[f32; L]; 2],
        [x, y]: [&Taps<L>; 2],
        f: &[f32; L],
    ) {
        let there = amplitudes(&next.coefficients, x, y);
        let turns = self.here.join.turns;
        let [re, im] = amplitude;
        for i in 0..L {
            let phase = phase(turns[0] * x.positions[i] + turns[1] * y.positions[i]);
            let phasor = unit_phasor(phase);
            let (own, other) = (1.0 - f[i], f[i]);
            let [a, b] = [there[0][i], there[1][i]];
            re[i] = own * re[i] + other * (a * phasor.re - b * phasor.im);
            im[i] = own * im[i] + other * (a * phasor.im + b * phasor.re);
        }
    }

    /// (1 − f)² v + f² v' + 2 f (1 − f) c.
    #[inline(always)]
    fn blended_square<const L: usize>(
        &self,
        next: &Slice,
        here: &[f32; L],
        [x, y]: [&Taps<L>; 2],
        f: &[f32; L],
    ) -> [f32; L] {
        let there = even_at(&next.mean_square, &x.fractions, &y.fractions);
        let both = self.here.join.covariance.at(&x.fractions, &y.fractions);
        let mut blended = [0.0; L];
        for (i, blended) in blended.iter_mut().enumerate() {
            let (own, other) = (1.0 - f[i], f[i]);
            *blended = own * own * here[i] + other * other * there[i] + 2.0 * own * other * both[i];
        }
        blended
    }
}

/// The fraction of a turn in units of 2⁻³², for less than 2¹⁹ turns.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the bits of complete turns are dropped on purpose"
)]
fn phase(turns: f64) -> u32 {
    // Between 2²⁰ and 2²¹ the last bit of a number is worth 2⁻³², so that the lower half of the
    // bits holds the fraction.
    const UNITS: f64 = 1.5 * (1_u64 << 20) as f64;
    (turns + UNITS).to_bits() as u32
}
