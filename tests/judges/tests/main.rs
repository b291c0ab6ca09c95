//! Slow tests across crates: waves, trials and whole renders judge the laws.

#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod budget_trials;
mod characteristics;
mod coherence;
mod edges_and_colour;
mod interval_coverage;
#[path = "../../../examples/line_image/mod.rs"]
mod line_image;
mod line_noise;
#[path = "../../means.rs"]
mod means;
mod moving_scenes;
mod reference_and_engine;
#[path = "../../renders.rs"]
mod renders;
mod step_height;
mod tilted_sensors;
mod translucence;
mod two_estimators;
mod wave_judges_decorrelation;
mod wave_judges_speckle;
