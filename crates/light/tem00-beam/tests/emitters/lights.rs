//! Lights at the origin that shine along z, so that world coordinates are theirs.

use tem00_beam::{
    AstigmaticBeam, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight,
    LineProfile, LocatedBeam, Placement, SpotLight, TabulatedLineLight,
};

use crate::lines::profiles;

pub(crate) const PLACEMENT: Placement = Placement {
    origin: DVec3::ZERO,
    direction: DVec3::Z,
    fan_axis: DVec3::X,
};
pub(crate) const POWER: f64 = 5e-3;
pub(crate) fn beam(waist: f64) -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, waist).expect("a valid beam")
}

/// A line 1 mm long on its lens, so that its source is as wide as tests can resolve.
pub(crate) fn fans() -> impl Iterator<Item = LaserLine> {
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    curves.into_iter().flat_map(|focus_curve| {
        let fan = FanGeometry {
            fan_angle: 0.5,
            apex_offset: 1e-3,
            focus_distance: 0.1,
            focus_curve,
        };
        profiles(fan.fan_angle)
            .map(|profile| LaserLine::new(beam(50e-6), fan, profile).expect("a valid line"))
    })
}

/// Places a line as the light that its profile needs.
pub(crate) fn place(line: &LaserLine) -> Box<dyn Emitter + '_> {
    match line.profile() {
        LineProfile::Tabulated(_) => {
            Box::new(TabulatedLineLight::place(line, &PLACEMENT, POWER).expect("a valid light"))
        }
        _ => Box::new(LineLight::place(line, &PLACEMENT, POWER).expect("a valid light")),
    }
}

/// An elliptic beam with its waists apart.
pub(crate) fn elliptic() -> Box<dyn Emitter> {
    let axes = [(30e-6, 0.05), (60e-6, -0.02)];
    let axes = axes.map(|(w, z)| LocatedBeam::new(beam(w), z).expect("a valid beam"));
    let beam = AstigmaticBeam::new(axes[0], axes[1]).expect("a valid beam");
    Box::new(SpotLight::place_astigmatic(&beam, &PLACEMENT, POWER).expect("a valid light"))
}

/// The slope at which the light of the line ends, or has fallen off, on one side.
pub(crate) fn end_of(line: &LaserLine) -> f64 {
    match line.profile() {
        LineProfile::Tabulated(table) => table.knots().last().expect("a knot").angle.tan(),
        _ => line.half_slope(),
    }
}
