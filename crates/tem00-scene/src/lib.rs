//! Scene files, meshes and maps of radiance, read into scenes for `tem00-tracer`.
//!
//! # Conventions
//!
//! - Scene files are TOML in the syntax of [`tem00_config`]: SI units or units in strings, files beside the
//!   one that names them, errors at line and column.
//! - Coordinates of meshes are multiplied by the length of the file's unit in metres.
//!
//! # Main types
//!
//! [`read_scene`] and [`parse_scene`] make a [`Scene`](tem00_tracer::Scene); [`SceneFile`] keeps the names
//! of all files that were read. [`read_mesh`] reads OBJ, PLY, STL and glTF, [`read_radiance_map`] OpenEXR
//! and PFM.
//!
//! # Scope and non-goals
//!
//! Geometry only of meshes: no colours, materials, textures or animations. Nothing is written.
//!
//! # Example
//!
//! ```
//! use std::{path::Path, sync::atomic::AtomicBool};
//!
//! use tem00_scene::parse_scene;
//! use tem00_tracer::{RenderOptions, SpeckleModel, SpecklePlan, render_frame};
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
//!     Path::new("."),
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

mod assets;
mod camera;
mod filter;
mod laser;
mod light;
mod material;
mod mesh_file;
mod motion;
mod placement;
mod radiance_map;
mod scene_file;
mod settings;
mod shape;
mod surface;
#[cfg(test)]
mod tests;

pub use material::MATERIALS;
pub use mesh_file::{MeshFileError, MeshFormat, read_mesh, read_mesh_bytes};
pub use radiance_map::{RadianceMapError, read_radiance_map};
pub use scene_file::{SceneFile, parse_scene, read_scene};
