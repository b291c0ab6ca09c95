//! Every profile of a laser line, and a rule to integrate along it.

use tem00_beam::{AngularProfile, LaserLine, LineProfile};

/// Beam radii that hold all but exp(−2 · 4.2²) = 5e−16 of the power.
pub(crate) const REACH: f64 = 4.2;

/// Every profile for a fan of the full angle `fan_angle`, in radians.
pub(crate) fn profiles(fan_angle: f64) -> [LineProfile; 7] {
    let half_angle = 0.5 * fan_angle;
    let table = [
        (-1.2, 0.0),
        (-1.0, 1.0),
        (-0.2, 0.7),
        (0.9, 0.8),
        (1.1, 0.3),
    ];
    let table = table.map(|(part, power)| (part * half_angle, power));
    [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::UniformAngle,
        LineProfile::Powell { edge: 0.1 },
        LineProfile::Tabulated(AngularProfile::from_pairs(&table).expect("a valid table")),
    ]
}

/// The slopes and weights of Gauss's rule along the fan of a line, on pieces of the variable that
/// its profile is smooth in.
pub(crate) fn slopes(line: &LaserLine) -> Vec<(f64, f64)> {
    let half_slope = line.half_slope();
    let half_angle = half_slope.atan();
    let tan = |v: f64| (v, 1.0);
    let angle = |v: f64| (v.tan(), 1.0 + v.tan().powi(2));
    let sin = |v: f64| (v.asin().tan(), (1.0 - v * v).powf(-1.5));
    // Pieces of an eighth of a half-width at 1/e², a quarter of a standard deviation: the
    // three-point rule errs by (1/4)⁷ f⁽⁶⁾ / 2016000 each, and in all by 1e−9 of the whole.
    match line.profile() {
        LineProfile::GaussianTan => gauss(&[-REACH * half_slope, REACH * half_slope], 68, tan),
        LineProfile::GaussianAngle => gauss(&[-REACH * half_angle, REACH * half_angle], 68, angle),
        LineProfile::GaussianSin => {
            let end = (REACH * half_angle.sin()).min(1.0);
            gauss(&[-end, end], 68, sin)
        }
        LineProfile::UniformTan => gauss(&[-half_slope, half_slope], 40, tan),
        LineProfile::UniformAngle => gauss(&[-half_angle, half_angle], 40, angle),
        LineProfile::Powell { edge } => {
            let end = (1.0 + 2.0 * REACH * edge) * half_slope;
            gauss(&[-end, end], pieces(68.0 + 8.0 / edge), tan)
        }
        LineProfile::Tabulated(profile) => {
            let ends: Vec<f64> = profile.knots().iter().map(|knot| knot.angle).collect();
            gauss(&ends, 16, angle)
        }
        profile => panic!("no rule for {profile:?}"),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small count"
)]
fn pieces(count: f64) -> u32 {
    count.ceil() as u32
}

/// Gauss's three-point rule on `count` pieces between each two of `ends`, mapped to (u, du/dv).
fn gauss(ends: &[f64], count: u32, map: impl Fn(f64) -> (f64, f64)) -> Vec<(f64, f64)> {
    let nodes = [
        (-(0.6_f64.sqrt()), 5.0 / 18.0),
        (0.0, 4.0 / 9.0),
        (0.6_f64.sqrt(), 5.0 / 18.0),
    ];
    let mut rule = Vec::new();
    for pair in ends.windows(2) {
        let h = (pair[1] - pair[0]) / f64::from(count);
        for i in 0..count {
            for (node, weight) in nodes {
                let (u, jacobian) = map(pair[0] + (f64::from(i) + 0.5 + 0.5 * node) * h);
                rule.push((u, weight * h * jacobian));
            }
        }
    }
    rule
}
