//! What renderers ask of a light, over all lights: densities of rays, rays that materials draw,
//! power in boxes.
//!
//! All seeds are fixed.

use tem00_beam::{Emitter, FanGeometry, FocusCurve, LaserLine};

use crate::lights::{UPRIGHT, elliptic_light, lines, place};

mod boxes;
mod densities;
mod hits;

/// Lines 1 mm long on the lens, so that their source is as wide as tests can resolve.
fn fans() -> impl Iterator<Item = LaserLine> {
    lines(FanGeometry {
        fan_angle: 0.5,
        apex_offset: 1e-3,
        focus_distance: 0.1,
        focus_curve: FocusCurve::EqualDistance,
    })
}

/// The lights of all fans, and an elliptic beam.
fn lights(fans: &[LaserLine]) -> impl Iterator<Item = Box<dyn Emitter + '_>> {
    let lines = fans.iter().map(|line| place(line, &UPRIGHT));
    lines.chain([elliptic_light(0.0, &UPRIGHT)])
}
