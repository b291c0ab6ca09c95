//! Parts of one profile, milled along y, in millimetres, standing on z = 0.

use crate::ply::Ply;

/// The heights of a step gauge, 6 mm wide each; the least step is 0.05 mm.
const STEPS: [f64; 5] = [1.0, 1.05, 1.5, 2.5, 4.5];
const STEP_WIDTH: f64 = 6.0;

/// A trapezoidal groove between flat shoulders: x and z.
const GROOVE: [[f64; 2]; 8] = [
    [-15.0, 0.0],
    [-15.0, 6.0],
    [-5.0, 6.0],
    [-2.5, 1.0],
    [2.5, 1.0],
    [5.0, 6.0],
    [15.0, 6.0],
    [15.0, 0.0],
];

/// Returns the step gauge as PLY.
pub(crate) fn step_gauge_ply() -> String {
    let left = -0.5 * STEP_WIDTH * STEPS.len() as f64;
    let mut profile = vec![[left, 0.0]];
    for (i, &height) in STEPS.iter().enumerate() {
        let x = left + STEP_WIDTH * i as f64;
        profile.extend([[x, height], [x + STEP_WIDTH, height]]);
    }
    profile.push([-left, 0.0]);
    milled("a step gauge, in millimetres", &profile, 12.0)
}

/// Returns the block with the groove as PLY.
pub(crate) fn groove_ply() -> String {
    milled("a block with a groove, in millimetres", &GROOVE, 12.0)
}

/// Returns a part with a profile that goes from left to right over its top, open below and at its
/// ends.
fn milled(title: &'static str, profile: &[[f64; 2]], half_depth: f64) -> String {
    let mut ply = Ply::new(title);
    for pair in profile.windows(2) {
        let ([x0, z0], [x1, z1]) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(z1 - z0);
        let normal = [(z0 - z1) / length, 0.0, (x1 - x0) / length];
        let line = |x, z| {
            [-half_depth, half_depth]
                .map(|y| ([x, y, z], normal))
                .into_iter()
        };
        ply.strip(line(x1, z1), line(x0, z0));
    }
    ply.text()
}
