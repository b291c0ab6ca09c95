#![doc = include_str!("../README.md")]

mod error;
mod gpu;

pub use error::GpuError;
pub use gpu::Gpu;
/// The library of devices, queues and buffers: its types stand in the signatures of this crate.
pub use wgpu;
