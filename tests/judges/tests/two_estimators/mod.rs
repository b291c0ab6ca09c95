//! Light followed from the lasers against paths followed from the camera, pixel by pixel; and light
//! that mirrors and lenses have turned against closed forms.
//!
//! The tests are statistical but not flaky: all seeds are fixed.

mod comparison;
mod lens;
mod mirror;
mod rough;
