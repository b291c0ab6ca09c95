#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - A model takes the values of all inputs, in their order and in any units, and returns one
//!   number.
//! - Uncertainties are *standard* uncertainties: for bounded distributions the half-width is
//!   [`Distribution::half_width`] times the standard uncertainty, for a scaled and shifted t the
//!   standard uncertainty is the scale.
//! - Positions of inputs count from 0.
//! - Same seed, same bits, for any number of threads.
//!
//! # Main items
//!
//! - What is known: [`Input`], [`Distribution`], [`Inputs`], [`Correlation`].
//! - [`FirstOrder`]: the law of propagation of uncertainty, [`coverage_factor`],
//!   [`effective_degrees_of_freedom`].
//! - [`Propagation`]: trials until their results are stable; [`CoverageInterval`], [`Validation`].
//! - [`Decomposition`]: the fraction of the variance that each input contributes.
//!
//! # Scope and non-goals
//!
//! One result of a model that is a function of its inputs. Correlations hold between normal
//! quantities, the only ones for which JCGM 101 states a joint distribution (§ 6.4.8). Models of
//! several results (JCGM 102), models that are implicit, and second-order terms of the law of
//! propagation are left out: trials need none.

mod coverage;
mod decomposition;
mod derivative;
mod distribution;
mod error;
mod first_order;
mod input;
mod inputs;
mod interval;
mod moments;
mod propagation;
mod trials;

pub use coverage::{CoverageProbability, coverage_factor, effective_degrees_of_freedom};
pub use decomposition::{Decomposition, DecompositionOptions, SobolIndex, VarianceParts};
pub use distribution::Distribution;
pub use error::UncertaintyError;
pub use first_order::{Contribution, FirstOrder};
pub use input::Input;
pub use inputs::{Correlation, Inputs};
pub use interval::{CoverageInterval, IntervalKind};
pub use propagation::{Propagation, PropagationOptions, Validation};

/// The refusal of a number.
pub use tem00_numerics::Refusal;
