#![doc = include_str!("../README.md")]

mod hierarchy;
mod intersector;
mod mesh;
mod segment;
mod shape;

pub use intersector::Intersector;
pub use mesh::{MeshError, TriangleMesh};
pub use segment::Segment;
pub use shape::{Cylinder, Hit, MeshInstance, Rectangle, Shape, Sphere};

/// The refusal of an impossible argument.
pub use tem00_numerics::Refusal;
