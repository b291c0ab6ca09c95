use tem00_numerics::{LeastSquaresError, Minimum, NormalEquations};

use super::error::FitError;

/// The deviation of one datum from the model, in units of its own error, and the derivatives of
/// this deviation with respect to the parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual<const N: usize> {
    pub(super) value: f64,
    pub(super) slopes: [f64; N],
}

/// Finds the minimum of the sum of squares of `count` residuals near `start`.
pub(super) fn minimise<const N: usize>(
    start: [f64; N],
    count: usize,
    residual: impl Fn(&[f64; N], usize) -> Residual<N>,
) -> Result<Minimum<[f64; N]>, FitError> {
    let stepped = |p: &[f64; N], step: &[f64]| core::array::from_fn(|i| p[i] + step[i]);
    let equations = |p: &[f64; N]| {
        let mut equations = NormalEquations::new(N);
        for i in 0..count {
            let Residual { value, slopes } = residual(p, i);
            equations.add(value, &slopes);
        }
        Some(equations)
    };
    let found = tem00_numerics::minimise(start, stepped, equations);
    found.map_err(|error| match error {
        LeastSquaresError::Undetermined => FitError::Undetermined,
        LeastSquaresError::NotConverged => FitError::NotConverged,
    })
}
