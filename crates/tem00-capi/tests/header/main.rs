//! The header against the library that it describes.
#![expect(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "a test stops at what it does not expect"
)]

mod generated;
