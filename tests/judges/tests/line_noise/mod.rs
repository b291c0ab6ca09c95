//! Displacement of a laser line by speckle: rendered frames and wave optics against the closed forms.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

mod rendered_lines;

mod budget;
mod patterns;
mod rendered;
mod waves;
