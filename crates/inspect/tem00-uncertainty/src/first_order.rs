use crate::{
    CoverageInterval, CoverageProbability, Input, Inputs, UncertaintyError, coverage_factor,
    derivative::{Derivative, derivative},
    effective_degrees_of_freedom,
    trials::value,
};

/// Contribution of one input to a combined standard uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// The sensitivity coefficient c = ∂f/∂x.
    pub sensitivity: f64,
    /// The standard uncertainty of the result by this input alone, |c| u(x).
    pub uncertainty: f64,
    /// The fraction of the variance of the result: c u(x) Σ r c u over all inputs, divided by the
    /// variance. The fractions of all inputs add up to 1; the fraction of a correlated input may be
    /// negative. Without a variance they are 0.
    pub variance_fraction: f64,
}

/// The law of propagation of uncertainty: a result and its uncertainty to first order.
///
/// ```text
/// u_c² = Σᵢ Σⱼ cᵢ cⱼ u(xᵢ) u(xⱼ) r(xᵢ, xⱼ)      cᵢ = ∂f/∂xᵢ
/// ```
///
/// The derivatives are central differences over at most one standard uncertainty, extrapolated to a
/// step of zero. For a t distribution u is the scale, as JCGM 100 has it.
///
/// # Validity
///
/// The model is close to linear over a few standard uncertainties, and no input that is not normal
/// dominates. [`Propagation::validate`](crate::Propagation::validate) checks this.
///
/// The [front page](crate) has an example.
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, eq. (10), (13) and
///   (16); G.4.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstOrder {
    estimate: f64,
    combined: f64,
    degrees_of_freedom: f64,
    contributions: Vec<Contribution>,
}

impl FirstOrder {
    /// Returns the result of a model.
    ///
    /// # Errors
    ///
    /// Returns an error if the model is not finite at the estimates or within one standard
    /// uncertainty of them, or not so smooth within a twentieth of one that each contribution is
    /// known to 10⁻⁶ of the largest.
    pub fn new(inputs: &Inputs, model: impl Fn(&[f64]) -> f64) -> Result<Self, UncertaintyError> {
        let estimates = inputs.estimates();
        let estimate = value(&model, &estimates)?;
        let all = inputs.as_slice().iter().map(Input::uncertainty).enumerate();
        let derivatives = all.map(|(index, u)| derivative(&model, &estimates, index, u));
        let derivatives: Vec<Derivative> = derivatives.collect::<Result<_, _>>()?;
        check_smooth(inputs, &derivatives)?;
        let sensitivities = derivatives.iter().map(|derivative| derivative.value);
        Ok(Self::of(
            inputs,
            estimate,
            &sensitivities.collect::<Vec<_>>(),
        ))
    }

    fn of(inputs: &Inputs, estimate: f64, sensitivities: &[f64]) -> Self {
        let all = inputs.as_slice().iter().zip(sensitivities);
        let changes: Vec<f64> = all.map(|(input, c)| c * input.uncertainty()).collect();
        let covariance = |i: usize| {
            let row = changes.iter().enumerate();
            changes[i]
                * row
                    .map(|(j, change)| inputs.correlation(i, j) * change)
                    .sum::<f64>()
        };
        let parts: Vec<f64> = (0..changes.len()).map(covariance).collect();
        // A sum that cancels by correlation may be negative by rounding.
        let variance = parts.iter().sum::<f64>().max(0.0);
        let contribution = |(i, &sensitivity): (usize, &f64)| Contribution {
            sensitivity,
            uncertainty: changes[i].abs(),
            variance_fraction: if variance > 0.0 {
                parts[i] / variance
            } else {
                0.0
            },
        };
        let pairs = changes.iter().zip(inputs.as_slice());
        let pairs = pairs.map(|(change, input)| (change.abs(), input.degrees_of_freedom()));
        let combined = variance.sqrt();
        Self {
            estimate,
            combined,
            degrees_of_freedom: effective_degrees_of_freedom(combined, &pairs.collect::<Vec<_>>()),
            contributions: sensitivities.iter().enumerate().map(contribution).collect(),
        }
    }

    /// Returns the result: the model at the best estimates.
    pub const fn estimate(&self) -> f64 {
        self.estimate
    }

    /// Returns the combined standard uncertainty `u_c`.
    pub const fn combined(&self) -> f64 {
        self.combined
    }

    /// Returns the effective degrees of freedom of the combined standard uncertainty.
    pub const fn degrees_of_freedom(&self) -> f64 {
        self.degrees_of_freedom
    }

    /// Returns the contributions of the inputs, in their order.
    pub fn contributions(&self) -> &[Contribution] {
        &self.contributions
    }

    /// Returns the expanded uncertainty `U = k u_c`.
    pub fn expanded(&self, probability: CoverageProbability) -> f64 {
        coverage_factor(self.degrees_of_freedom, probability) * self.combined
    }

    /// Returns the interval of the result ± its expanded uncertainty.
    pub fn interval(&self, probability: CoverageProbability) -> CoverageInterval {
        let half = self.expanded(probability);
        CoverageInterval {
            low: self.estimate - half,
            high: self.estimate + half,
        }
    }
}

/// Checks that the differences converged to the derivatives.
fn check_smooth(inputs: &Inputs, derivatives: &[Derivative]) -> Result<(), UncertaintyError> {
    const ALLOWED: f64 = 1e-6;
    let all = inputs.as_slice().iter().zip(derivatives);
    let changes = all.map(|(input, derivative)| {
        let u = input.uncertainty();
        (u * derivative.value.abs(), u * derivative.open)
    });
    let changes: Vec<(f64, f64)> = changes.collect();
    let largest = changes
        .iter()
        .fold(0.0, |a: f64, (change, _)| a.max(*change));
    match changes
        .iter()
        .position(|(_, open)| *open > ALLOWED * largest)
    {
        Some(input) => Err(UncertaintyError::NotDifferentiable {
            input,
            open: changes[input].1 / largest,
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
