//! The functions of a light against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod answers;
mod descriptions;
mod refusals;

use core::{f64::consts::FRAC_PI_4, ptr::null};

use tem00_beam::{
    AngularProfile, AstigmaticBeam, FanGeometry, GaussianBeam, LaserLine, LocatedBeam,
};
use tem00_testkit::Numbers;

use super::*;
use crate::testing::Owned;

const ANGLES: [f64; 4] = [-0.4, -0.2, 0.3, 0.5];
const POWERS: [f64; 4] = [0.0, 1.0, 0.7, 0.1];

const PLACEMENT: Placement = Placement {
    origin: [0.1, -0.2, 0.3],
    direction: [0.3, -0.5, 0.8],
    fan_axis: [1.0, 0.2, 0.1],
};

const SPOT: SpotDescription = SpotDescription {
    placement: PLACEMENT,
    wavelength: 650e-9,
    power: 5e-3,
    waist_radius: 80e-6,
    waist_distance: 0.2,
    m_squared: 1.3,
};

const ELLIPTIC: EllipticDescription = EllipticDescription {
    placement: PLACEMENT,
    wavelength: 650e-9,
    power: 4e-3,
    waist_radius: [80e-6, 50e-6],
    waist_distance: [0.2, -0.1],
    m_squared: [1.3, 1.1],
    rotation: FRAC_PI_4,
};

const LINE: LineDescription = LineDescription {
    placement: PLACEMENT,
    wavelength: 650e-9,
    power: 2e-3,
    waist_radius: 80e-6,
    m_squared: 1.2,
    fan_angle: 0.5,
    apex_offset: 2e-3,
    focus_distance: 0.25,
    focus_curve: FocusCurve::EqualPlane as u32,
    profile: LineProfile::Powell as u32,
    edge: 0.1,
    angles: null(),
    powers: null(),
    knot_count: 0,
};

const TABULATED: LineDescription = LineDescription {
    profile: LineProfile::Tabulated as u32,
    angles: (&raw const ANGLE_TABLE).cast(),
    powers: (&raw const POWER_TABLE).cast(),
    knot_count: 4,
    ..LINE
};

static ANGLE_TABLE: [f64; 4] = ANGLES;
static POWER_TABLE: [f64; 4] = POWERS;

fn spot() -> Owned<Light> {
    Owned::new(tem00_light_create_spot, &SPOT, tem00_light_destroy)
}

fn line(description: &LineDescription) -> Owned<Light> {
    Owned::new(tem00_light_create_line, description, tem00_light_destroy)
}

fn placement() -> tem00_beam::Placement {
    tem00_beam::Placement {
        origin: PLACEMENT.origin.into(),
        direction: PLACEMENT.direction.into(),
        fan_axis: PLACEMENT.fan_axis.into(),
    }
}

fn beam(waist_radius: f64, m_squared: f64) -> GaussianBeam {
    let beam = GaussianBeam::from_waist(650e-9, waist_radius).unwrap();
    beam.with_m_squared(m_squared).unwrap()
}

fn laser_line(profile: tem00_beam::LineProfile, focus_curve: tem00_beam::FocusCurve) -> LaserLine {
    let fan = FanGeometry {
        fan_angle: 0.5,
        apex_offset: 2e-3,
        focus_distance: 0.25,
        focus_curve,
    };
    LaserLine::new(beam(80e-6, 1.2), fan, profile).unwrap()
}

fn elliptic_peer() -> SpotLight {
    let x = LocatedBeam::new(beam(80e-6, 1.3), 0.2).unwrap();
    let y = LocatedBeam::new(beam(50e-6, 1.1), -0.1).unwrap();
    let beam = AstigmaticBeam::new(x, y).unwrap();
    let beam = beam.with_rotation(FRAC_PI_4).unwrap();
    SpotLight::place_astigmatic(&beam, &placement(), 4e-3).unwrap()
}

/// A light by the interface, the same by the library, and its plain data.
struct Pair {
    light: Owned<Light>,
    peer: Box<dyn Emitter>,
    kind: LightKind,
    rows: Vec<f32>,
}

/// All kinds of lights.
fn pairs() -> [Pair; 4] {
    let place = placement();
    let round = SpotLight::place(&beam(80e-6, 1.3), 0.2, &place, 5e-3).unwrap();
    let elliptic = Owned::new(tem00_light_create_elliptic, &ELLIPTIC, tem00_light_destroy);
    let spot = |light, peer: SpotLight| Pair {
        light,
        rows: peer.to_rows_f32().concat(),
        peer: Box::new(peer),
        kind: LightKind::Spot,
    };
    let curve = tem00_beam::FocusCurve::EqualPlane;
    let powell = laser_line(tem00_beam::LineProfile::Powell { edge: 0.1 }, curve);
    let powell = LineLight::place(&powell, &place, 2e-3).unwrap();
    let profile = AngularProfile::new(&ANGLES, &POWERS).unwrap();
    let table = laser_line(tem00_beam::LineProfile::Tabulated(profile), curve);
    let table = TabulatedLineLight::place(Box::leak(Box::new(table)), &place, 2e-3).unwrap();
    [
        spot(self::spot(), round),
        spot(elliptic, elliptic_peer()),
        Pair {
            light: line(&LINE),
            rows: powell.to_rows_f32().concat(),
            peer: Box::new(powell),
            kind: LightKind::Line,
        },
        Pair {
            light: line(&TABULATED),
            rows: table.line.to_rows_f32().concat(),
            peer: Box::new(table),
            kind: LightKind::TabulatedLine,
        },
    ]
}

/// Points on rays of a light, beside it and behind it.
fn points(light: &dyn Emitter) -> Vec<[f64; 3]> {
    let mut variates = Numbers::new(1);
    let mut points = vec![[0.0; 3], [0.1, -0.2, 0.3], [1e30, -1e30, 1e30]];
    for _ in 0..40 {
        let ray = light.sample_ray(variates.units());
        let distance = variates.unit() - 0.1;
        let point = |i| ray.origin[i] + distance * ray.direction[i];
        points.push(core::array::from_fn(point));
    }
    points
}
