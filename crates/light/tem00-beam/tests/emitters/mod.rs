//! What renderers ask of a light, over all lights: densities of rays, rays that materials draw, power
//! in boxes.
//!
//! All seeds are fixed.

mod boxes;
mod densities;
mod hits;
mod lights;
