//! Formulas as Bergmann et al. 2016 print them, each with the size of its error.
//!
//! The rest of the crate does not use them. They are here to reproduce that paper's figures and to
//! lay the difference beside them.
//!
//! | printed | here | what is wrong |
//! |---|---|---|
//! | eq. (3) | [`radiance`] | a plane tilted by θ receives `P / cos θ` |
//! | §4, x′ of a laser fan | [`PrintedFan`] | not normalised: power `P T z / w` |
//! | §4 step 3, `w_A / w_R` | [`streamline_point`] | right for energy, up to one divergence off as a ray |
//! | §4 steps 1–4 | [`spot_next_event`], [`line_next_event`] | all of the above |
//! | §4, θ′ | [`modified_divergence`] | nothing; it loses [`lost_by_cone`] of the power |
//! | §4, disc × cone | [`DiscConeSampler`] | the weight has the unit W·sr, and light is lost |
//!
//! # References
//!
//! - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
//!   Speckle into a Physically-Based Renderer*, VMV 2016, section 4.

mod cone;
mod fan;
mod next_event;

pub use cone::{DiscConeRay, DiscConeSampler, lost_by_cone, lost_by_fan_cone, modified_divergence};
pub use fan::PrintedFan;
pub use next_event::{PrintedEvent, line_next_event, radiance, spot_next_event, streamline_point};
