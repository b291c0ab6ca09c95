//! Tests of placed lights, through the face that a renderer sees.

#![expect(clippy::expect_used, clippy::unwrap_used, reason = "helpers of tests")]

mod closed_forms;
mod emitters;
mod lights;
mod phase_space;
mod power_on_surfaces;
mod refusals;
