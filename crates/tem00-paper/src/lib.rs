//! The formulas of Bergmann et al. 2016 as printed, where they differ from those of the other crates
//! or are a special case of them.
//!
//! They reproduce the figures of that paper and show what the difference amounts to; `tem00 render
//! --paper` renders with them. Nothing else uses them.
//!
//! | printed | here | instead of | what is wrong |
//! |---|---|---|---|
//! | eq. (3) | [`radiance`] | [`Emitter::next_event`](tem00_beam::Emitter::next_event) | a plane tilted by θ receives `P / cos θ` |
//! | §4, x′ of a laser fan | [`PrintedFan`] | [`LaserLine`](tem00_beam::LaserLine) | not normalised: power `P T z / w` |
//! | §4 step 3, `w_A / w_R` | [`streamline_point`] | `Emitter::next_event` | right for energy, up to one divergence off as a ray |
//! | §4 steps 1–4 | [`spot_next_event`], [`line_next_event`] | `Emitter::next_event` | all of the above |
//! | §4, θ′ | [`modified_divergence`] | [`Emitter::sample_ray`](tem00_beam::Emitter::sample_ray) | nothing; the cone loses the fraction l of the power |
//! | §4, disc × cone | [`DiscConeSampler`] | `Emitter::sample_ray` | the weight has the unit W·sr, and light is lost |
//! | §6.3, bilinear intensity | [`BilinearStack`] | [`SpeckleStack`](tem00_speckle::SpeckleStack) | contrast 0.757 half-way between samples at a speckle size of 2 |
//! | §6.4, linear blend of slices | [`BilinearStack`] | `SpeckleStack` | contrast 0.885 half-way between 2M = 16 slices |
//! | §6.3 and §6.4, wraps at Q − 1 and 2M − 1 | [`BilinearStack`] | `SpeckleStack` | a jump in the pattern and in time |
//!
//! Of those on moving speckle the last column has the worst values, printed and correct:
//!
//! | printed | here | instead of | printed, correct |
//! |---|---|---|---|
//! | eq. (5) | [`image_displacement`] | [`SurfacePoint::image_displacement`] | 200 %: the wrong way for motion along the normal |
//! | `a_P^S`, §6.4 | [`pupil_displacement`] | [`SurfacePoint::pupil_displacement`] | none on the optical axis; off it, 0 instead of −tan of the angle, times `a_z` |
//! | `d_SL`, §6.4 | [`Emitter`] | [`Wavefront`] | any factor, and the sign, in a Gaussian beam or a fan |
//! | `a_P^C + a_P^S`, §6.4 | [`relative_pupil_displacement`] | [`Motion`] | twice `a_P^C` instead of 0, unless that is *minus* the camera motion |
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
//! # Examples
//!
//! The look-up of the paper from end to end, for a surface that moves by 0.1 mm along x under a
//! camera tilted by 45° and a laser emitter 0.5 m above:
//!
//! ```
//! use tem00_decorrelation::{CameraFrame, DVec2, DVec3, ImagingGeometry, LensData};
//! use tem00_paper::{self as paper, Emitter, EulerAngles};
//!
//! let geometry = ImagingGeometry::from_lens(LensData {
//!     wavelength: 650e-9,
//!     focal_length: 25e-3,
//!     f_number: 8.0,
//!     surface_to_pupil: 0.3,
//!     pixel_pitch: 3.45e-6,
//! })?;
//! let camera = CameraFrame::look_at(DVec3::new(1.0, 0.0, 1.0), DVec3::ZERO, DVec3::Y)?;
//! let (surface_axes, angles) = EulerAngles::between(&camera, DVec3::Z).expect("a normal");
//! let to_surface = surface_axes.transpose();
//! let a = to_surface * DVec3::new(0.1e-3, 0.0, 0.0);
//! let emitter = Emitter { direction: to_surface * DVec3::Z, distance: 0.5 };
//!
//! let on_sensor = paper::image_displacement(geometry.magnification(), angles, a);
//! let in_pupil = paper::pupil_displacement(angles, emitter, 0.3, a).unwrap_or(DVec2::ZERO);
//! let (pixel, h_p, half_period) = (DVec2::new(320.0, 240.0), 4.0, 16);
//! let c = paper::pattern_coordinate(&geometry, pixel, on_sensor, h_p);
//! let u = paper::slice_coordinate(&geometry, in_pupil, 0.0, half_period);
//!
//! assert!((c - DVec2::new(773.9, 583.9)).length() < 0.1);
//! assert!((u - 0.796).abs() < 1e-3);
//! # Ok::<(), tem00_decorrelation::DecorrelationError>(())
//! ```
//!
//! # References
//!
//! - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
//!   Speckle into a Physically-Based Renderer*, VMV 2016, sections 4 and 6.
//!
//! [`SurfacePoint::image_displacement`]: tem00_decorrelation::SurfacePoint::image_displacement
//! [`SurfacePoint::pupil_displacement`]: tem00_decorrelation::SurfacePoint::pupil_displacement
//! [`Motion`]: tem00_decorrelation::Motion
//! [`Wavefront`]: tem00_decorrelation::Wavefront
//! [`ImagingGeometry::axial_decorrelation_length`]: tem00_decorrelation::ImagingGeometry::axial_decorrelation_length
//! [`ImagingGeometry::pattern_coordinate`]: tem00_decorrelation::ImagingGeometry::pattern_coordinate

mod cone;
mod fan;
mod look_up;
mod motion;
mod next_event;

pub use cone::{DiscConeRay, DiscConeSampler, modified_divergence};
pub use fan::PrintedFan;
pub use look_up::BilinearStack;
pub use motion::{
    Emitter, EulerAngles, axial_decorrelation_length, image_displacement, pattern_coordinate,
    pupil_displacement, relative_pupil_displacement, slice_coordinate,
};
pub use next_event::{PrintedEvent, line_next_event, radiance, spot_next_event, streamline_point};
