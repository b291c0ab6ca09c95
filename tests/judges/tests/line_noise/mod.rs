//! Displacement of a laser line by speckle: rendered frames and wave optics against the closed forms.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

#[expect(dead_code, reason = "other programs look at more of the images")]
#[path = "../../../../examples/line_image/mod.rs"]
mod line_image;
mod rendered_lines;

mod budget;
mod patterns;
mod rendered;
mod waves;
