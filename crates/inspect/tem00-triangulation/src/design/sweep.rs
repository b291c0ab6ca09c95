use tem00_numerics::check;

use crate::{SetupQuantity, TriangulationError};

/// The values that a search tries of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    parameter: SetupQuantity,
    values: Vec<f64>,
}

/// Spacing of the values of a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios.
    Logarithmic,
}

impl Sweep {
    /// Creates a sweep over given values, in SI units, in the order in which they are tried.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no value, or one is not positive and finite.
    pub fn list(parameter: SetupQuantity, values: Vec<f64>) -> Result<Self, TriangulationError> {
        if values.is_empty() {
            return Err(TriangulationError::TooFew {
                what: "values of a parameter that is varied",
                got: 0,
                needed: 1,
            });
        }
        for &value in &values {
            check::positive(parameter.key(), value, "")?;
        }
        Ok(Self { parameter, values })
    }

    /// Creates a sweep over `steps` values from one end to the other, both included.
    ///
    /// ```text
    /// linear        x_i = a + (b − a) i / (n − 1)
    /// logarithmic   x_i = a (b / a)^(i / (n − 1))
    /// ```
    ///
    /// Values between the ends are rounded, in the unit that they are usually written in, to less
    /// than a hundredth of a step: 5.04 instead of 5.0397.
    ///
    /// # Errors
    ///
    /// Returns an error if an end is not positive and finite, or if there are less than two steps.
    pub fn between(
        parameter: SetupQuantity,
        (from, to): (f64, f64),
        steps: u32,
        spacing: Spacing,
    ) -> Result<Self, TriangulationError> {
        for end in [from, to] {
            check::positive(parameter.key(), end, "")?;
        }
        let count = f64::from(steps);
        check::that(steps >= 2, "steps", count, "", "at least 2, the two ends")?;
        let last = count - 1.0;
        let value = |step: u32| match (step, spacing) {
            (0, _) => from,
            (step, _) if step == steps - 1 => to,
            (step, Spacing::Linear) => from + (to - from) * f64::from(step) / last,
            (step, Spacing::Logarithmic) => {
                from * libm::exp(libm::log(to / from) * f64::from(step) / last)
            }
        };
        let exact: Vec<f64> = (0..steps).map(value).collect();
        Self::list(parameter, rounded(parameter, &exact))
    }

    /// Returns the varied parameter.
    pub const fn parameter(&self) -> SetupQuantity {
        self.parameter
    }

    /// Returns the values, in SI units.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// Rounds the values between the ends to a hundredth of the step to the nearer neighbour.
fn rounded(parameter: SetupQuantity, exact: &[f64]) -> Vec<f64> {
    let mut values = exact.to_vec();
    for (value, around) in values[1..].iter_mut().zip(exact.windows(3)) {
        let step = (around[1] - around[0])
            .abs()
            .min((around[2] - around[1]).abs());
        let unit = parameter.unit();
        *value = unit.dimension.rounded(around[1], 0.01 * step, unit.symbol);
    }
    values
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_relative, refuses};

    use super::*;

    #[test]
    fn ends_are_exact_and_steps_even() {
        let sweep = |spacing| Sweep::between(SetupQuantity::FNumber, (2.8, 22.4), 4, spacing);
        // 2.8 + 19.6/3 = 9.333… is rounded to hundredths, as steps are 6.5 wide.
        assert_eq!(
            sweep(Spacing::Linear).unwrap().values,
            [2.8, 9.33, 15.87, 22.4]
        );
        assert_eq!(
            sweep(Spacing::Logarithmic).unwrap().values,
            [2.8, 5.6, 11.2, 22.4]
        );
        for steps in [2_u32, 3, 50, 1000] {
            let ends = (1e-3, 1.1e-3);
            let sweep = Sweep::between(SetupQuantity::Exposure, ends, steps, Spacing::Linear);
            for pair in sweep.unwrap().values().windows(2) {
                // Half a hundredth of a step at either end.
                let step = 0.1e-3 / f64::from(steps - 1);
                assert_relative(pair[1] - pair[0], step, 0.0101);
            }
        }
    }

    #[test]
    fn values_that_are_no_sizes_are_refused() {
        refuses!(angle = 0.5 => Sweep::list(SetupQuantity::Angle, vec![0.5, angle]);
            angle: [0.0, -1.0, f64::NAN, f64::INFINITY]);
        refuses!(steps = 2
            => Sweep::between(SetupQuantity::Angle, (0.1, 0.2), steps, Spacing::Linear);
            steps: [0, 1]);
        let none = Sweep::list(SetupQuantity::Angle, Vec::new());
        assert!(
            matches!(none, Err(TriangulationError::TooFew { .. })),
            "{none:?}"
        );
    }
}
