//! A reference path tracer that shows how laser beams, speckle and its decorrelation meet.
//!
//! A [`Scene`] of surfaces, lasers and lights is seen by a [`Camera`](tem00_camera::Camera) with a real lens
//! and sensor. Light that meets *one* rough surface on its way from a laser to the camera, and any number
//! of mirrors and glass, is coherent: each camera sample of it is multiplied by the speckle pattern at its
//! position in the image. All other light is left as it is.
//!
//! Formulas and their derivation: `docs/theory/tracing.md` in the repository; what judges them:
//! `docs/validation/tracing.md`.
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
//! [`Scene`] describes what is rendered; `tem00-scene` reads one from a file. [`SpecklePlan`] chooses the
//! patterns and says why, [`SpeckleModel`] generates them, and [`render_frame`] renders a [`Frame`] of
//! layers. [`SpeckleChange`] is how speckle moves and changes between two frames.
//!
//! # Scope and non-goals
//!
//! Rectangles, spheres, tubes and meshes; diffuse surfaces, metals, plastic, mirrors and clear glass;
//! moving objects, lasers and cameras. Each laser is traced at its own wavelength, and other lights are
//! white. There is no polarisation, no dispersion, and nothing scatters between surfaces. Laser light that
//! meets mirrors or glass both before and after a rough surface is not found unless lasers are
//! [sampled](LaserEvents::Sampled). Nothing is read from files.
//!
//! # Example
//!
//! A plate under a laser spot, which moves by 11 pixel pitches where the lens images at 1:11:
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use glam::DVec3;
//! use tem00_camera::{Camera, CameraDescription, RadialDistortion, SensorTilt};
//! use tem00_tracer::{
//!     BeamShape, Laser, LaserDescription, Material, Rectangle, ReferencePoint, RenderOptions, Scene,
//!     Shape, SpeckleChange, SpeckleModel, SpecklePlan, Surface, Trajectory, render_frame,
//! };
//!
//! let mut scene = Scene::new(Camera::new(CameraDescription {
//!     position: 0.3 * DVec3::Z,
//!     look_at: DVec3::ZERO,
//!     up: DVec3::Y,
//!     focal_length: 25e-3,
//!     f_number: 8.0,
//!     focus_distance: 0.3,
//!     pixel_pitch: 3.45e-6,
//!     resolution: [32, 32],
//!     principal_point: None,
//!     tilt: SensorTilt::default(),
//!     distortion: RadialDistortion::default(),
//!     depth_of_field: true,
//! })?);
//! scene.lasers.push(Laser::new(LaserDescription {
//!     wavelength: 650e-9,
//!     power: 1e-3,
//!     position: DVec3::new(0.1, 0.0, 0.3),
//!     look_at: DVec3::ZERO,
//!     line_direction: DVec3::X,
//!     shape: BeamShape::Spot {
//!         waist_radius: [0.1e-3; 2],
//!         waist_distance: [0.316; 2],
//!         m_squared: [1.0; 2],
//!     },
//! })?);
//! let plate = Rectangle::new(DVec3::ZERO, 0.01 * DVec3::X, 0.01 * DVec3::Y)?;
//! scene.surfaces.push(Surface {
//!     trajectory: Trajectory::steady(37.95e-6 * DVec3::X)?,
//!     ..Surface::new("plate", Shape::Rectangle(plate), Material::lambertian(0.8)?)
//! });
//! scene.frames = 2;
//!
//! // Before anything is rendered: the camera sees the spot, and the plate is rough enough for speckle.
//! assert!(scene.inspect_lasers(0)?[0].is_seen());
//! assert!(scene.roughness_notes()?.is_empty());
//!
//! let options = RenderOptions { samples_per_pixel: 4, ..RenderOptions::default() };
//! let plan = SpecklePlan::new(&scene, options.formulas, options.seed)?;
//! let speckle = SpeckleModel::generate(&scene, &plan)?;
//! let frame = render_frame(&scene, Some(&speckle), 0, &options, |_| (), &AtomicBool::new(false))?;
//!
//! // The whole spot is in the image.
//! assert!((frame.lasers[0].power_on_target / 1e-3 - 1.0).abs() < 0.02);
//!
//! // In the next frame the speckle has moved by a pixel and is nearly the same.
//! let point = ReferencePoint { surface: 0, position: DVec3::ZERO, normal: DVec3::Z };
//! let change = SpeckleChange::between(&scene, 0, &point, [0, 1]).unwrap();
//! assert!((change.displacement.x - 1.0).abs() < 1e-2);
//! assert!((0.95..1.0).contains(&change.correlation));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod environment;
mod error;
mod film;
mod filter;
mod finish;
mod inspection;
mod integrator;
mod intersector;
mod laser;
mod light;
mod light_tracer;
mod local_frame;
mod material;
mod mesh;
mod metal;
mod render;
mod sampler;
mod scene;
mod shape;
mod speckle;
mod spread;
#[cfg(test)]
mod testing;
mod trajectory;

pub use environment::Environment;
pub use error::TracerError;
pub use film::{Frame, LaserLayers};
pub use filter::{Filter, FilterSample, FilterSampler};
pub use finish::FinishingProcess;
pub use inspection::{LaserInspection, LightFate, LightPart};
pub use intersector::{Intersector, Segment};
pub use laser::{BeamShape, EmittedRay, Laser, LaserDescription, SampledIllumination};
pub use light::{Light, LightSample};
pub use local_frame::LocalFrame;
pub use material::{BsdfSample, Material, OpticalRoughness, OpticalRoughnessQuery};
pub use mesh::{MeshError, TriangleMesh};
pub use metal::Metal;
pub use render::{
    Crop, Formulas, LaserEvents, LightEvents, Method, RenderError, RenderOptions, render_frame,
};
pub use scene::{Scene, SpeckleSettings, Surface, SurfaceSpeckle};

pub use shape::{Cylinder, Hit, MeshInstance, Rectangle, Shape, Sphere};
pub use speckle::{
    PatternPlan, ReferencePoint, RoughnessNote, SpeckleChange, SpeckleModel, SpecklePlan,
};
pub use trajectory::{Keyframe, Rotation, Trajectory};

/// The beam types that a scene is described with.
pub use tem00_beam::{FanGeometry, LineProfile};

/// Motion of rigid bodies.
pub use tem00_decorrelation::RigidMotion;
