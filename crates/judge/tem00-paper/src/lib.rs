#![doc = include_str!("../README.md")]
//!
//! # Printed and correct
//!
//! | printed | here | instead of | what is wrong |
//! |---|---|---|---|
//! | eq. (3) | [`radiance`] | [`Emitter::next_event`](tem00_beam::Emitter::next_event) | a plane tilted by θ receives `P / cos θ` |
//! | §4, x′ of a laser fan | [`PrintedFan`] | [`LaserLine`](tem00_beam::LaserLine) | not normalised: power `P T z / w` |
//! | §4 step 3, `w_A / w_R` | [`streamline_point`] | `Emitter::next_event` | right for energy, up to one divergence off as a ray |
//! | §4 steps 1–4 | [`spot_next_event`], [`line_next_event`] | `Emitter::next_event` | all of the above |
//! | §4, θ′ and disc × cone | tests alone | [`Emitter::sample_ray`](tem00_beam::Emitter::sample_ray) | the weight has the unit W·sr, and light is lost |
//! | §6.3, bilinear intensity | [`BilinearStack`] | [`SpeckleStack`](tem00_speckle::SpeckleStack) | contrast 0.757 half-way between samples at a speckle size of 2 |
//! | §6.4, linear blend of slices | [`BilinearStack`] | `SpeckleStack` | contrast 0.885 half-way between 2M = 16 slices |
//! | §6.3 and §6.4, wraps at Q − 1 and 2M − 1 | [`BilinearStack`] | `SpeckleStack` | a jump in the pattern and in time |
//!
//! For the errors on moving speckle the last column gives the worst values, printed and correct:
//!
//! | printed | here | instead of | printed, correct |
//! |---|---|---|---|
//! | eq. (5) | [`image_displacement`] | [`SpeckleMotion`], image displacement | 200 %: the wrong way for motion along the normal |
//! | `a_P^S`, §6.4 | [`pupil_displacement`] | [`Configuration::pupil_point_after`] | none on the optical axis; off it, 0 instead of −tan of the angle, times `a_z` |
//! | `d_SL`, §6.4 | [`Emitter`] | [`Wavefront`] | any factor, and the sign, in a Gaussian beam or a fan |
//! | `a_P^C + a_P^S`, §6.4 | [`relative_pupil_displacement`] | [`RigidMotions`] | twice `a_P^C` instead of 0, unless that is *minus* the camera motion |
//! | `d_z⁰`, §6.4 | [`axial_decorrelation_length`] | [`ImagingGeometry::axial_decorrelation_length`] | a factor of 2; γ = 0.405 is left |
//! | u in the plane, §6.4 | [`slice_coordinate`] | [`SpeckleStack::coordinate_of`](tem00_speckle::SpeckleStack::coordinate_of) of the correlation | γ = 0.236, 0.431 at 0.27 D |
//! | u along the axis | the same | the same | γ = 0.067, 0.856 at 0.43 `d_z⁰` |
//! | u, both opposed | the same | the same | γ = 1, 0 |
//! | u past M | the same | the same | γ = 1, 0 |
//! | c, §6.3 | [`pattern_coordinate`] | [`ImagingGeometry::pattern_coordinate`] | the pattern runs backwards |
//!
//! The example `paper_errors` of the workspace computes these numbers. Vectors are in *surface
//! coordinates* n1, n2, n3, with n3 the normal; [`EulerAngles::between`] provides them.
//!
//! # References
//!
//! - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
//!   Speckle into a Physically-Based Renderer*, VMV 2016, sections 4 and 6.
//!
//! [`SpeckleMotion`]: tem00_decorrelation::SpeckleMotion
//! [`Configuration::pupil_point_after`]: tem00_decorrelation::Configuration::pupil_point_after
//! [`RigidMotions`]: tem00_decorrelation::RigidMotions
//! [`Wavefront`]: tem00_decorrelation::Wavefront
//! [`ImagingGeometry::axial_decorrelation_length`]: tem00_decorrelation::ImagingGeometry::axial_decorrelation_length
//! [`ImagingGeometry::pattern_coordinate`]: tem00_decorrelation::ImagingGeometry::pattern_coordinate

mod fan;
mod look_up;
mod motion;
mod next_event;
#[cfg(test)]
mod tests;

pub use fan::PrintedFan;
pub use look_up::BilinearStack;
pub use motion::{
    Emitter, EulerAngles, axial_decorrelation_length, image_displacement, pattern_coordinate,
    pupil_displacement, relative_pupil_displacement, slice_coordinate,
};
pub use next_event::{PrintedEvent, line_next_event, radiance, spot_next_event, streamline_point};
