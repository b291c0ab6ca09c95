//! The text of a PLY file in the making.

use core::fmt::Write as _;

pub(crate) type Point = [f64; 3];

/// A mesh of quadrilaterals with normals at their corners.
pub(crate) struct Ply {
    title: &'static str,
    vertices: String,
    faces: String,
    counts: [usize; 2],
}

impl Ply {
    pub(crate) const fn new(title: &'static str) -> Self {
        Self {
            title,
            vertices: String::new(),
            faces: String::new(),
            counts: [0; 2],
        }
    }

    /// Adds the strip between two lines of as many points, each with its normal; it faces to the
    /// right of the way from the first line to the second along their direction.
    pub(crate) fn strip(
        &mut self,
        from: impl Iterator<Item = (Point, Point)>,
        to: impl Iterator<Item = (Point, Point)>,
    ) {
        let [first, faces] = self.counts;
        let mut pairs = 0;
        for (a, b) in from.zip(to) {
            for ([x, y, z], normal) in [a, b] {
                // Without the sign of a zero.
                let [nx, ny, nz] = normal.map(|c| (1e4 * c).round() / 1e4 + 0.0);
                let [x, y, z] = [x, y, z].map(|c| (1e4 * c).round() / 1e4 + 0.0);
                // Writing to a string cannot fail.
                let _ = writeln!(self.vertices, "{x} {y} {z} {nx} {ny} {nz}");
            }
            if pairs > 0 {
                let [a, b] = [first + 2 * pairs - 2, first + 2 * pairs];
                let _ = writeln!(self.faces, "4 {a} {b} {} {}", b + 1, a + 1);
            }
            pairs += 1;
        }
        self.counts = [first + 2 * pairs, faces + pairs.saturating_sub(1)];
    }

    pub(crate) fn text(&self) -> String {
        let [vertices, faces] = self.counts;
        format!(
            "ply\nformat ascii 1.0\ncomment {}\nelement vertex {vertices}\n\
             property float x\nproperty float y\nproperty float z\n\
             property float nx\nproperty float ny\nproperty float nz\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n{}{}",
            self.title, self.vertices, self.faces
        )
    }
}
