#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Scene files are TOML in the syntax of [`tem00_config`]: SI units or units in strings, file
//!   names relative to the file that states them, errors at line and column.
//! - Coordinates of meshes are multiplied by the length of the file's unit in metres.
//!
//! # Main types
//!
//! [`read_scene`] and [`parse_scene`] make a [`Scene`](tem00_tracer::Scene); [`SceneFile`] keeps
//! the names of all files that were read. [`read_mesh`] reads OBJ, PLY, STL and glTF,
//! [`read_radiance_map`] OpenEXR and PFM.
//!
//! # Scope and non-goals
//!
//! Only the geometry of meshes is read: no colours, materials, textures or animations. The crate
//! writes no files.

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

pub use material::MATERIALS;
pub use mesh_file::{MeshFileError, MeshFormat, read_mesh, read_mesh_bytes};
pub use radiance_map::{RadianceMapError, read_radiance_map};
pub use scene_file::{SceneFile, parse_scene, read_scene};
