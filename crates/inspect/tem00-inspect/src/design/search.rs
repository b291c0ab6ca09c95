//! A search among set-ups.

use std::path::Path;

use tem00_report::{failure::Failure, interrupt, progress::Progress};
use tem00_triangulation::{
    Candidate, DesignFigure, DesignOutcome, DesignSearch, Setup, TriangulationError,
};

use crate::args::DesignArgs;

/// A completed search.
pub(super) struct Design<'a> {
    /// The file that it was read from, and its text.
    pub(super) file: &'a Path,
    pub(super) text: String,
    pub(super) search: DesignSearch,
    pub(super) outcome: DesignOutcome,
    /// No quantity of the set-up is uncertain.
    pub(super) is_exact: bool,
    /// The maximum number of set-ups that are listed.
    pub(super) listed: usize,
}

impl<'a> Design<'a> {
    /// Returns whether the part lets light in.
    pub(super) fn lets_light_in(&self) -> bool {
        let base = &self.search.question().base;
        base.surface.subsurface.lets_light_in()
    }

    pub(super) fn search(
        args: &'a DesignArgs,
        search: DesignSearch,
        text: String,
    ) -> Result<Self, Failure> {
        let bar = Progress::of(search.count() as u64, "set-ups");
        bar.name("searching".into());
        let outcome = search
            .run(&|done| bar.advance(done), interrupt::flag())
            .map_err(|error| match error {
                TriangulationError::Cancelled => Failure::Interrupted,
                error => Failure::running(error.to_string()),
            })?;
        Ok(Self {
            file: &args.common.setup,
            text,
            search,
            outcome,
            is_exact: true,
            listed: args.best.into(),
        })
    }

    /// Returns the best set-up that keeps every constraint.
    pub(super) fn winner(&self) -> Option<&Candidate> {
        self.outcome.best(1).into_iter().next()
    }

    /// Returns the best set-up, or the nearest if none keeps every constraint; `None` if none is
    /// possible.
    pub(super) fn shown(&self) -> Option<&Candidate> {
        self.winner().or_else(|| self.outcome.nearest())
    }

    /// Returns a set-up, with the exposure that its light gives if it is chosen automatically.
    pub(super) fn setup_of(shown: &Candidate) -> Result<Setup, Failure> {
        Setup::new(shown.description.clone()).map_err(|error| Failure::running(error.to_string()))
    }

    /// Returns the figure that is minimised.
    pub(super) fn objective(&self) -> DesignFigure {
        self.search.question().objective.figure()
    }
}
