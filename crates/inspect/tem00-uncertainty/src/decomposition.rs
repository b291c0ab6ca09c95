use tem00_numerics::{Refusal, check};

use crate::{Inputs, UncertaintyError, trials};

/// Options of a decomposition of the variance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecompositionOptions {
    /// The number of samples N, at least 1000; the model is evaluated N (n + 2) times for n inputs.
    pub samples: u32,
    /// The seed of all random numbers.
    pub seed: u64,
}

impl Default for DecompositionOptions {
    /// 2¹⁷ samples with the seed 0.
    fn default() -> Self {
        Self {
            samples: 1 << 17,
            seed: 0,
        }
    }
}

/// A fraction of the variance of a result, with the standard error of its estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SobolIndex {
    /// The fraction. Being an estimate it may lie outside of 0 to 1 by some standard errors.
    pub value: f64,
    /// The standard error.
    pub standard_error: f64,
}

/// Fractions of the variance of a result that belong to one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VarianceParts {
    /// The first-order index S: the fraction by which the variance would fall on average if the
    /// input were known exactly.
    pub first_order: SobolIndex,
    /// The total index `S_T`: the fraction that would be left on average if all other inputs were
    /// known exactly. Its excess over S comes from the input together with other inputs.
    pub total: SobolIndex,
}

/// The decomposition of the variance of a result into parts of its inputs, after Sobol'.
///
/// ```text
/// S   = V(E(Y | X)) / V(Y)        S_T = E(V(Y | all but X)) / V(Y)
/// ```
///
/// Two independent samples A and B of all inputs are drawn, and for each input a third, A with the
/// values of that input from B. Unlike
/// [`Contribution::variance_fraction`](crate::Contribution::variance_fraction) the parts need no
/// linear model.
///
/// # Examples
///
/// A product of two quantities around 0 has no first order at all; its variance comes from both
/// together:
///
/// ```
/// use tem00_uncertainty::{Decomposition, DecompositionOptions, Distribution, Input, Inputs};
///
/// let factor = Input::new(0.0, 1.0, Distribution::Normal)?;
/// let inputs = Inputs::independent(vec![factor; 2])?;
/// let parts = Decomposition::new(&inputs, |x| x[0] * x[1], DecompositionOptions::default())?;
/// for part in parts.inputs() {
///     assert!(part.first_order.value.abs() < 4.0 * part.first_order.standard_error);
///     assert!((part.total.value - 1.0).abs() < 4.0 * part.total.standard_error);
/// }
/// # Ok::<(), tem00_uncertainty::UncertaintyError>(())
/// ```
///
/// # References
///
/// - A. Saltelli et al., *Variance based sensitivity analysis of model output*, Computer Physics
///   Communications 181, 2010, table 2 (b) and (f); the latter is by M. J. W. Jansen, 1999.
#[derive(Clone, Debug, PartialEq)]
pub struct Decomposition {
    inputs: Vec<VarianceParts>,
}

/// The number of samples of a block.
const BLOCK: u32 = 4096;

impl Decomposition {
    /// Decomposes the variance of a model.
    ///
    /// # Errors
    ///
    /// Returns an error if inputs are correlated, if a t distribution has 2 degrees of freedom or
    /// fewer, if there are fewer than 1000 samples, if a value of the model is not finite, or if
    /// all are the same.
    pub fn new(
        inputs: &Inputs,
        model: impl Fn(&[f64]) -> f64 + Sync,
        options: DecompositionOptions,
    ) -> Result<Self, UncertaintyError> {
        if !inputs.are_independent() {
            return Err(UncertaintyError::Correlated);
        }
        inputs.check_variances()?;
        let samples = f64::from(options.samples);
        check::that(samples >= 1e3, "samples", samples, "", "at least 1000")?;
        let origin = trials::value(&model, &inputs.estimates())?;
        // Products scatter less about the mean, and this is close to it.
        let about_origin = |x: &[f64]| model(x) - origin;
        let blocks = u64::from(options.samples.div_ceil(BLOCK));
        let of_block = |block| sums(inputs, &about_origin, options, block);
        let sums: Vec<_> = trials::map(0..blocks, of_block)
            .into_iter()
            .collect::<Result<_, _>>()?;
        let parts = |input: usize| {
            let index =
                |order: usize| total(sums.iter().map(|of_block| of_block[input][order])).index();
            Some(VarianceParts {
                first_order: index(0)?,
                total: index(1)?,
            })
        };
        let found: Option<Vec<_>> = (0..inputs.as_slice().len()).map(parts).collect();
        let allowed = "of a variance that is positive and finite";
        match found {
            Some(inputs) => Ok(Self { inputs }),
            None => Err(Refusal::new("model", origin, allowed).into()),
        }
    }

    /// Returns the parts of each input, in their order.
    pub fn inputs(&self) -> &[VarianceParts] {
        &self.inputs
    }
}

/// Sums over samples of a part t and of the variance v, which is the mean of (f(A) − f(B))²/2.
#[derive(Clone, Copy, Debug, Default)]
struct Sums([f64; 5]);

impl Sums {
    fn of_sample(part: f64, variance: f64) -> Self {
        let squares = [part * part, variance * variance, part * variance];
        Self([part, variance, squares[0], squares[1], squares[2]])
    }

    fn and(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// Returns the ratio S = Σt / Σv and its standard error √Σ(t − S v)² / Σv; `None` without a
    /// variance.
    fn index(&self) -> Option<SobolIndex> {
        let [part, variance, part_squared, variance_squared, product] = self.0;
        let value = part / variance;
        let square = part_squared + value * (value * variance_squared - 2.0 * product);
        // Rounding may make it negative.
        let standard_error = square
            .is_finite()
            .then(|| square.max(0.0).sqrt() / variance)?;
        value.is_finite().then_some(SobolIndex {
            value,
            standard_error,
        })
    }
}

fn total(sums: impl Iterator<Item = Sums>) -> Sums {
    sums.fold(Sums::default(), Sums::and)
}

/// Returns the sums of one block of samples: for each input, the sums of first order and the sums
/// of the total.
fn sums(
    inputs: &Inputs,
    model: &impl Fn(&[f64]) -> f64,
    options: DecompositionOptions,
    block: u64,
) -> Result<Vec<[Sums; 2]>, UncertaintyError> {
    let mut random = trials::stream(options.seed, block);
    let drawn = |values: &[f64]| trials::drawn_value(inputs, model, values);
    let mut sums = vec![[Sums::default(); 2]; inputs.as_slice().len()];
    let [mut a, mut b] = [inputs.estimates(), inputs.estimates()];
    let before = block * u64::from(BLOCK);
    for _ in before..u64::from(options.samples).min(before + u64::from(BLOCK)) {
        inputs.draw(&mut random, &mut a);
        inputs.draw(&mut random, &mut b);
        let (at_a, at_b) = (drawn(&a)?, drawn(&b)?);
        let variance = 0.5 * (at_a - at_b).powi(2);
        for (input, [first_order, total]) in sums.iter_mut().enumerate() {
            let kept = core::mem::replace(&mut a[input], b[input]);
            let change = drawn(&a)? - at_a;
            a[input] = kept;
            *first_order = first_order.and(Sums::of_sample(at_b * change, variance));
            *total = total.and(Sums::of_sample(0.5 * change * change, variance));
        }
    }
    Ok(sums)
}

#[cfg(test)]
mod tests;
