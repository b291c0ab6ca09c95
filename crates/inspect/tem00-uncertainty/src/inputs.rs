use rand_core::Rng;
use tem00_numerics::{Refusal, check, lower_factor};

use crate::{Input, UncertaintyError};

/// Correlation coefficient of two inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// The positions of both inputs.
    pub between: [usize; 2],
    /// The correlation coefficient, from −1 to 1.
    pub coefficient: f64,
}

/// The inputs of a model and their correlations.
#[derive(Clone, Debug, PartialEq)]
pub struct Inputs {
    inputs: Vec<Input>,
    joint: Option<Joint>,
}

/// The correlation matrix and its lower factor, row by row.
#[derive(Clone, Debug, PartialEq)]
struct Joint {
    coefficients: Vec<Vec<f64>>,
    factor: Vec<Vec<f64>>,
}

impl Inputs {
    /// Creates independent inputs.
    ///
    /// # Errors
    ///
    /// Returns an error if there are none.
    pub fn independent(inputs: Vec<Input>) -> Result<Self, UncertaintyError> {
        if inputs.is_empty() {
            return Err(UncertaintyError::NoInputs);
        }
        Ok(Self {
            inputs,
            joint: None,
        })
    }

    /// Creates inputs of which some are correlated, and jointly normal.
    ///
    /// The joint distribution follows JCGM 101, § 6.4.8. There is none for other shapes, and the
    /// formula of Welch and Satterthwaite holds for independent inputs: correlated inputs must be
    /// normal with infinite degrees of freedom. Correlations of ±1 are possible.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no inputs, if a correlation is not between two different ones,
    /// is given twice or is not from −1 to 1, if a correlated input is not normal, or if the
    /// correlations are not possible together: if their matrix is not positive semi-definite, to
    /// 10⁻¹².
    pub fn correlated(
        inputs: Vec<Input>,
        correlations: &[Correlation],
    ) -> Result<Self, UncertaintyError> {
        let independent = Self::independent(inputs)?;
        if correlations.is_empty() {
            return Ok(independent);
        }
        let coefficients = independent.matrix(correlations)?;
        let factor = lower_factor(&coefficients, ROUNDING)
            .map_err(|input| UncertaintyError::Contradiction { input })?;
        Ok(Self {
            joint: Some(Joint {
                coefficients,
                factor,
            }),
            ..independent
        })
    }

    /// Returns the inputs.
    pub fn as_slice(&self) -> &[Input] {
        &self.inputs
    }

    /// Returns the best estimates.
    pub fn estimates(&self) -> Vec<f64> {
        self.inputs.iter().map(Input::estimate).collect()
    }

    /// Returns whether no correlations were given.
    pub const fn are_independent(&self) -> bool {
        self.joint.is_none()
    }

    /// Returns the correlation coefficient of two inputs.
    ///
    /// # Panics
    ///
    /// Panics unless both positions are below the number of inputs.
    pub fn correlation(&self, first: usize, second: usize) -> f64 {
        match &self.joint {
            Some(joint) => joint.coefficients[first][second],
            None => f64::from(first == second),
        }
    }

    /// Checks that trials can converge to a variance of a function of the inputs.
    pub(crate) fn check_variances(&self) -> Result<(), UncertaintyError> {
        let has_none = |input: &&Input| input.standard_deviation().is_infinite();
        match self.inputs.iter().find(has_none) {
            Some(input) => {
                let allowed = "above 2 for trials: a t distribution has no variance otherwise";
                Err(Refusal::new("degrees_of_freedom", input.degrees_of_freedom(), allowed).into())
            }
            None => Ok(()),
        }
    }

    /// Returns the error about the first input whose drawn value is not possible even if all others
    /// are as estimated.
    pub fn impossible_draw(
        &self,
        drawn: &[f64],
        is_possible: impl Fn(&[f64]) -> bool,
    ) -> Option<UncertaintyError> {
        let mut inputs = drawn.iter().zip(&self.inputs).enumerate();
        inputs.find_map(|(input, (&value, of))| {
            let mut values = self.estimates();
            values[input] = value;
            let distribution = of.distribution();
            (!is_possible(&values)).then_some(UncertaintyError::ImpossibleDraw {
                input,
                distribution,
                value,
            })
        })
    }

    /// Draws the values of all inputs.
    ///
    /// # Panics
    ///
    /// Panics unless `values.len()` is the number of inputs.
    pub fn draw(&self, random: &mut impl Rng, values: &mut [f64]) {
        assert_eq!(values.len(), self.inputs.len(), "one value per input");
        for (value, input) in values.iter_mut().zip(&self.inputs) {
            *value = input.draw(random);
        }
        if let Some(joint) = &self.joint {
            // From the last on, whose row needs all deviations before it.
            for (i, row) in joint.factor.iter().enumerate().rev() {
                values[i] = row.iter().zip(&*values).map(|(l, z)| l * z).sum();
            }
        }
        for (value, input) in values.iter_mut().zip(&self.inputs) {
            *value = input.estimate() + input.uncertainty() * *value;
        }
    }

    fn matrix(&self, correlations: &[Correlation]) -> Result<Vec<Vec<f64>>, UncertaintyError> {
        let count = self.inputs.len();
        let row = |i| (0..count).map(|j| f64::from(i == j)).collect();
        let mut matrix: Vec<Vec<f64>> = (0..count).map(row).collect();
        for (index, correlation) in correlations.iter().enumerate() {
            self.check(correlation)?;
            let [i, j] = correlation.between;
            let is_same = |other: &Correlation| {
                other.between == correlation.between || other.between == [j, i]
            };
            if correlations[..index].iter().any(is_same) {
                return Err(UncertaintyError::Repeated { between: [i, j] });
            }
            matrix[i][j] = correlation.coefficient;
            matrix[j][i] = correlation.coefficient;
        }
        Ok(matrix)
    }

    fn check(&self, correlation: &Correlation) -> Result<(), UncertaintyError> {
        let Correlation {
            between,
            coefficient,
        } = *correlation;
        let inputs = self.inputs.len();
        if between[0] == between[1] || between.iter().any(|&input| input >= inputs) {
            return Err(UncertaintyError::Between { between, inputs });
        }
        let holds = (-1.0..=1.0).contains(&coefficient);
        check::that(holds, "coefficient", coefficient, "", "from −1 to 1")?;
        let is_other = |input: &usize| !self.inputs[*input].is_exactly_normal();
        let refused = |input| Err(UncertaintyError::NotNormal { input });
        between.into_iter().find(is_other).map_or(Ok(()), refused)
    }
}

/// The largest pivot of a correlation matrix that is taken as 0: the column under it is at most
/// 10⁻⁶.
const ROUNDING: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Distribution, trials::stream};

    fn normals(count: usize) -> Vec<Input> {
        vec![Input::new(0.0, 1.0, Distribution::Normal).unwrap(); count]
    }

    fn correlations(coefficients: &[([usize; 2], f64)]) -> Vec<Correlation> {
        let correlation = |&(between, coefficient)| Correlation {
            between,
            coefficient,
        };
        coefficients.iter().map(correlation).collect()
    }

    /// Columns of draws.
    fn draws(inputs: &Inputs, trials: usize) -> Vec<Vec<f64>> {
        let mut random = stream(3, 0);
        let mut values = inputs.estimates();
        let mut columns = vec![Vec::new(); values.len()];
        for _ in 0..trials {
            inputs.draw(&mut random, &mut values);
            for (column, &value) in columns.iter_mut().zip(&values) {
                column.push(value);
            }
        }
        columns
    }

    #[test]
    fn draws_have_the_correlations_that_were_given() {
        const TRIALS: usize = 40_000;
        let mut all = normals(4);
        all.push(Input::new(0.0, 1.0, Distribution::Rectangular).unwrap());
        let given = correlations(&[([0, 2], 0.9), ([3, 0], -0.4), ([3, 2], -0.6)]);
        let inputs = Inputs::correlated(all, &given).unwrap();
        let columns = draws(&inputs, TRIALS);
        for i in 0..5 {
            for j in 0..i {
                let expected = inputs.correlation(i, j);
                let products = columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b);
                let found = products.sum::<f64>() / TRIALS as f64;
                // The standard error for normals; 3.9 of it have the probability 1e-4.
                let error = ((1.0 + expected * expected) / TRIALS as f64).sqrt();
                assert!(
                    (found - expected).abs() < 3.9 * error,
                    "{i}, {j}: {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn full_correlation_makes_draws_equal() {
        let given = correlations(&[([0, 1], 1.0), ([0, 2], -1.0), ([1, 2], -1.0)]);
        let inputs = Inputs::correlated(normals(3), &given).unwrap();
        let columns = draws(&inputs, 10);
        let [first, second, third] = &columns[..] else {
            panic!("three columns");
        };
        for ((a, b), c) in first.iter().zip(second).zip(third) {
            assert!(
                (a - b).abs() < 1e-15 && (a + c).abs() < 1e-15,
                "{a}, {b}, {c}"
            );
        }
    }

    #[test]
    fn correlations_that_no_quantities_have_are_refused() {
        // The determinant is 1 + 2 r₁₂ r₁₃ r₂₃ − r₁₂² − r₁₃² − r₂₃² = −0.358 and −4.
        for [first, second, third] in [[0.9, 0.9, 0.4], [1.0, 1.0, -1.0]] {
            let given = correlations(&[([0, 1], first), ([0, 2], second), ([1, 2], third)]);
            let found = Inputs::correlated(normals(3), &given);
            let expected = UncertaintyError::Contradiction { input: 2 };
            assert_eq!(found, Err(expected), "{given:?}");
        }
    }

    #[test]
    fn singular_correlations_draw_what_depends_on_the_others() {
        for turn in 1..12 {
            let (sin, cos) = (0.13 * f64::from(turn)).sin_cos();
            let given = correlations(&[([0, 2], sin), ([1, 2], cos)]);
            let inputs = Inputs::correlated(normals(3), &given).unwrap();
            let columns = draws(&inputs, 10);
            for (i, found) in columns[2].iter().enumerate() {
                let expected = sin * columns[0][i] + cos * columns[1][i];
                assert!(
                    (found - expected).abs() < 1e-14,
                    "{turn}: {found}, {expected}"
                );
            }
        }
    }

    #[test]
    fn correlations_of_what_is_not_two_normal_inputs_are_refused() {
        let mut all = normals(2);
        all.push(Input::new(0.0, 1.0, Distribution::Rectangular).unwrap());
        all.push(all[0].with_degrees_of_freedom(9.0).unwrap());
        let refused = |given: &[([usize; 2], f64)]| {
            Inputs::correlated(all.clone(), &correlations(given)).unwrap_err()
        };
        let between = |between| UncertaintyError::Between { between, inputs: 4 };
        assert_eq!(refused(&[([1, 1], 0.5)]), between([1, 1]), "with itself");
        assert_eq!(refused(&[([0, 4], 0.5)]), between([0, 4]), "with nothing");
        let repeated = UncertaintyError::Repeated { between: [1, 0] };
        assert_eq!(refused(&[([0, 1], 0.5), ([1, 0], 0.5)]), repeated, "twice");
        for input in [2, 3] {
            let expected = UncertaintyError::NotNormal { input };
            assert_eq!(refused(&[([0, input], 0.5)]), expected, "{input}");
        }
        for coefficient in [-1.001, 1.0_f64.next_up(), f64::INFINITY, f64::NAN] {
            let told = refused(&[([0, 1], coefficient)]).to_string();
            assert!(
                told.starts_with("coefficient must be from −1 to 1"),
                "{told}"
            );
        }
        let none = Inputs::independent(Vec::new());
        assert_eq!(none, Err(UncertaintyError::NoInputs), "none");
    }
}
