//! Contribution of correlated heights to the correlation of two parts of the light.

use core::{cell::OnceCell, f64::consts::TAU};

use tem00_numerics::quadrature::integrate;

use crate::kernel::LagKernel;

mod table;

/// Contribution of a correlation length of heights to a mean of `exp(−x² (1 − ρ) + 2πi s·η)` over
/// lags η, in speckles, with the phase x of the heights and the displacement s of the pupil in
/// diameters.
///
/// A single value is an integral over the lags. If many values are needed, or the integral is long,
/// they come from a table, so that the work is bounded for any relief.
#[derive(Clone, Debug)]
pub(crate) struct HeightExcess {
    kernel: LagKernel,
    /// The correlation length, in speckles.
    length: f64,
    path_spread: f64,
    is_tabulated: bool,
    table: OnceCell<table::Table>,
}

/// Correlation length in speckles above which the integrals are always tabulated.
const LONG: f64 = 8.0;

impl HeightExcess {
    pub(crate) fn new(kernel: LagKernel, [length, path_spread]: [f64; 2], is_often: bool) -> Self {
        Self {
            kernel,
            length,
            path_spread,
            is_tabulated: is_often || length > LONG,
            table: OnceCell::new(),
        }
    }

    /// Returns the excess for a difference of wave numbers that acts on heights, in rad/m, and a
    /// displacement of the pupil.
    pub(crate) fn at(&self, of_heights: f64, shift: f64) -> f64 {
        let phase = (of_heights * self.path_spread).abs();
        if self.length == 0.0 || phase == 0.0 {
            return 0.0;
        }
        if self.is_tabulated {
            let table = self
                .table
                .get_or_init(|| table::Table::new(self.kernel, self.length));
            return table.at(phase, shift);
        }
        by_lags(self.kernel, self.length, [phase, shift])
    }
}

/// Squared phases above which lags beyond the width of the excess no longer matter.
const STEEP: f64 = 50.0;

/// Returns whether the excess vanishes at a displacement: kernels have no frequency above 1 per
/// speckle, and the excess hardly any above 1 per `width`.
fn is_beyond(shift: f64, width: f64) -> bool {
    TAU * (shift - 1.0) * width > 12.0
}

/// Returns the excess by an integral over lags.
fn by_lags(kernel: LagKernel, length: f64, [phase, shift]: [f64; 2]) -> f64 {
    let exponent = phase.powi(2);
    let turns = TAU * shift;
    let excess = |lag: f64| {
        let correlation = (-(lag / length).powi(2)).exp();
        let excess = (-exponent * (1.0 - correlation)).exp() - (-exponent).exp();
        TAU * lag * kernel.at(lag) * excess * libm::j0(turns * lag)
    };
    // The excess falls from lag 0 on over ℓ or, for large heights, over a shorter distance; the
    // image kernel falls over a speckle.
    let width = length / (1.0 + exponent).sqrt();
    if is_beyond(shift, width) {
        return 0.0;
    }
    let reach = if exponent > STEEP { 0.0 } else { 6.0 * length };
    let near = 6.0 * width;
    let step = |width: f64| width.min(1.0).min(1.0 / turns.max(1e-3));
    let inner = integrate(excess, [0.0, near], step(width));
    inner + integrate(excess, [near, reach], step(length))
}

#[cfg(test)]
mod tests;
