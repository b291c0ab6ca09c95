use crate::{Refusal, check};

/// Returns weights as fractions of their sum.
///
/// # Errors
///
/// Returns an error if a weight is negative or not finite, or if no weight is positive.
///
/// # Examples
///
/// ```
/// use tem00_numerics::fractions;
///
/// assert_eq!(fractions("weights", &[1e308, 1e308, 0.0])?, [0.5, 0.5, 0.0]);
/// assert!(fractions("weights", &[0.0]).is_err());
/// # Ok::<(), tem00_numerics::Refusal>(())
/// ```
pub fn fractions(parameter: &'static str, weights: &[f64]) -> Result<Vec<f64>, Refusal> {
    check::each(weights, |weight| check::not_negative(parameter, weight, ""))?;
    let largest = weights.iter().fold(0.0_f64, |a, &b| a.max(b));
    check::that(largest > 0.0, parameter, 0.0, "", "of a positive sum")?;
    // Scaled by the largest first: the sum of the weights may overflow.
    let scaled = || weights.iter().map(|weight| weight / largest);
    let total: f64 = scaled().sum();
    Ok(scaled().map(|weight| weight / total).collect())
}
