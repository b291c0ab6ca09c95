//! The page: a part under a laser on a canvas, drawn by one pass that calls the function files of
//! the physics crates.
//!
//! All but the canvas runs elsewhere too, where tests hold it to the reference tracer.

mod code;
mod colour;
pub mod measure;
pub mod optics;
#[cfg(target_arch = "wasm32")]
pub mod page;
mod passes;
#[cfg(target_arch = "wasm32")]
pub mod prepare;
pub mod scene;
pub mod settings;
pub mod speckle;

pub use passes::Passes;

/// An error of any of the crates below.
pub type AnyError = Box<dyn core::error::Error>;
