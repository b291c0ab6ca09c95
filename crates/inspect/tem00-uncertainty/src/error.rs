use core::{error, fmt};

use tem00_numerics::{Refusal, Shown};

use crate::Distribution;

/// Reasons why an uncertainty is refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum UncertaintyError {
    /// A number is outside its range.
    Refused(Refusal),
    /// A model without inputs has no uncertainty.
    NoInputs,
    /// A correlation is not between two different inputs.
    Between {
        /// The positions that were given.
        between: [usize; 2],
        /// The number of inputs.
        inputs: usize,
    },
    /// A correlation is given twice.
    Repeated {
        /// The positions of both inputs.
        between: [usize; 2],
    },
    /// A correlated input is not normal, or its standard uncertainty is not exactly known.
    NotNormal {
        /// The position of the input.
        input: usize,
    },
    /// No quantities have these correlations: their matrix is not positive semi-definite.
    Contradiction {
        /// The position of the first input whose correlations contradict the correlations of the
        /// inputs before.
        input: usize,
    },
    /// The model has no finite value.
    NotFinite {
        /// The returned value.
        value: f64,
        /// The values of the inputs.
        inputs: Vec<f64>,
    },
    /// The distribution of an input reaches values that are not possible.
    ImpossibleDraw {
        /// The position of the input.
        input: usize,
        /// Its distribution.
        distribution: Distribution,
        /// The drawn value, at which the model is not finite even if all others are as estimated.
        value: f64,
    },
    /// Differences over ever smaller steps do not settle on a derivative.
    NotDifferentiable {
        /// The position of the input.
        input: usize,
        /// Uncertainty of the differences, relative to the largest contribution.
        open: f64,
    },
    /// The variance is decomposed for independent inputs only.
    Correlated,
}

impl UncertaintyError {
    /// Returns the name of the argument that was refused.
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::Refused(refusal) => refusal.parameter,
            Self::NoInputs | Self::Correlated => "inputs",
            Self::Between { .. } | Self::Repeated { .. } => "between",
            Self::NotNormal { .. } | Self::ImpossibleDraw { .. } => "distribution",
            Self::Contradiction { .. } => "coefficient",
            Self::NotFinite { .. } | Self::NotDifferentiable { .. } => "model",
        }
    }
}

impl fmt::Display for UncertaintyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::NoInputs => write!(f, "inputs must number at least one, got none"),
            Self::Between {
                between: [first, second],
                inputs,
            } => write!(
                f,
                "between must be the positions of two different ones of {inputs} inputs, got \
                 {first} and {second}"
            ),
            Self::Repeated {
                between: [first, second],
            } => write!(
                f,
                "between must name two inputs once, got {first} and {second} a second time"
            ),
            Self::NotNormal { input } => write!(
                f,
                "distribution of correlated inputs must be normal with infinite degrees of \
                 freedom, that of input {input} is not"
            ),
            Self::Contradiction { input } => write!(
                f,
                "coefficient must be such that the matrix of all is positive semi-definite; those \
                 of input {input} contradict the ones before"
            ),
            Self::NotFinite { value, inputs } => {
                write!(f, "model must be finite, got {value} at")?;
                inputs.iter().try_for_each(|x| write!(f, " {}", Shown(*x)))
            }
            Self::ImpossibleDraw {
                input,
                distribution,
                value,
            } => write!(
                f,
                "distribution of input {input} must reach possible values only: it is \
                 {distribution} and draws {}, where the model is not finite",
                Shown(*value)
            ),
            Self::NotDifferentiable { input, open } => write!(
                f,
                "model must be smooth within a twentieth of the standard uncertainty of input \
                 {input}; its differences leave {open:.1e} of the largest contribution open, \
                 allowed are 1e-6"
            ),
            Self::Correlated => write!(
                f,
                "inputs must be independent, for correlated ones have no parts of the variance"
            ),
        }
    }
}

impl error::Error for UncertaintyError {}

impl From<Refusal> for UncertaintyError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}
