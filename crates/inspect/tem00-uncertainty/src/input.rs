use core::f64::consts::TAU;

use rand_core::Rng;
use rand_distr::{Distribution as _, StandardNormal, StudentT};
use tem00_numerics::check;

use crate::{Distribution, UncertaintyError};

/// Estimate, uncertainty and distribution of an input quantity.
///
/// `u` is the standard uncertainty, the square root of the variance; for a scaled and shifted t it
/// is the scale, s/√n for n observations, and the standard deviation is
/// [larger](Self::standard_deviation).
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, § 4.2 and 4.3.
/// - JCGM 101:2008, § 6.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    estimate: f64,
    uncertainty: f64,
    distribution: Distribution,
    degrees_of_freedom: f64,
}

impl Input {
    /// Creates an input from its best estimate and its standard uncertainty, which is exactly
    /// known: its degrees of freedom are infinite.
    ///
    /// # Errors
    ///
    /// Returns an error if `estimate` is not finite or `uncertainty` is not positive and finite.
    pub fn new(
        estimate: f64,
        uncertainty: f64,
        distribution: Distribution,
    ) -> Result<Self, UncertaintyError> {
        Ok(Self {
            estimate: check::finite("estimate", estimate, "")?,
            uncertainty: check::positive("uncertainty", uncertainty, "")?,
            distribution,
            degrees_of_freedom: f64::INFINITY,
        })
    }

    /// Returns the same input with the degrees of freedom of its standard uncertainty.
    ///
    /// If they are finite, a normal input becomes a scaled and shifted t (JCGM 101, § 6.4.9).
    /// Degrees of freedom of other shapes count only in the law of propagation.
    ///
    /// # Errors
    ///
    /// Returns an error if the degrees of freedom are below 1.
    pub fn with_degrees_of_freedom(
        self,
        degrees_of_freedom: f64,
    ) -> Result<Self, UncertaintyError> {
        let (name, holds) = ("degrees_of_freedom", degrees_of_freedom >= 1.0);
        check::that(holds, name, degrees_of_freedom, "", "at least 1")?;
        let distribution = match self.distribution {
            Distribution::Normal if degrees_of_freedom.is_finite() => Distribution::StudentT,
            shape => shape,
        };
        Ok(Self {
            degrees_of_freedom,
            distribution,
            ..self
        })
    }

    /// Returns the best estimate.
    pub const fn estimate(&self) -> f64 {
        self.estimate
    }

    /// Returns the standard uncertainty.
    pub const fn uncertainty(&self) -> f64 {
        self.uncertainty
    }

    /// Returns the distribution. A t distribution with infinite degrees of freedom is normal.
    pub const fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Returns the degrees of freedom of the standard uncertainty, possibly infinite.
    pub const fn degrees_of_freedom(&self) -> f64 {
        self.degrees_of_freedom
    }

    /// Returns the standard deviation of the distribution: `u`, or `u √(ν / (ν − 2))` for a t
    /// distribution with ν degrees of freedom, infinite where they are 2 or fewer.
    pub fn standard_deviation(&self) -> f64 {
        let freedom = self.degrees_of_freedom;
        match self.distribution {
            Distribution::StudentT if freedom.is_finite() => {
                self.uncertainty * (freedom / (freedom - 2.0).max(0.0)).sqrt()
            }
            _ => self.uncertainty,
        }
    }

    /// Returns whether the input is normal with an exactly known standard uncertainty.
    pub(crate) fn is_exactly_normal(&self) -> bool {
        let is_normal = matches!(
            self.distribution,
            Distribution::Normal | Distribution::StudentT
        );
        is_normal && self.degrees_of_freedom.is_infinite()
    }

    /// Draws a deviation from the estimate, in standard uncertainties.
    pub(crate) fn draw(&self, random: &mut impl Rng) -> f64 {
        let mut within = || uniform(random);
        let deviation = match self.distribution {
            Distribution::Rectangular => 2.0 * within() - 1.0,
            Distribution::Triangular => within() + within() - 1.0,
            Distribution::Arcsine => libm::sin(TAU * within()),
            Distribution::StudentT if self.degrees_of_freedom.is_finite() => {
                return StudentT::new(self.degrees_of_freedom)
                    .map_or(f64::NAN, |student| student.sample(random));
            }
            Distribution::Normal | Distribution::StudentT => return StandardNormal.sample(random),
        };
        self.distribution.half_width().unwrap_or(1.0) * deviation
    }
}

/// Draws a number from 0 to 1, both excluded.
fn uniform(random: &mut impl Rng) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
    ((random.next_u64() >> 12) as f64 + 0.5) * STEP
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use statrs::distribution::{ContinuousCDF, StudentsT};
    use tem00_testkit::{kolmogorov_smirnov, refuses};

    use super::*;
    use crate::trials::stream;

    /// The distribution function of deviations in standard uncertainties.
    fn cumulative(input: &Input, x: f64) -> f64 {
        let inside = |half: f64| (x / half).clamp(-1.0, 1.0);
        match input.distribution() {
            Distribution::Normal => 0.5 * libm::erfc(-x / 2.0_f64.sqrt()),
            Distribution::Rectangular => 0.5 * (1.0 + inside(3.0_f64.sqrt())),
            Distribution::Triangular => {
                let t = inside(6.0_f64.sqrt());
                0.5 + t - 0.5 * t * t.abs()
            }
            Distribution::Arcsine => 0.5 + libm::asin(inside(2.0_f64.sqrt())) / PI,
            Distribution::StudentT => {
                // With this many degrees of freedom it is normal.
                let freedom = input.degrees_of_freedom().min(1e9);
                StudentsT::new(0.0, 1.0, freedom).unwrap().cdf(x)
            }
        }
    }

    #[test]
    fn draws_have_the_distribution_of_the_input() {
        let of_shape = |shape| Input::new(0.0, 1.0, shape).unwrap();
        let others = &Distribution::ALL[..4];
        let mut inputs: Vec<_> = others.iter().map(|&shape| of_shape(shape)).collect();
        // Both are one statement: 3.5 degrees of freedom of a normal input make a t.
        for shape in [Distribution::StudentT, Distribution::Normal] {
            let with = |freedom| of_shape(shape).with_degrees_of_freedom(freedom).unwrap();
            inputs.extend([3.5, f64::INFINITY].map(with));
        }
        for input in inputs {
            let mut random = stream(1, 0);
            let mut samples: Vec<f64> = (0..20_000).map(|_| input.draw(&mut random)).collect();
            let p = kolmogorov_smirnov(&mut samples, |x| cumulative(&input, x));
            // Eight tests of one seed.
            assert!(p > 1e-3, "{}: {p}", input.distribution());
        }
    }

    #[test]
    fn a_t_distribution_is_wider_than_its_scale_says() {
        let input = Input::new(0.0, 2.0, Distribution::StudentT).unwrap();
        for (freedom, expected) in [(18.0, 2.0 * 1.125_f64.sqrt()), (f64::INFINITY, 2.0)] {
            let found = input
                .with_degrees_of_freedom(freedom)
                .unwrap()
                .standard_deviation();
            assert!((found - expected).abs() < 1e-15, "{freedom}: {found}");
        }
    }

    #[test]
    fn impossible_inputs_are_refused() {
        let new = |estimate, uncertainty, freedom| {
            Input::new(estimate, uncertainty, Distribution::Normal)?
                .with_degrees_of_freedom(freedom)
        };
        refuses!(estimate = 0.0, uncertainty = 1.0, degrees_of_freedom = 1.0
            => new(estimate, uncertainty, degrees_of_freedom);
            estimate: [f64::NAN, f64::INFINITY],
            uncertainty: [0.0, -1.0, f64::NAN, f64::INFINITY],
            degrees_of_freedom: [0.5, f64::NAN],
        );
    }
}
