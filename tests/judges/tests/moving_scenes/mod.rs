//! Speckle of bodies that move and turn, measured in rendered frames: where it goes, what is left of
//! it, what is uncovered, and sums of patterns.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

mod background;
mod bodies;
mod sequences;
mod setting;
mod sums;
mod wave;
