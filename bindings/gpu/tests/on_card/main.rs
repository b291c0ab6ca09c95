//! What runs on a card against the library, and what the texts of the function files promise.
//! Without a card Mesa's software adapter runs it: on Debian the package `mesa-vulkan-drivers`.

#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

#[path = "../../examples/factors.rs"]
mod factors;
mod kernel;
mod lights;
mod look_up;
mod motion;
mod passes;
mod patterns;
mod phasors;
mod shaders;
