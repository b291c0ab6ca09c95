//! Beams through systems, and what is refused.

mod q_law;
mod refusals;
