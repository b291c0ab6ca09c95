//! The closed forms in WGSL and in C against the lights of this crate.
//!
//! Here the WGSL is only parsed: its answers are those of a card. The C header is compiled by the
//! system's compiler.

mod c_header;
mod comparison;
mod layouts;
mod samples;
