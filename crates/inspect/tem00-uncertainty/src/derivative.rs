use crate::{UncertaintyError, trials::value};

/// A derivative and its numerical uncertainty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Derivative {
    pub(crate) value: f64,
    pub(crate) open: f64,
}

/// The number of steps that are tried.
const STEPS: usize = 10;
/// The ratio of one step to the next.
const RATIO: f64 = 1.4;

/// Returns the derivative of a model by one input, at its estimates.
///
/// Central differences over steps that shrink from `first_step` on are extrapolated to a step of
/// zero; the result is the element of the tableau that differs least from its neighbours.
///
/// # References
///
/// - C. J. F. Ridders, *Accurate computation of F′(x) and F′(x) F″(x)*, Advances in Engineering
///   Software 4, 1982.
pub(crate) fn derivative(
    model: &impl Fn(&[f64]) -> f64,
    estimates: &[f64],
    input: usize,
    first_step: f64,
) -> Result<Derivative, UncertaintyError> {
    let mut x = estimates.to_vec();
    let mut difference = |step: f64| {
        let centre = estimates[input];
        let (above, below) = (centre + step, centre - step);
        x[input] = above;
        let up = value(model, &x)?;
        x[input] = below;
        // The step that was taken, as the numbers around the estimate are spaced.
        Ok::<f64, UncertaintyError>((up - value(model, &x)?) / (above - below))
    };
    let mut best = Derivative {
        value: difference(first_step)?,
        open: f64::INFINITY,
    };
    let mut last = vec![best.value];
    let mut step = first_step;
    for _ in 1..STEPS {
        step /= RATIO;
        let mut row = vec![difference(step)?];
        let mut factor = 1.0;
        for order in 0..last.len() {
            factor *= RATIO * RATIO;
            let value = (factor * row[order] - last[order]) / (factor - 1.0);
            let open = (value - row[order]).abs().max((value - last[order]).abs());
            if open <= best.open {
                best = Derivative { value, open };
            }
            row.push(value);
        }
        last = row;
    }
    Ok(best)
}
