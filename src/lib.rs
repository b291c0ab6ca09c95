//! Physics of laser light for renderers.
//!
//! A renderer that has laser light with speckle that moves as it should calls few names: a
//! [`Laser`] lights a point, [`Speckle`] chooses the patterns for a [`Camera`] and the poses of
//! bodies, and [`SpeckleFrame::factor`] multiplies the light of a hit. How: `docs/integration.md`
//! in the repository.
//!
//! These names are the upper level. The modules are the level below, for a renderer that wants
//! lights alone, patterns of its own or the law of motion: `docs/functions.md`. Each is a crate,
//! and they meet through plain numbers.
//!
//! | module | crate | what it holds |
//! |---|---|---|
//! | [`shading`] | `tem00-shading` | where these meet: the factor of a hit |
//! | [`beam`] | `tem00-beam` | Gaussian beams and laser lines as lights to evaluate and sample |
//! | [`speckle`] | `tem00-speckle` | pupil field → pattern → stack → look-up |
//! | [`decorrelation`] | `tem00-decorrelation` | imaging geometry → displacement → correlation |
//! | [`coherence`] | `tem00-coherence` | linewidth → contrast, grain and line noise of speckle |
//! | [`translucence`] | `tem00-translucence` | a line on a body that lets light in: shift and contrast |
//! | [`camera`] | `tem00-camera` | lens and sensor: projection, focus, tilt, distortion |
//! | [`optics`] | `tem00-optics` | lenses, apertures and fits of measured beams |
//! | [`numerics`] | `tem00-numerics` | grids, pruned Fourier transform, pupil functions |
#![cfg_attr(
    feature = "statistics",
    doc = "| [`statistics`] | `tem00-statistics` | closed forms, estimators, hypothesis tests (feature `statistics`) |"
)]
#![cfg_attr(
    feature = "wave",
    doc = "| [`wave`] | `tem00-wave` | scalar wave optics of rough surfaces, the judge of the others (feature `wave`) |"
)]
#![cfg_attr(
    feature = "tracer",
    doc = "| [`geometry`] | `tem00-geometry` | shapes, meshes and where rays meet them (feature `tracer`) |"
)]
#![cfg_attr(
    feature = "tracer",
    doc = "| [`tracer`] | `tem00-tracer` | scenes, and the reference integrator (feature `tracer`) |"
)]
#![cfg_attr(
    feature = "tracer",
    doc = "| [`engine`] | `tem00-engine` | the same scenes, rendered fast (feature `tracer`) |"
)]
#![cfg_attr(
    feature = "tracer",
    doc = "| [`scene`] | `tem00-scene` | scene files, meshes, maps of radiance (feature `tracer`) |"
)]
#![cfg_attr(
    feature = "triangulation",
    doc = "| [`triangulation`] | `tem00-triangulation` | sensor, line detectors, profiles and their uncertainty (feature `triangulation`) |"
)]
#![cfg_attr(
    feature = "triangulation",
    doc = "| [`calibration`] | `tem00-calibration` | camera and laser plane from images of boards, with their covariance (feature `triangulation`) |"
)]
#![cfg_attr(
    feature = "triangulation",
    doc = "| [`uncertainty`] | `tem00-uncertainty` | uncertainty after the GUM: first order, trials, parts of the variance (feature `triangulation`) |"
)]
#![cfg_attr(
    feature = "scan",
    doc = "| [`scan`] | `tem00-scan` | a part as a triangulation sensor sees it: rendered frames, scans, height maps (feature `scan`) |"
)]
#![cfg_attr(
    feature = "scan",
    doc = "| [`topography`] | `tem00-topography` | artefacts of known shape, and the characteristics of a sensor that measures them (feature `scan`) |"
)]

pub use tem00_shading as shading;
pub use tem00_shading::{
    Camera, CameraDescription, DMat3, DVec2, DVec3, Laser, LaserBuilder, Motion, Pose,
    PreparedSpeckle, ShadingError, Speckle, SpeckleFrame,
};

pub use tem00_beam as beam;
#[cfg(feature = "triangulation")]
pub use tem00_calibration as calibration;
pub use tem00_camera as camera;
pub use tem00_coherence as coherence;
#[cfg(any(feature = "tracer", feature = "triangulation"))]
pub use tem00_config as config;
pub use tem00_decorrelation as decorrelation;
#[cfg(feature = "tracer")]
pub use tem00_engine as engine;
#[cfg(feature = "tracer")]
pub use tem00_geometry as geometry;
pub use tem00_numerics as numerics;
pub use tem00_optics as optics;
#[cfg(feature = "scan")]
pub use tem00_scan as scan;
#[cfg(feature = "tracer")]
pub use tem00_scene as scene;
pub use tem00_speckle as speckle;
#[cfg(feature = "statistics")]
pub use tem00_statistics as statistics;
#[cfg(feature = "scan")]
pub use tem00_topography as topography;
#[cfg(feature = "tracer")]
pub use tem00_tracer as tracer;
pub use tem00_translucence as translucence;
#[cfg(feature = "triangulation")]
pub use tem00_triangulation as triangulation;
#[cfg(feature = "triangulation")]
pub use tem00_uncertainty as uncertainty;
#[cfg(feature = "wave")]
pub use tem00_wave as wave;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

#[cfg(doctest)]
#[doc = include_str!("../docs/functions.md")]
struct FunctionExamples;
