//! The reference tracer on scenes that are written as text: estimators against closed forms, the
//! film, edge cases and what becomes of the light of a laser.

mod edge_cases;
mod inspection;
mod integrator;
mod render;
