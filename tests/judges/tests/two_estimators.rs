//! Light followed from the lasers against paths followed from the camera, pixel by pixel; and light
//! that mirrors and lenses have turned against closed forms.
//!
//! The tests are statistical but not flaky: all seeds are fixed.

#![expect(
    clippy::expect_used,
    reason = "a test stops at what it does not expect"
)]

#[path = "two_estimators/comparison.rs"]
mod comparison;
#[path = "two_estimators/lens.rs"]
mod lens;
#[path = "two_estimators/mirror.rs"]
mod mirror;
#[path = "two_estimators/rough.rs"]
mod rough;
