//! The law of motion against exact paths, and what is refused.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod exact_paths;
mod finite_motion;
mod refusals;
