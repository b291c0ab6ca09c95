//! First-principles scalar wave optics of a rough surface.
//!
//! Many point scatterers, lit by a coherent wave, send out spherical waves; their sum is the speckle
//! on a plane, and an ideal lens makes an image of it. Distances are exact, motions are finite, and
//! nothing is assumed about speckle. The crate is slow and simple on purpose: it is the judge of
//! models that are neither.
//!
//! Formulas and their derivation: `docs/theory/wave.md` in the repository; what judges them:
//! `docs/validation/wave.md`.
//!
//! # Conventions
//!
//! - SI units and radians; amplitudes vary in time as `exp(−iωt)`, so that a diverging wave is
//!   `exp(+ikr)/r`.
//! - Lengths lie between 1 pm and 10 km and wavelengths between 0.1 nm and 1 m, so that every phase
//!   means something in `f64`.
//! - Image coordinates are those of the upright picture: to the right and upwards, in metres on the
//!   sensor. Columns and rows of a [`Grid`] count in the same directions.
//!
//! # Main types
//!
//! | what | type |
//! |---|---|
//! | scatterers with random phases or random heights | [`RoughSurface`] |
//! | plane wave, point source, Gaussian beam, laser line | [`Illumination`] |
//! | both together, ready to be summed | [`LitSurface`] |
//! | points at which the field is asked for | [`SamplePlane`] |
//! | pupil, lens and picture | [`Camera`], [`ImageWindow`] |
//! | a field, and its intensity | [`Field`] |
//! | motion of surface, light or camera | [`RigidMotion`] |
//! | how far a pattern moved, how much of it is left | [`displacement_between`], [`FieldCorrelation`] |
//!
//! # Scope and non-goals
//!
//! One scattering per light path, one polarisation, no shadowing, no diffraction by the edges of the
//! scene, no aberrations. The brightness of a surface is on a scale of its own: there is no
//! reflectance model.
//!
//! # Example
//!
//! How far does the speckle on a lens move when a surface under collimated light moves by 100 µm
//! sideways? By twice as far if the light comes from the distance of the lens, and just as far here:
//!
//! ```
//! use tem00_wave::{
//!     Amplitudes, Arrangement, Camera, DVec3, Illumination, Lens, PatchDescription, RigidMotion,
//!     Roughness, RoughSurface, displacement_between,
//! };
//!
//! let surface = RoughSurface::patch(&PatchDescription {
//!     centre: DVec3::ZERO,
//!     normal: DVec3::Z,
//!     along: DVec3::X,
//!     size: [1e-3, 1e-3],
//!     scatterers: [40, 40],
//!     arrangement: Arrangement::Lattice,
//!     roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
//!     seed: 1,
//! })?;
//! let light = Illumination::plane(650e-9, DVec3::NEG_Z)?;
//! let lens = Lens { pupil_diameter: 5e-3, focus_distance: 0.3, pupil_to_image: 0.06 };
//! let camera = Camera::look_at([DVec3::new(0.0, 0.0, 0.3), DVec3::ZERO], DVec3::Y, lens)?;
//!
//! // Speckles on the lens are λL/W = 195 µm wide.
//! let pupil = camera.pupil_plane(50e-6, 64)?;
//! let motion = RigidMotion::translation(DVec3::new(100e-6, 0.0, 0.0))?;
//! let before = surface.lit_by(&light).field_on(&pupil).intensity();
//! let after = surface.moved(&motion).lit_by(&light).field_on(&pupil).intensity();
//!
//! let shift = displacement_between(&before, &after).ok_or("no maximum")?;
//! assert!((shift.offset.x * 50e-6 - 100e-6).abs() < 2e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # References
//!
//! - J. W. Goodman, *Introduction to Fourier Optics*, 1968, ch. 3 and 5.
//! - A. E. Siegman, *Lasers*, 1986, ch. 16 and 17.

mod camera;
mod correlation;
mod error;
mod field;
mod heights;
mod illumination;
mod image;
mod length;
mod lit;
mod motion;
mod patch;
mod phasor;
mod plane;
mod random;
mod shift;
mod sum;
mod surface;

pub use camera::{Camera, Lens};
pub use correlation::{Estimate, FieldCorrelation};
pub use error::WaveError;
pub use field::Field;
pub use glam::{DMat3, DVec2, DVec3};
pub use illumination::{BeamDescription, FanDescription, Illumination};
pub use image::{ImageSampling, ImageWindow};
pub use lit::{LitSurface, Progress};
pub use motion::RigidMotion;
pub use num_complex::Complex;
pub use patch::{Amplitudes, Arrangement, PatchDescription, Roughness, Scatterer};
pub use plane::SamplePlane;
pub use shift::{Shift, displacement_between};
pub use surface::RoughSurface;
pub use tem00_numerics::Grid;
