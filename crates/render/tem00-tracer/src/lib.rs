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
//!
//! # Main types
//!
//! [`Scene`] describes what is rendered; `tem00-scene` reads one from a file. [`ReferenceSpeckle`]
//! holds its speckle, and [`render_reference`] renders a [`Frame`] of layers.
//!
//! # Scope and non-goals
//!
//! Rectangles, spheres, tubes and meshes; diffuse surfaces, metals, plastic, translucent bodies,
//! mirrors and clear glass; moving objects, lasers and cameras. Each laser is traced at its own
//! wavelength, and other lights are white. There is no polarisation, no dispersion, and nothing
//! scatters between surfaces. Laser light that meets mirrors or glass both before and after a rough
//! surface is not found unless lasers are [sampled](LaserEvents::Sampled). The crate reads no
//! files.

mod below;
mod environment;
mod error;
pub mod film;
mod filter;
mod finish;
mod light;
mod local_frame;
mod material;
mod metal;
mod options;
mod reference;
mod render_error;
mod scene;

pub use below::SpeckleBelow;
pub use environment::Environment;
pub use error::TracerError;
pub use film::{Frame, LaserLayers};
pub use filter::{Filter, FilterSample, FilterSampler};
pub use finish::FinishingProcess;
pub use light::{Light, LightSample, WHITE_LIGHT_WAVELENGTH};
pub use local_frame::LocalFrame;
pub use material::{BsdfSample, Material, OpticalRoughness, OpticalRoughnessQuery};
pub use metal::Metal;
pub use options::{LaserEvents, LightEvents, Method, RenderOptions, Sampling};
pub use reference::{ReferenceSpeckle, render_reference};
pub use render_error::RenderError;
pub use scene::{Scene, SpeckleSettings, Surface, SurfaceSpeckle};

/// Lasers, and motions from frame to frame.
pub use tem00_shading::{
    BeamShape, EmittedRay, Keyframe, Laser, LaserDescription, LaserEvent, Rotation, SampledEvent,
    Trajectory,
};

/// The beam types that a scene is described with.
pub use tem00_beam::{FanGeometry, LineProfile};

/// The spectrum of a laser and the relief of a surface.
pub use tem00_coherence::{PeakShape, Relief, Spectrum};

/// Bodies that let light in.
pub use tem00_translucence::{Material as NamedMedium, Medium, MediumDescription};

/// A part of an image.
pub use tem00_numerics::Crop;

/// Motion of rigid bodies.
pub use tem00_decorrelation::RigidMotion;
