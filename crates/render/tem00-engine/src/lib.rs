#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Lengths are in metres, powers in watts, radiances in W/(m² sr), all in `f64`; images are
//!   `f32`.
//! - Image points are in pixels, x to the right and y down; the image is upright.
//! - One frame, the first by default, is the reference frame: the speckle of the other frames has
//!   moved and changed since then.
//! - The same seed gives the same bits for any number of threads.

mod inspection;
mod integrator;
mod light_tracer;
mod render;
mod sampler;
mod speckle;
mod survey;
#[cfg(test)]
mod testing;
mod vertex;
mod walk;

pub use inspection::{LaserInspection, LightFate, LightPart, inspect_lasers};
pub use light_tracer::has_specular_surfaces_on_both_sides;
pub use render::{render_frame, samples_per_frame};
pub use sampler::mean_over_sample_displacements;
pub use speckle::{
    CascadeNote, CorrelationNote, FollowedPoint, PatternPlan, RoughnessNote, SpeckleChange,
    SpeckleModel, SpecklePlan, roughness_notes,
};
pub use survey::cascade_notes;
