//! Tests across crates. The slow ones are in `judges`.

mod closed_form_scenes;
mod defocused_speckle;
mod example_tables;
mod host_and_tracer;
mod rendered_spot;
mod rings;
mod shaders;
mod speckle;
mod stated_correlations;
mod tracer;
