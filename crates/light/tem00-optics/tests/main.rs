//! Beams through systems, and what is refused.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod q_law;
mod refusals;
