//! A turned and drilled flange, in millimetres, standing on z = 0 around the z axis.
//!
//! Closed loops of points are joined by bands of quadrilaterals. Bands are smooth along their loops
//! and meet at sharp edges.

use core::f64::consts::TAU;
use core::fmt::Write as _;

type Point = [f64; 3];

/// Points of a loop around the axis, and the sectors of the flange; each has a hole.
const AROUND: usize = 96;
const SECTORS: usize = 6;
/// Segments of a sector's sides.
const ALONG_SIDE: usize = 8;
/// The distance of the holes from the axis.
const HOLE_CIRCLE: f64 = 21.0;
/// The face of the flange between its chamfer and the hub: radii and height.
const FACE: [f64; 3] = [29.0, 13.5, 8.0];

/// The turned outside, from the table up over the hub and down the bore: radii and heights.
const OUTSIDE: [[f64; 2]; 4] = [[29.5, 0.0], [30.0, 0.5], [30.0, 7.0], [29.0, 8.0]];
const HUB: [[f64; 2]; 13] = [
    [13.5, 8.0],
    [13.0, 8.5],
    [13.0, 13.0],
    [12.2, 13.5],
    [12.2, 15.0],
    [13.0, 15.5],
    [13.0, 19.0],
    [12.0, 20.0],
    [8.6, 20.0],
    [8.0, 19.4],
    [8.0, 14.0],
    [5.0, 14.0],
    [5.0, 0.0],
];

/// Returns the flange as OBJ, with normals.
pub(crate) fn flange_obj() -> String {
    let mut obj = Obj::new("A flange, in millimetres.");
    for profile in [OUTSIDE.as_slice(), HUB.as_slice()] {
        let loops: Vec<_> = profile
            .iter()
            .map(|&[r, z]| obj.add(&circle(r, z)))
            .collect();
        for pair in loops.windows(2) {
            obj.join(&pair[0], &pair[1]);
        }
    }
    for sector in 0..SECTORS {
        let boundary = sector_boundary(sector);
        // Countersunk holes for screws, and two slots.
        let slot = sector % 3 == 0;
        let (half_length, radius, sink) = if slot {
            (4.0, 3.0, 0.5)
        } else {
            (0.0, 3.3, 2.0)
        };
        let hole = |radius, z| {
            let points = boundary.iter();
            let points = points.map(|&p| towards(sector, p, half_length, radius, z));
            points.collect::<Vec<_>>()
        };
        let loops = [
            boundary.clone(),
            hole(radius + sink, FACE[2]),
            hole(radius, FACE[2] - sink),
            hole(radius, 0.0),
        ];
        let loops = loops.map(|points| obj.add(&points));
        for pair in loops.windows(2) {
            obj.join(&pair[0], &pair[1]);
        }
    }
    obj.text
}

/// Returns a loop around the axis, counter-clockwise from above.
fn circle(radius: f64, z: f64) -> Vec<Point> {
    (0..AROUND).map(|step| on_circle(radius, step, z)).collect()
}

fn on_circle(radius: f64, step: usize, z: f64) -> Point {
    let (sin, cos) = (TAU * step as f64 / AROUND as f64).sin_cos();
    [radius * cos, radius * sin, z]
}

/// Returns the outline of a sector of the face, counter-clockwise, with the points of the circles.
fn sector_boundary(sector: usize) -> Vec<Point> {
    let [outer, inner, z] = FACE;
    let steps = AROUND / SECTORS;
    let first = sector * steps;
    let along = |i: usize| i as f64 / ALONG_SIDE as f64;
    let outwards = (0..ALONG_SIDE).map(|i| on_circle(inner + (outer - inner) * along(i), first, z));
    let forth = (0..steps).map(|i| on_circle(outer, first + i, z));
    let inwards =
        (0..ALONG_SIDE).map(|i| on_circle(outer - (outer - inner) * along(i), first + steps, z));
    let back = (0..steps).map(|i| on_circle(inner, first + steps - i, z));
    outwards.chain(forth).chain(inwards).chain(back).collect()
}

/// Returns the point of a sector's hole in the direction of `target`, seen from above.
///
/// A slot is everything within `radius` of a line of twice `half_length`, across the radius of the
/// flange.
fn towards(sector: usize, target: Point, half_length: f64, radius: f64, z: f64) -> Point {
    let turn = TAU * (sector as f64 + 0.5) / SECTORS as f64;
    let (sin, cos) = turn.sin_cos();
    // The axes of the hole: outwards, and across.
    let out = target[0] * cos + target[1] * sin - HOLE_CIRCLE;
    let across = target[1] * cos - target[0] * sin;
    let length = out.hypot(across);
    let (out, across) = (out / length, across / length);
    let flat = radius / out.abs();
    let reach = if flat * across.abs() <= half_length {
        flat
    } else {
        // The end is a circle around half_length: |t (out, across) − (0, h)| = radius.
        let middle = half_length * across.abs();
        middle + (radius * radius - (half_length * out).powi(2)).sqrt()
    };
    let (out, across) = (HOLE_CIRCLE + reach * out, reach * across);
    [out * cos - across * sin, out * sin + across * cos, z]
}

/// The text of an OBJ file in the making.
struct Obj {
    text: String,
    points: Vec<Point>,
    normals: usize,
}

impl Obj {
    fn new(title: &str) -> Self {
        Self {
            text: format!("# {title}\n"),
            points: Vec::new(),
            normals: 0,
        }
    }

    /// Writes the points of a loop; returns their numbers.
    fn add(&mut self, points: &[Point]) -> Vec<usize> {
        let first = self.points.len() + 1;
        for [x, y, z] in points {
            self.line(format_args!("v {x:.3} {y:.3} {z:.1}"));
        }
        self.points.extend(points);
        (first..first + points.len()).collect()
    }

    /// Writes the band between two loops of as many points; it faces to the right of the way from
    /// the first to the second along the loops' direction.
    fn join(&mut self, from: &[usize], to: &[usize]) {
        let count = from.len();
        for i in 0..count {
            let [nx, ny, nz] = self.normal(from, to, i);
            self.line(format_args!("vn {nx:.3} {ny:.3} {nz:.3}"));
        }
        let normal = |i: usize| self.normals + i + 1;
        let mut faces = String::new();
        for i in 0..count {
            let j = (i + 1) % count;
            let (a, b, c, d) = (from[i], from[j], to[j], to[i]);
            let (m, n) = (normal(i), normal(j));
            // Writing to a string cannot fail.
            let _ = writeln!(faces, "f {a}//{m} {b}//{n} {c}//{n} {d}//{m}");
        }
        self.text += &faces;
        self.normals += count;
    }

    /// Returns the normal of a band at one of its points.
    fn normal(&self, from: &[usize], to: &[usize], i: usize) -> Point {
        let count = from.len();
        let point = |index: usize| self.points[index - 1];
        let difference = |a: Point, b: Point| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let along = difference(
            point(from[(i + 1) % count]),
            point(from[(i + count - 1) % count]),
        );
        let across = difference(point(to[i]), point(from[i]));
        let normal = [
            along[1] * across[2] - along[2] * across[1],
            along[2] * across[0] - along[0] * across[2],
            along[0] * across[1] - along[1] * across[0],
        ];
        let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        normal.map(|c| c / length)
    }

    fn line(&mut self, content: core::fmt::Arguments<'_>) {
        let _ = writeln!(self.text, "{content}");
    }
}
