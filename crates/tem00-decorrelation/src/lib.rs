//! Motion and change of a speckle pattern when the surface, the camera or the laser moves.
//!
//! Given the optics of a camera and the motion of a surface point, this crate returns where the
//! speckle goes on the sensor, how far the pattern slides across the pupil, and how much of the old
//! pattern is left: everything a renderer needs to look up the right pattern, and nothing that
//! depends on how the pattern was made.
//!
//! Formulas and their derivation: `docs/theory/decorrelation.md` in the repository; what judges them:
//! `docs/validation/decorrelation.md`.
//!
//! # Conventions
//!
//! - SI units and radians; world vectors are [`DVec3`], vectors in the pupil or image [`DVec2`].
//! - A [`CameraFrame`] has `b1` to the right and `b2` up in the pupil plane, and `b3` from the scene
//!   towards the camera.
//! - Directions lead *away from the surface*: to the pupil, to the light source.
//! - A wavefront has a *curvature* 1/R, positive where the wave diverges; zero is a plane wave.
//! - `correlation` is always that of intensity: 1 for the same pattern, 0 for a new one.
//!
//! # Main types
//!
//! | question | answer |
//! |---|---|
//! | How large are the speckles of this camera? | [`ImagingGeometry`] |
//! | Which way is the camera turned, where does it see the point? | [`CameraFrame`], [`LineOfSight`] |
//! | How is the point lit? | [`Wavefront`], [`SurfacePoint`] |
//! | What moved a little? | [`Motion`] |
//! | What moved or turned a lot, or has other light? | [`Configuration`], [`RigidMotions`], [`Illumination`] |
//! | What happens to the speckle? | [`SpeckleMotion`] |
//! | What happens at many points at once? | [`MotionField`] |
//! | Where do I look in the pattern? | [`ImagingGeometry::pattern_coordinate`] |
//!
//! # Two laws of motion
//!
//! | | [`SpeckleMotion::new`] | [`SpeckleMotion::between`] |
//! |---|---|---|
//! | input | a [`SurfacePoint`] and a [`Motion`] | two [`Configuration`]s of one point |
//! | surface, camera, source | translate | translate and turn |
//! | wavelength, direction of the light | stay | may change |
//! | size of the motion | small beside distances and radii of curvature | any |
//! | cost | a few products | some square roots more |
//!
//! For small translations the second becomes the first.
//!
//! # Scope and non-goals
//!
//! A circular pupil free of aberrations, fully developed speckle, and a lit patch much wider than a
//! resolution cell and much smaller than its distances to pupil and source. Beyond that:
//!
//! - *Large turns and changes of the light* also stretch the field across the pupil. Displacements
//!   are those of the pupil centre; the correlation leaves the stretch out.
//! - *Another wavelength or direction of illumination* sees the heights of the surface in another
//!   phase. That loss depends on the roughness and not on the geometry, and is not part of any
//!   correlation here: see [`Configuration::height_phase_change`].
//! - *Spots or lines thinner than a speckle* have no pattern that moves; a wave-optical simulation
//!   does.
//! - Not covered: surfaces that deform, volume scattering, lenses telecentric towards the surface,
//!   annular and other pupils.
//!
//! # Example
//!
//! A surface under a collimated laser moves sideways by a quarter of a millimetre:
//!
//! ```
//! use tem00_decorrelation::{
//!     CameraFrame, DVec3, ImageOrientation, ImagingGeometry, LensData, LineOfSight, Motion,
//!     SpeckleMotion, SurfacePoint, Wavefront,
//! };
//!
//! let geometry = ImagingGeometry::from_lens(LensData {
//!     wavelength: 650e-9,
//!     focal_length: 25e-3,
//!     f_number: 8.0,
//!     surface_to_pupil: 0.3,
//!     pixel_pitch: 3.45e-6,
//! })?;
//! let eye = DVec3::new(0.0, 0.0, 0.3);
//! let camera = CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y)?;
//! let point = SurfacePoint::new(
//!     LineOfSight::new(&camera, eye)?,
//!     DVec3::Z,
//!     Wavefront::plane(DVec3::new(1.0, 0.0, 1.0))?,
//! )?;
//!
//! let motion = Motion { surface: DVec3::new(0.25e-3, 0.0, 0.0), ..Motion::default() };
//! let speckle = SpeckleMotion::new(&geometry, &point, &motion, ImageOrientation::ScreenUpright);
//!
//! let pixels = speckle.image_displacement / geometry.pixel_pitch();
//! assert!((pixels.x - 6.588).abs() < 1e-3);
//! assert!((speckle.correlation - 0.807).abs() < 1e-3);
//! # Ok::<(), tem00_decorrelation::DecorrelationError>(())
//! ```
//!
//! # References
//!
//! - M. Sjödahl, *Calculation of speckle displacement, decorrelation, and object-point location in
//!   imaging systems*, Applied Optics 34, 1995.
//! - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, Journal of
//!   the Optical Society of America A 3, 1986.
//! - S. Bergmann et al., *A Phenomenological Approach to Integrating Gaussian Beam Properties and
//!   Speckle into a Physically-Based Renderer*, 2016, §6.3 and §6.4.

mod configuration;
mod correlation;
mod error;
mod field;
mod finite;
mod frame;
mod geometry;
mod illumination;
mod lens;
mod motion;
mod rigid;
mod wavefront;

pub use configuration::{Configuration, ConfigurationData};
pub use correlation::{
    CorrelationLaw, axial_correlation, correlation, equivalent_axial_shift, equivalent_pupil_shift,
    motion_multiple, pupil_overlap_correlation,
};
pub use error::DecorrelationError;
pub use field::{FieldLight, FieldPoints, FieldSetup, FieldSlices, MotionField};
pub use frame::{CameraFrame, LineOfSight};
pub use geometry::ImagingGeometry;
pub use glam::{DMat3, DVec2, DVec3};
pub use illumination::Illumination;
pub use lens::{Focus, LensData, PupilDistances, ThickLensData};
pub use motion::{ImageOrientation, Motion, SpeckleMotion, SurfacePoint};
pub use rigid::{RigidMotion, RigidMotions};
pub use wavefront::Wavefront;

/// The smallest cosine between two directions that still counts as different from zero, `2⁻²⁶`.
///
/// It is the square root of the rounding unit: below it, the rounding of a cosine is a larger
/// fraction of the cosine than the cosine is of one.
const GRAZING_COSINE: f64 = 1.0 / 67_108_864.0;
