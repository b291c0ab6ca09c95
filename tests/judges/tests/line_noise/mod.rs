//! Displacement of a laser line by speckle: rendered frames and wave optics against the closed forms.

mod rendered_lines;

mod budget;
mod patterns;
mod rendered;
mod waves;
