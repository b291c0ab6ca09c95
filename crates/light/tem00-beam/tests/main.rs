//! Tests of placed lights, through the face that a renderer sees.

mod closed_forms;
mod emitters;
mod lines;
mod phase_space;
mod power_on_surfaces;
mod refusals;
