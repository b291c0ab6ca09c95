//! Displacement of a laser line by speckle: rendered frames and wave optics against the closed
//! forms.

mod line_by_waves;
mod rendered_lines;

mod budget;
mod rendered;
mod waves;
