//! A reference path tracer that shows how laser beams, speckle and its decorrelation meet.
//!
//! A scene of surfaces, lasers and lamps is seen by a camera with a real lens and sensor. Light that
//! meets *one* rough surface on its way from a laser to the camera, and any number of mirrors and
//! glass, is coherent: each camera sample of it is multiplied by the speckle pattern at its place in
//! the image. All other light is left as it is.
//!
//! # Conventions
//!
//! - Lengths are in metres, powers in watts, radiances in W/(m² sr), all in `f64`; images are `f32`.
//! - Image points are in pixels, x to the right and y down; the image is upright.
//! - One frame, the first unless said otherwise, is the reference that the speckle of the others has
//!   moved and changed from.
//! - The same seed gives the same bits for any number of threads.
//!
//! # Main types
//!
//! [`read_scene`] makes a [`Scene`] of a file; [`SpecklePlan`] chooses the patterns and says why,
//! [`SpeckleModel`] generates them, and [`render_frame`] renders a [`Frame`] of layers.
//!
//! # Scope and non-goals
//!
//! Rectangles, spheres, tubes and meshes; diffuse surfaces, metals, plastic, mirrors and clear glass; a
//! thin lens with depth of field, tilt and distortion; moving objects, lasers and cameras. Each laser
//! is traced at its own wavelength, and lamps are white. There is no polarisation, no dispersion, and
//! nothing scatters between surfaces. Laser light that meets mirrors or glass both before and after
//! a rough surface is not found unless lasers are [sampled](LaserEvents::Sampled).
//!
//! # Example
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use tem00_tracer::{RenderOptions, SpeckleModel, SpecklePlan, parse_scene, render_frame};
//!
//! let scene = parse_scene(
//!     r#"
//!     [camera]
//!     position = ["0 mm", "0 mm", "300 mm"]
//!     look_at = ["0 mm", "0 mm", "0 mm"]
//!     focal_length = "25 mm"
//!     f_number = 8
//!     pixel_pitch = "3.45 um"
//!     resolution = [32, 32]
//!
//!     [[laser]]
//!     wavelength = "650 nm"
//!     power = "1 mW"
//!     position = ["100 mm", "0 mm", "300 mm"]
//!     look_at = ["0 mm", "0 mm", "0 mm"]
//!     spot = { waist_radius = "0.1 mm" }
//!
//!     [[surface]]
//!     rectangle = { centre = [0, 0, 0], normal = [0, 0, 1], size = ["20 mm", "20 mm"] }
//!     "#,
//!     std::path::Path::new("."),
//! )?;
//! let options = RenderOptions { samples_per_pixel: 4, ..RenderOptions::default() };
//! let plan = SpecklePlan::new(&scene, options.formulas, options.seed)?;
//! let speckle = SpeckleModel::generate(&scene, &plan)?;
//!
//! let frame = render_frame(&scene, Some(&speckle), 0, &options, |_| (), &AtomicBool::new(false))?;
//!
//! // The whole spot is in the image.
//! assert!((frame.lasers[0].power_on_target / 1e-3 - 1.0).abs() < 0.02);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod environment;
mod environment_file;
mod error;
mod film;
mod filter;
mod finish;
mod input_file;
mod inspection;
mod integrator;
mod intersector;
mod lamp;
mod laser;
mod light_tracer;
mod local_frame;
mod material;
mod mesh;
mod mesh_file;
mod metal;
mod printable;
mod render;
mod sampler;
mod scene;
mod scene_file;
mod shape;
mod speckle;
mod spread;
#[cfg(test)]
mod testing;
mod trajectory;

pub use environment::Environment;
pub use environment_file::{RadianceMapError, read_radiance_map};
pub use error::TracerError;
pub use film::{Frame, LaserLayers};
pub use filter::{Filter, FilterSample, FilterSampler};
pub use finish::FinishingProcess;
pub use inspection::{LaserInspection, LightFate, LightPart};
pub use intersector::{Intersector, Segment};
pub use lamp::{Lamp, LampSample};
pub use laser::{BeamShape, EmittedRay, Laser, LaserDescription, SampledIllumination};
pub use local_frame::LocalFrame;
pub use material::{BsdfSample, Material, OpticalRoughness, OpticalRoughnessQuery};
pub use mesh::{MeshError, TriangleMesh};
pub use mesh_file::{MeshFormat, read_mesh, read_mesh_bytes};
pub use metal::Metal;
pub use render::{
    Crop, Formulas, LampEvents, LaserEvents, Method, RenderError, RenderOptions, render_frame,
};
pub use scene::{RenderSettings, Scene, SpeckleSettings, Surface, SurfaceSpeckle};
pub use scene_file::{SceneError, SceneFile, parse_scene, read_scene};

pub use shape::{Cylinder, Hit, MeshInstance, Rectangle, Shape, Sphere};
pub use speckle::{
    PatternPlan, ReferencePoint, RoughnessNote, SpeckleChange, SpeckleModel, SpecklePlan,
};
pub use trajectory::{Keyframe, Rotation, Trajectory};

/// The beam types that a scene is described with.
pub use tem00_beam::{FanGeometry, LineProfile};

/// Files in the syntax of scene files, section by section: for what reads more than a scene.
pub mod document {
    pub use crate::scene_file::{
        ANGLE, Change, Choice, DURATION, Dimension, Document, DocumentKind, Format, LENGTH,
        MATERIALS, MEMORY, NUMBER, POWER, Problem, RADIANCE, Reading, Section, Value,
        kind_of_document, parse_document, read_document,
    };

    pub use crate::printable::{is_hazard, printable, printable_line};

    pub use crate::input_file::{
        FileAccess, MAX_ASSET_BYTES, MAX_TEXT_BYTES, is_standard_input, open_input, read_input,
    };
}

/// How rigid bodies move.
pub use tem00_decorrelation::RigidMotion;
