//! Motion and decorrelation of speckle, judged by wave optics from first principles.
//!
//! The judge sums the waves of thousands of scatterers with exact distances, moves surface, camera
//! and source as rigid bodies, and measures what happened to the pattern. It knows nothing of
//! wavefront curvatures, stationary phases, pupil overlaps or lines of sight.

mod correlation;
pub(crate) mod finite;
pub(crate) mod geometries;
pub(crate) mod image;
mod pupil;
pub(crate) mod scene;
