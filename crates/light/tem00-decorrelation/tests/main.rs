//! The law of motion against exact paths, and what is refused.

mod exact_paths;
mod finite_motion;
mod refusals;
