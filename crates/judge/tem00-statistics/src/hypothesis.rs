//! Tests of hypotheses.

pub(crate) mod goodness;
pub(crate) mod grey_levels;
pub(crate) mod samples;
