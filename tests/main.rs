//! Tests across crates. The slow ones are in `judges`.

#![expect(
    clippy::expect_used,
    clippy::missing_assert_message,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod closed_form_scenes;
mod defocused_speckle;
mod example_tables;
mod host_and_tracer;
mod means;
mod rendered_spot;
mod renders;
mod rings;
mod speckle;
mod stated_correlations;
mod tracer;
