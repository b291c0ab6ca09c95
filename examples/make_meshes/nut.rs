//! A hexagon nut M10 after the dimensions of ISO 4032, in millimetres, standing on z = 0 around the
//! z axis: 16 across flats, 8.4 high, both ends chamfered at 30°. The thread is left out: the bore
//! has its minor diameter.

use core::f64::consts::{FRAC_PI_6, TAU};

use crate::ply::{Ply, Point};

/// Half the width across flats, and the height.
const FLAT: f64 = 8.0;
const HEIGHT: f64 = 8.4;
/// The radius at which the chamfer of the corners begins.
const CHAMFER: f64 = 7.5;
/// The radii of the bore and of its countersink.
const BORE: f64 = 4.188;
const SINK: f64 = 5.4;
/// Points around the axis: the corners are among them.
const AROUND: usize = 96;
const PER_FLAT: usize = AROUND / 6;

/// Returns the nut as PLY, with normals.
pub(crate) fn nut_ply() -> String {
    let mut ply = Ply::new("a hexagon nut M10, in millimetres");
    let slope = FRAC_PI_6.tan();
    let (sin, cos) = FRAC_PI_6.sin_cos();
    let sunk = (SINK - BORE) * slope;
    for side in 0..6 {
        let steps = side * PER_FLAT..=(side + 1) * PER_FLAT;
        let [x, y, _] = on_circle(1.0, side * PER_FLAT + PER_FLAT / 2, 0.0);
        ply.strip(
            steps.clone().map(|i| (corner(i, 0.0, slope), [x, y, 0.0])),
            steps.map(|i| (corner(i, HEIGHT, -slope), [x, y, 0.0])),
        );
    }
    let steps = || 0..=AROUND;
    let normal = |i, radial, z| on_circle(radial, i, z);
    let ring = |radius, z, n: [f64; 2]| {
        steps().map(move |i| (on_circle(radius, i, z), normal(i, n[0], n[1])))
    };
    let edge =
        |z, slope, n: [f64; 2]| steps().map(move |i| (corner(i, z, slope), normal(i, n[0], n[1])));
    ply.strip(
        edge(HEIGHT, -slope, [sin, cos]),
        ring(CHAMFER, HEIGHT, [sin, cos]),
    );
    ply.strip(
        ring(CHAMFER, HEIGHT, [0.0, 1.0]),
        ring(SINK, HEIGHT, [0.0, 1.0]),
    );
    ply.strip(
        ring(SINK, HEIGHT, [-sin, cos]),
        ring(BORE, HEIGHT - sunk, [-sin, cos]),
    );
    ply.strip(
        ring(BORE, HEIGHT - sunk, [-1.0, 0.0]),
        ring(BORE, sunk, [-1.0, 0.0]),
    );
    ply.strip(
        ring(BORE, sunk, [-sin, -cos]),
        ring(SINK, 0.0, [-sin, -cos]),
    );
    ply.strip(
        ring(SINK, 0.0, [0.0, -1.0]),
        ring(CHAMFER, 0.0, [0.0, -1.0]),
    );
    ply.strip(
        ring(CHAMFER, 0.0, [sin, -cos]),
        edge(0.0, slope, [sin, -cos]),
    );
    ply.text()
}

/// Returns the point of a flat where the chamfer that ends at the height `z` cuts it off.
fn corner(step: usize, z: f64, slope: f64) -> Point {
    let from_middle = (step % PER_FLAT) as f64 / PER_FLAT as f64 - 0.5;
    let radius = FLAT / (from_middle * TAU / 6.0).cos();
    on_circle(radius, step, z + (radius - CHAMFER) * slope)
}

fn on_circle(radius: f64, step: usize, z: f64) -> Point {
    let (sin, cos) = (TAU * step as f64 / AROUND as f64).sin_cos();
    [radius * cos, radius * sin, z]
}
