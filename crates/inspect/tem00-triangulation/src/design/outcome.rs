use super::{Constraint, DesignFigure, DesignFigures, pareto_front};
use crate::{SetupDescription, TriangulationError};

/// A set-up that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The number of the combination, counted from 0.
    pub index: usize,
    /// The set-up.
    pub description: SetupDescription,
    /// Its figures, or the reason why it is not possible.
    pub figures: Result<DesignFigures, TriangulationError>,
    /// The constraints that it breaks; none if it is not possible.
    pub broken: Vec<Constraint>,
}

impl Candidate {
    /// Returns the figures if the set-up is possible and keeps every constraint.
    pub fn allowed(&self) -> Option<&DesignFigures> {
        self.possible().filter(|_| self.broken.is_empty())
    }

    /// Returns the figures if the set-up is possible.
    pub fn possible(&self) -> Option<&DesignFigures> {
        self.figures.as_ref().ok()
    }
}

/// Rounds to three significant digits, one more than uncertainties are stated with.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Numbers of set-ups that a constraint excludes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exclusion {
    /// The constraint.
    pub constraint: Constraint,
    /// The number of possible set-ups that break it.
    pub excluded: usize,
    /// The number of these that break no other constraint: without it they would be allowed.
    pub alone: usize,
}

/// Result of a search: all set-ups that it tried.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignOutcome {
    candidates: Vec<Candidate>,
    constraints: Vec<Constraint>,
    objective: DesignFigure,
}

impl DesignOutcome {
    pub(super) const fn new(
        candidates: Vec<Candidate>,
        constraints: Vec<Constraint>,
        objective: DesignFigure,
    ) -> Self {
        Self {
            candidates,
            constraints,
            objective,
        }
    }

    /// Returns all set-ups, in the order of their numbers.
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// Returns the number of set-ups that are possible, and the number of set-ups that keep every
    /// constraint.
    pub fn counts(&self) -> (usize, usize) {
        let possible = self.candidates.iter().filter_map(Candidate::possible);
        let allowed = self.candidates.iter().filter_map(Candidate::allowed);
        (possible.count(), allowed.count())
    }

    /// Returns the best set-ups that keep every constraint, at most `count`, the best first.
    ///
    /// Set-ups whose objectives agree in three digits are as good as each other: of these the one
    /// whose bright grains fill less of the sensor comes first, then the one that was tried first.
    pub fn best(&self, count: usize) -> Vec<&Candidate> {
        let allowed = self.candidates.iter();
        let mut allowed: Vec<_> = allowed
            .filter_map(|candidate| {
                let figures = candidate.allowed()?;
                let objective = three_digits(self.objective.value_in(figures));
                Some((candidate, [objective, figures.grain_saturation]))
            })
            .collect();
        allowed.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        allowed.truncate(count);
        allowed
            .into_iter()
            .map(|(candidate, _)| candidate)
            .collect()
    }

    /// Returns the set-ups that no other set-up improves in both the objective and a figure: a gain
    /// in one costs some of the other. They are taken from the set-ups that keep every constraint,
    /// or, if there are none, from all that are possible, and come in the order of the objective.
    pub fn front(&self, against: DesignFigure) -> Vec<&Candidate> {
        let (_, allowed) = self.counts();
        let entered = |candidate: &&Candidate| match allowed {
            0 => candidate.possible().is_some(),
            _ => candidate.allowed().is_some(),
        };
        let entered: Vec<_> = self.candidates.iter().filter(entered).collect();
        let sign = if against.is_gain() { 1.0 } else { -1.0 };
        let point = |figures: &DesignFigures| {
            [
                self.objective.value_in(figures),
                sign * against.value_in(figures),
            ]
        };
        let points: Vec<_> = entered
            .iter()
            .filter_map(|candidate| candidate.possible().map(point))
            .collect();
        let front = pareto_front(&points);
        front.into_iter().map(|index| entered[index]).collect()
    }

    /// Returns the exclusions by each constraint, the one that excludes most first.
    pub fn exclusions(&self) -> Vec<Exclusion> {
        let breaking = |constraint: &Constraint| {
            let candidates = self.candidates.iter();
            candidates
                .filter(|candidate| candidate.broken.contains(constraint))
                .map(|candidate| candidate.broken.len())
                .collect::<Vec<_>>()
        };
        let exclusion = |&constraint: &Constraint| {
            let broken = breaking(&constraint);
            Exclusion {
                constraint,
                excluded: broken.len(),
                alone: broken.iter().filter(|&&count| count == 1).count(),
            }
        };
        let mut exclusions: Vec<_> = self.constraints.iter().map(exclusion).collect();
        exclusions.sort_by_key(|exclusion| core::cmp::Reverse(exclusion.excluded));
        exclusions
    }

    /// Returns the possible set-up that misses the constraints by least, by the sum of the
    /// fractions of each bound by which it is missed; of equal set-ups the better one, then the one
    /// that was tried first.
    pub fn nearest(&self) -> Option<&Candidate> {
        let missed = |figures: &DesignFigures| -> f64 {
            let excess = |constraint: &Constraint| constraint.excess(figures);
            self.constraints.iter().map(excess).sum()
        };
        let keyed = self.candidates.iter().filter_map(|candidate| {
            let figures = candidate.possible()?;
            Some((missed(figures), self.objective.value_in(figures), candidate))
        });
        keyed
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)))
            .map(|(.., candidate)| candidate)
    }
}
