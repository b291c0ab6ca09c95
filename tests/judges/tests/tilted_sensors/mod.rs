//! Statements of a scan about the speckle on tilted sensors, against the frames that it renders:
//! how wide speckle is, where it goes from frame to frame, what is left of it, and how it
//! correlates the places of a line.

mod places;
mod setting;
mod speckle;
