//! Shared helpers of the tests: tables of refusals, hostile bytes, p-values, tolerances, random
//! numbers, pools of threads.
//!
//! The crate knows no other crate of the workspace, so that the lowest of them can use it.

#![expect(
    clippy::missing_panics_doc,
    clippy::cast_possible_truncation,
    reason = "helpers of tests panic, over few samples"
)]

mod close;
mod numbers;
mod p_value;
mod refusal;
mod robust;
mod rows;
mod threads;

pub use close::{assert_absolute, assert_relative, correlation};
pub use numbers::Numbers;
pub use p_value::{chi_squared, chi_squared_survival, kolmogorov_smirnov};
pub use refusal::{assert_accepted, assert_refused};
pub use robust::robust;
pub use rows::rows;
pub use threads::on_threads;
