//! Values of a model, and streams of random numbers.

use core::ops::Range;

use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use tem00_numerics::parallel;

use crate::{Inputs, UncertaintyError};

/// Returns the random numbers of a block of trials: a separate stream.
pub(crate) fn stream(seed: u64, block: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(block);
    random
}

/// Returns the value of a model.
pub(crate) fn value(
    model: &impl Fn(&[f64]) -> f64,
    inputs: &[f64],
) -> Result<f64, UncertaintyError> {
    let value = model(inputs);
    if value.is_finite() {
        return Ok(value);
    }
    Err(UncertaintyError::NotFinite {
        value,
        inputs: inputs.to_vec(),
    })
}

/// Returns the value of a model at values that were drawn.
///
/// # Errors
///
/// Returns an error that names the input which alone makes the value impossible, if there is one.
pub(crate) fn drawn_value(
    inputs: &Inputs,
    model: &impl Fn(&[f64]) -> f64,
    drawn: &[f64],
) -> Result<f64, UncertaintyError> {
    value(model, drawn).map_err(|error| {
        let is_possible = |values: &[f64]| model(values).is_finite();
        inputs.impossible_draw(drawn, is_possible).unwrap_or(error)
    })
}

/// Returns the values of a model in one block of trials.
pub(crate) fn block(
    (inputs, model): (&Inputs, &impl Fn(&[f64]) -> f64),
    (seed, block): (u64, u64),
    trials: usize,
) -> Result<Vec<f64>, UncertaintyError> {
    let mut random = stream(seed, block);
    let mut values = inputs.estimates();
    let mut trial = || {
        inputs.draw(&mut random, &mut values);
        drawn_value(inputs, model, &values)
    };
    (0..trials).map(|_| trial()).collect()
}

/// Returns the results of `work` for the numbers of a range, in their order.
pub(crate) fn map<T: Send>(range: Range<u64>, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    parallel::map_items_with(range.collect(), |(), _, number| work(number))
}
