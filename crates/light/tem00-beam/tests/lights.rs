//! Lights of every kind, and a rule to integrate along a laser line.

use tem00_beam::{
    AngularProfile, AstigmaticBeam, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam,
    LaserLine, LineLight, LineProfile, LocatedBeam, Placement, SpotLight, TabulatedLineLight,
};

/// Beam radii that hold all but exp(−2 · 4.2²) = 5e−16 of the power.
pub(crate) const REACH: f64 = 4.2;
pub(crate) const POWER: f64 = 5e-3;

/// At the origin and along z, so that world coordinates are those of the light.
pub(crate) const UPRIGHT: Placement = Placement {
    origin: DVec3::ZERO,
    direction: DVec3::Z,
    fan_axis: DVec3::X,
};

pub(crate) fn beam(waist: f64) -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, waist).expect("a valid beam")
}

/// An elliptic beam with its waists apart and M² in one axis, turned by an angle.
pub(crate) fn elliptic(rotation: f64) -> AstigmaticBeam {
    let wide = beam(60e-6).with_m_squared(1.6).expect("a valid beam");
    let located = |beam, z| LocatedBeam::new(beam, z).expect("a valid beam");
    AstigmaticBeam::new(located(beam(30e-6), 0.05), located(wide, -0.02))
        .and_then(|beam| beam.with_rotation(rotation))
        .expect("a valid beam")
}

/// The light of [`elliptic`].
pub(crate) fn elliptic_light(rotation: f64, placement: &Placement) -> Box<dyn Emitter> {
    let light = SpotLight::place_astigmatic(&elliptic(rotation), placement, POWER);
    Box::new(light.expect("a valid light"))
}

/// Lines of every profile, with each of the two curves of focus and a waist of 50 µm.
pub(crate) fn lines(fan: FanGeometry) -> impl Iterator<Item = LaserLine> {
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    curves.into_iter().flat_map(move |focus_curve| {
        let fan = FanGeometry { focus_curve, ..fan };
        profiles(fan.fan_angle)
            .map(|profile| LaserLine::new(beam(50e-6), fan, profile).expect("a valid line"))
    })
}

/// Places a line as the light that its profile needs.
pub(crate) fn place<'a>(line: &'a LaserLine, placement: &Placement) -> Box<dyn Emitter + 'a> {
    match line.profile() {
        LineProfile::Tabulated(_) => {
            Box::new(TabulatedLineLight::place(line, placement, POWER).expect("a valid light"))
        }
        _ => Box::new(LineLight::place(line, placement, POWER).expect("a valid light")),
    }
}

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
    // Eight pieces more than that in each tenth of the fan, where a Powell profile rolls off.
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
            gauss(&[-end, end], 148, tan)
        }
        LineProfile::Tabulated(profile) => {
            let ends: Vec<f64> = profile.knots().iter().map(|knot| knot.angle).collect();
            gauss(&ends, 16, angle)
        }
        profile => panic!("no rule for {profile:?}"),
    }
}

/// The slope at which the light of the line ends, or has fallen off, on one side.
pub(crate) fn end_of(line: &LaserLine) -> f64 {
    match line.profile() {
        LineProfile::Tabulated(table) => table.knots().last().expect("a knot").angle.tan(),
        _ => line.half_slope(),
    }
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
