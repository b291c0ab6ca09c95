//! A table of the excess, whose size does not grow with the relief.

use core::f64::consts::TAU;

use tem00_numerics::quadrature::for_each_node;

use super::{STEEP, is_beyond};
use crate::{
    chebyshev::{Grid, SIDE, at_place, node},
    kernel::LagKernel,
};

/// The excess over phases and displacements.
#[derive(Clone, Debug)]
pub(super) struct Table {
    grid: Grid,
    /// Values at the nodes of the displacement panels, then at the nodes of the phase panels.
    values: Vec<Vec<f64>>,
}

/// The longest correlation length in speckles over which lags are summed. For a longer one the loss
/// is of first order in its reciprocal: it acts as this length does with phases of equal loss.
const LONGEST: f64 = 32.0;

/// Correlation lengths in speckles beyond which the loss is negligible.
const ENDLESS: f64 = 1e6;

/// The width of the excess, in speckles, below which it is neglected: a fraction of 2e−8 remains.
const NARROWEST: f64 = 1e-4;

/// The excess of one phase, over lags.
struct Row {
    /// The width in speckles.
    width: f64,
    of_lags: Vec<f64>,
    /// Correlation for uncorrelated heights, and its part in the sum over lags.
    dense: f64,
}

impl Table {
    pub(super) fn new(kernel: LagKernel, length: f64) -> Self {
        let length = length.min(ENDLESS);
        let longest = length.min(LONGEST);
        let (phases, shifts) = (phases(length), shifts(longest));
        let mut lags = Vec::new();
        for_each_lag(6.0 * longest, |lag, weight| {
            let correlation = (-(lag / longest).powi(2)).exp();
            lags.push([lag, TAU * lag * kernel.at(lag) * weight, 1.0 - correlation]);
        });
        let rows: Vec<Row> = nodes(&phases)
            .map(|phase| Row::new(phase, [length, longest], &lags))
            .collect();
        let values: Vec<Vec<f64>> = nodes(&shifts)
            .map(|shift| over_phases(&rows, &lags, kernel, shift))
            .collect();
        let grid = Grid::new(phases, shifts);
        Self { grid, values }
    }

    /// The number of Bessel functions that the table of a relief sums, and the number of its cells.
    #[cfg(test)]
    pub(super) fn size(&self) -> (usize, usize) {
        let mut lags = 0;
        for_each_lag(6.0 * LONGEST, |_, _| lags += 1);
        let [phases, shifts] = self.grid.breaks().each_ref().map(|breaks| breaks.len() - 1);
        (lags * SIDE * shifts, phases * shifts)
    }

    pub(super) fn at(&self, phase: f64, shift: f64) -> f64 {
        let value = |(i, k): (usize, usize), (j, l): (usize, usize)| {
            self.values[j * SIDE + l][i * SIDE + k]
        };
        self.grid.at_nodes([phase, shift], value)
    }
}

impl Row {
    fn new(phase: f64, [length, longest]: [f64; 2], lags: &[[f64; 3]]) -> Self {
        let exponent = phase * phase;
        let acting = if length > longest {
            exponent_of_loss(loss(exponent) * longest / length)
        } else {
            exponent
        };
        let width = longest / (1.0 + acting).sqrt();
        let end = if acting > STEEP {
            6.0 * width
        } else {
            f64::INFINITY
        };
        let dense = (-acting).exp();
        let near = lags.iter().take_while(|lag| lag[0] < end);
        Self {
            width,
            of_lags: near.map(|lag| (-acting * lag[2]).exp() - dense).collect(),
            dense: dense - (-exponent).exp(),
        }
    }
}

/// The excess of all phases at one displacement.
fn over_phases(rows: &[Row], lags: &[[f64; 3]], kernel: LagKernel, shift: f64) -> Vec<f64> {
    let is_met = |row: &Row| !is_beyond(shift, row.width);
    let counts = rows
        .iter()
        .filter(|row| is_met(row))
        .map(|row| row.of_lags.len());
    let lags = &lags[..counts.max().unwrap_or(0)];
    let weights: Vec<f64> = lags
        .iter()
        .map(|[lag, weight, _]| weight * libm::j0(TAU * shift * lag))
        .collect();
    let transform = kernel.transform(shift);
    let sum = |row: &Row| {
        let sum: f64 = row.of_lags.iter().zip(&weights).map(|(a, b)| a * b).sum();
        sum + row.dense * transform
    };
    rows.iter()
        .map(|row| if is_met(row) { sum(row) } else { 0.0 })
        .collect()
}

/// Returns `Λ(a)/√π = ∫ (1 − exp(−a (1 − e^{−u²}))) du/u² / √π`, the loss of light of squared
/// phases a over a long correlation length ℓ in units of `4 √π/(π² ℓ)`, to 0.4 %. It is correct to
/// third order in a, and for large a.
fn loss(exponent: f64) -> f64 {
    exponent * slope(exponent)
}

fn slope(exponent: f64) -> f64 {
    const P: f64 = 0.2274;
    // The second order loses 4 − 2√2 between both.
    const Q: f64 = P + 0.5858;
    ((1.0 + P * exponent) / (1.0 + (Q + P * exponent) * exponent)).sqrt()
}

/// Returns the squared phase whose loss is `wanted`.
fn exponent_of_loss(wanted: f64) -> f64 {
    let mut exponent = wanted + wanted * wanted;
    // The slope falls no faster than the inverse square root: each step halves the error.
    for _ in 0..60 {
        exponent = wanted / slope(exponent);
    }
    exponent
}

/// Breaks of phases: evenly spaced where the excess rises, doubling where it falls as a power.
fn phases(length: f64) -> Vec<f64> {
    let last = length / NARROWEST;
    let mut breaks = vec![0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0];
    while breaks.last().is_some_and(|end| *end < last) {
        breaks.push(2.0 * breaks[breaks.len() - 1]);
    }
    breaks
}

/// Breaks of displacements: finer near 0 and 1, where the kernels have a cusp and an end, down to
/// the sharpness that the heights leave.
fn shifts(longest: f64) -> Vec<f64> {
    let finest = (TAU * longest.max(1.0)).recip();
    let steps = || core::iter::successors(Some(finest), |step| Some(2.0 * step));
    let mut breaks = vec![0.0, 0.5, 1.0, 1.5];
    breaks.extend(steps().take_while(|step| *step < 0.4));
    breaks.extend(
        steps()
            .take_while(|step| *step < 0.4)
            .flat_map(|step| [1.0 - step, 1.0 + step]),
    );
    breaks.sort_unstable_by(f64::total_cmp);
    while breaks.last().is_some_and(|end| *end < 2.0 / NARROWEST) {
        breaks.push(2.0_f64.sqrt() * breaks[breaks.len() - 1]);
    }
    breaks
}

/// Visits lags on panels that are short enough for the displacements and widths that occur there:
/// an excess of width w ends at 6w and has frequencies up to 1 + 2/w.
fn for_each_lag(end: f64, mut visit: impl FnMut(f64, f64)) {
    let mut from = 0.0;
    let mut to = NARROWEST;
    while from < end {
        for_each_node([from, to.min(end)], f64::INFINITY, &mut visit);
        from = to;
        to += (1.6 * from / (from + 12.0)).min(0.8);
    }
}

/// The nodes of all panels between breaks.
fn nodes(breaks: &[f64]) -> impl Iterator<Item = f64> {
    breaks.windows(2).flat_map(|ends| {
        let ends = [ends[0], ends[1]];
        (0..SIDE).map(move |k| at_place(ends, node::<SIDE>(k)))
    })
}
