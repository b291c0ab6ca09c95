//! Slow tests of the laws: wave-optical fields, thousands of trials and whole renders judge them.
//!
//! They are a package of their own, so that `cargo test` in the root of the workspace stays quick;
//! `cargo test --workspace` runs them, too.
