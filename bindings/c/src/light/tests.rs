//! The functions of a light against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod descriptions;
mod questions;
mod refusals;

use core::{f64::consts::FRAC_PI_4, ptr};

use tem00_beam::{
    AngularProfile, AstigmaticBeam, DVec3, FanGeometry, GaussianBeam, LaserLine, LocatedBeam,
};

use super::*;
use crate::{
    status::Status,
    testing::{each_is_refused, last_parameter, number_is_refused, pointer_is_refused},
};

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
    angles: ptr::null(),
    powers: ptr::null(),
    knot_count: 0,
};

fn tabulated() -> LineDescription {
    LineDescription {
        profile: LineProfile::Tabulated as u32,
        angles: ANGLES.as_ptr(),
        powers: POWERS.as_ptr(),
        knot_count: 4,
        ..LINE
    }
}

/// A light that frees itself, and one made by the library itself.
struct Pair {
    name: &'static str,
    handle: *mut Light,
    peer: Peer,
}

/// Results of the library without the interface.
enum Peer {
    Spot(SpotLight),
    Line(LineLight),
    Tabulated(LaserLine),
}

impl Drop for Pair {
    fn drop(&mut self) {
        // SAFETY: it was created below and is not used again.
        unsafe { tem00_light_destroy(self.handle) };
    }
}

fn placement() -> tem00_beam::Placement {
    tem00_beam::Placement {
        origin: DVec3::new(0.1, -0.2, 0.3),
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

fn beam(waist_radius: f64, m_squared: f64) -> GaussianBeam {
    let beam = GaussianBeam::from_waist(650e-9, waist_radius).unwrap();
    beam.with_m_squared(m_squared).unwrap()
}

fn laser_line(profile: tem00_beam::LineProfile) -> LaserLine {
    let fan = FanGeometry {
        fan_angle: 0.5,
        apex_offset: 2e-3,
        focus_distance: 0.25,
        focus_curve: tem00_beam::FocusCurve::EqualPlane,
    };
    LaserLine::new(beam(80e-6, 1.2), fan, profile).unwrap()
}

fn elliptic_peer() -> Peer {
    let x = LocatedBeam::new(beam(80e-6, 1.3), 0.2).unwrap();
    let y = LocatedBeam::new(beam(50e-6, 1.1), -0.1).unwrap();
    let beam = AstigmaticBeam::new(x, y).unwrap();
    let beam = beam.with_rotation(FRAC_PI_4).unwrap();
    Peer::Spot(SpotLight::place_astigmatic(&beam, &placement(), 4e-3).unwrap())
}

/// All kinds of lights, by the interface and by the library.
fn pairs() -> [Pair; 4] {
    let spot = SpotLight::place(&beam(80e-6, 1.3), 0.2, &placement(), 5e-3).unwrap();
    let line = laser_line(tem00_beam::LineProfile::Powell { edge: 0.1 });
    let profile = AngularProfile::new(&ANGLES, &POWERS).unwrap();
    let table = laser_line(tem00_beam::LineProfile::Tabulated(profile));
    let made = |name, create: &dyn Fn(*mut *mut Light) -> Status, peer| {
        let mut handle = ptr::null_mut();
        assert_eq!(create(&raw mut handle), Status::Ok, "{name}");
        Pair { name, handle, peer }
    };
    let line = LineLight::place(&line, &placement(), 2e-3).unwrap();
    // SAFETY: the descriptions are valid, and the handle has a place.
    unsafe {
        [
            made(
                "spot",
                &|p| tem00_light_create_spot(&SPOT, p),
                Peer::Spot(spot),
            ),
            made(
                "elliptic",
                &|p| tem00_light_create_elliptic(&ELLIPTIC, p),
                elliptic_peer(),
            ),
            made(
                "line",
                &|p| tem00_light_create_line(&LINE, p),
                Peer::Line(line),
            ),
            made(
                "tabulated",
                &|p| tem00_light_create_line(&tabulated(), p),
                Peer::Tabulated(table),
            ),
        ]
    }
}

impl Peer {
    fn ask<R>(&self, question: impl FnOnce(&dyn Emitter) -> R) -> R {
        match self {
            Self::Spot(light) => question(light),
            Self::Line(light) => question(light),
            Self::Tabulated(line) => {
                question(&TabulatedLineLight::place(line, &placement(), 2e-3).unwrap())
            }
        }
    }

    /// Points on rays of the light, beside it and behind it.
    fn points(&self) -> Vec<[f64; 3]> {
        let mut variates = Variates(1);
        let mut points = vec![[0.0; 3], [0.1, -0.2, 0.3], [1e30, -1e30, 1e30]];
        for _ in 0..40 {
            let ray = self.ask(|light| light.sample_ray([(); 4].map(|()| variates.next())));
            let distance = variates.next() - 0.1;
            points.push(core::array::from_fn(|i| {
                ray.origin[i] + distance * ray.direction[i]
            }));
        }
        points
    }
}

/// Uniform numbers of the generator of Steele, Lea and Flood (2014).
struct Variates(u64);

impl Variates {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let bits = u32::try_from((z ^ (z >> 31)) >> 32).unwrap();
        f64::from(bits) / 4_294_967_296.0
    }
}
