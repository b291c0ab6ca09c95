//! The closed forms in WGSL against the lights of this crate.
//!
//! The WGSL runs in a small interpreter of the intermediate form that naga parses it to.
#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod comparison;
mod interpreter;
mod layouts;
mod lights;
mod wgsl;
