#![doc = include_str!("../README.md")]

mod aperture;
mod error;
mod gpu;
mod kernel;
mod pattern;
mod stack;
mod transform;

pub use error::GpuError;
pub use gpu::Gpu;
pub use pattern::GpuPattern;
pub use stack::GpuStack;
/// The library of devices, queues and buffers: its types stand in the signatures of this crate.
pub use wgpu;
