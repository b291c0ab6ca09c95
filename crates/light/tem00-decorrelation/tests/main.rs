//! The law of motion against exact paths, and what is refused.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod paths;
mod refusals;
