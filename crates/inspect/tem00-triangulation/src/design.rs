//! The search for the best set-up: which lens, angle, line and exposure give the least uncertainty.

mod constraint;
mod figures;
mod front;
mod outcome;
mod sensitivity;
mod sweep;
#[cfg(test)]
mod tests;

use core::sync::atomic::{AtomicBool, Ordering};

use tem00_numerics::{Refusal, check, parallel};

pub use self::{
    constraint::{Constraint, DesignFigure},
    figures::DesignFigures,
    front::pareto_front,
    outcome::{Candidate, DesignOutcome, Exclusion},
    sensitivity::{Neighbours, neighbours},
    sweep::{Spacing, Sweep},
};
use crate::{SetupDescription, TriangulationError};

/// Figure that a search makes as small as possible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// The combined standard uncertainty of a height.
    #[default]
    Uncertainty,
    /// The expanded uncertainty of a height.
    ExpandedUncertainty,
}

impl Objective {
    /// Returns the figure that is minimised.
    pub const fn figure(self) -> DesignFigure {
        match self {
            Self::Uncertainty => DesignFigure::Uncertainty,
            Self::ExpandedUncertainty => DesignFigure::ExpandedUncertainty,
        }
    }
}

/// Task of a search: a set-up, the varied parameters, the constraints and the objective.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignQuestion {
    /// The set-up to begin with: quantities that are not varied keep their values.
    pub base: SetupDescription,
    /// The varied parameters. The last one varies fastest.
    pub sweeps: Vec<Sweep>,
    /// The constraints that a set-up must keep.
    pub constraints: Vec<Constraint>,
    /// The figure that is minimised.
    pub objective: Objective,
    /// The maximum number of set-ups that may be tried.
    pub max_setups: usize,
}

/// A search among all combinations of the values of some parameters.
///
/// # What pulls which way
///
/// The pupil decides between depth of field and noise. With the f-number F the speckle size
/// `h = λ F (1 + m)` grows, and with it the noise of a line that is much wider than a speckle:
///
/// ```text
/// speckle   σ = √(w ℓ / (8√π)) / (m sin θ)   ∝ √F for rows finer than a speckle (ℓ = 32 h / 3π²),
///                                            ∝  F for rows that hold many (ℓ = 4 h² / (π p))
/// shot      σ = (w / 2) / √N / (m sin θ)     ∝  F, the light falls as 1 / F²
/// depth of field, from D |Δz| = f |Δz| / F   ∝  F
/// ```
///
/// so that a smaller pupil buys depth with noise, by speckle and by shot noise alike.
///
/// # Validity
///
/// Uncertainties come from the first-order budget on the reference plane; within the depth of field
/// they grow by the widening of line and image there, √2 at most each.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSearch {
    question: DesignQuestion,
    count: usize,
}

impl DesignSearch {
    /// The maximum number of set-ups that any search may try.
    pub const MAX_SETUPS: usize = 200_000;

    /// Creates a search.
    ///
    /// # Errors
    ///
    /// Returns an error if nothing is varied, if something is varied twice, if a bound is not
    /// positive and finite, or if there are more combinations than are allowed.
    pub fn new(question: DesignQuestion) -> Result<Self, TriangulationError> {
        let DesignQuestion {
            sweeps,
            constraints,
            max_setups,
            ..
        } = &question;
        check_sweeps(sweeps)?;
        for &Constraint { figure, bound } in constraints {
            let holds = bound > 0.0 && bound.is_finite();
            let allowed = "a bound that is positive and finite";
            check::that(holds, figure.name(), bound, "", allowed)?;
        }
        let max = (*max_setups).min(Self::MAX_SETUPS);
        let product = |count: usize, sweep: &Sweep| count.checked_mul(sweep.values().len());
        let count = sweeps.iter().try_fold(1, product);
        match count.filter(|&count| count <= max) {
            Some(count) => Ok(Self { question, count }),
            None => Err(too_many(sweeps)),
        }
    }

    /// Returns the question that the search was created from.
    pub const fn question(&self) -> &DesignQuestion {
        &self.question
    }

    /// Returns the number of combinations.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the set-up of a combination, whether or not it is possible; combinations are counted
    /// from 0, the last parameter fastest.
    ///
    /// # Panics
    ///
    /// Panics unless `index < self.count()`.
    pub fn description(&self, index: usize) -> SetupDescription {
        assert!(index < self.count, "{index} < {}", self.count);
        let mut rest = index;
        let mut description = self.question.base.clone();
        for sweep in self.question.sweeps.iter().rev() {
            let values = sweep.values();
            let value = values[rest % values.len()];
            sweep.parameter().set(&mut description, value);
            rest /= values.len();
        }
        description
    }

    /// Tries all combinations, on all threads of the current pool.
    ///
    /// `progress` receives, from any thread, the number of set-ups done since its last call. The
    /// outcome is the same, bit by bit, for any number of threads.
    ///
    /// # Errors
    ///
    /// Returns [`TriangulationError::Cancelled`] if `cancel` was set before the end. A set-up that
    /// is not possible is part of the outcome.
    pub fn run(
        &self,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<DesignOutcome, TriangulationError> {
        let attempt = |index: usize| {
            if cancel.load(Ordering::Relaxed) {
                return Err(TriangulationError::Cancelled);
            }
            let candidate = self.candidate(index);
            progress(1);
            Ok(candidate)
        };
        let candidates = parallel::map(self.count, attempt);
        let candidates: Result<Vec<_>, _> = candidates.into_iter().collect();
        let constraints = self.question.constraints.clone();
        let objective = self.question.objective.figure();
        Ok(DesignOutcome::new(candidates?, constraints, objective))
    }

    fn candidate(&self, index: usize) -> Candidate {
        let description = self.description(index);
        let figures = DesignFigures::evaluate(&description);
        let broken = |figures: &DesignFigures| {
            let mut constraints = self.question.constraints.clone();
            constraints.retain(|constraint| !constraint.is_kept(figures));
            constraints
        };
        let broken = figures.as_ref().map(broken).unwrap_or_default();
        Candidate {
            index,
            description,
            figures,
            broken,
        }
    }
}

fn check_sweeps(sweeps: &[Sweep]) -> Result<(), TriangulationError> {
    if sweeps.is_empty() {
        return Err(TriangulationError::TooFew {
            what: "parameters that are varied",
            got: 0,
            needed: 1,
        });
    }
    for (index, sweep) in sweeps.iter().enumerate() {
        let is_same = |other: &Sweep| other.parameter() == sweep.parameter();
        let twice = sweeps[..index].iter().any(is_same);
        check::that(!twice, sweep.parameter().key(), "twice", "", "varied once")?;
    }
    Ok(())
}

fn too_many(sweeps: &[Sweep]) -> TriangulationError {
    let counts = sweeps.iter().map(|sweep| sweep.values().len() as f64);
    let allowed = "at least the number of combinations, and at most 200000; try fewer steps";
    Refusal::new("max_setups", counts.product::<f64>(), allowed).into()
}
