//! Tests of hypotheses about samples and images.

pub use crate::hypothesis::{
    goodness::GoodnessOfFit,
    grey_levels::GreyLevels,
    samples::{TestOutcome, chi_squared, kolmogorov_smirnov, t_test_mean},
};
