//! Sums of waves, through the face that other tests see.

mod known_speckle;
mod refusals;
