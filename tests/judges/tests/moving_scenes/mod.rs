//! Speckle of bodies that move and turn, measured in rendered frames: where it goes, what is left
//! of it, what is uncovered, and sums of patterns.

mod background;
mod bodies;
mod focus;
mod sequences;
mod setting;
mod sums;
mod wave;
