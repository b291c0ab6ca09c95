//! The closed forms in WGSL and in C against the lights of this crate.
//!
//! The WGSL runs in a small interpreter of the intermediate form that naga parses it to; the C header
//! is compiled by the system's compiler.
#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod c_header;
mod comparison;
mod interpreter;
mod layouts;
mod lights;
mod wgsl;
