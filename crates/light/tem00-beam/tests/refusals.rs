//! Arguments that constructors refuse, by name.

use core::f64::consts::{FRAC_PI_2, PI};

use tem00_beam::{
    AngularProfile, AstigmaticBeam, DVec3, FanGeometry, FocusCurve, GaussianBeam, LaserLine,
    LineLight, LineProfile, LocatedBeam, Placement, SpotLight, TabulatedLineLight,
};
use tem00_testkit::refuses;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;
const RED: f64 = 650e-9;

fn beam() -> GaussianBeam {
    GaussianBeam::from_waist(RED, 1e-4).unwrap()
}

fn located(wavelength: f64) -> LocatedBeam {
    let beam = GaussianBeam::from_waist(wavelength, 1e-4).unwrap();
    LocatedBeam::new(beam, 0.0).unwrap()
}

#[test]
fn beams() {
    refuses!(wavelength = RED, waist_radius = 1e-4
        => GaussianBeam::from_waist(wavelength, waist_radius);
        wavelength: [0.0, -1.0, 1e-31, 1e31, NAN, INFINITE],
        waist_radius: [0.0, -1.0, 1e-31, 1e31, NAN, INFINITE, 4.13e-7],
    );
    refuses!(wavelength = RED, divergence = 0.5
        => GaussianBeam::from_divergence(wavelength, divergence);
        wavelength: [0.0, -1.0, 1e-31, 1e31, NAN, INFINITE],
        divergence: [0.0, -1e-3, 0.500_001, NAN, INFINITE],
        divergence as "waist_radius": [1e-300],
    );
    refuses!(m_squared = 1.0 => beam().with_m_squared(m_squared);
        m_squared: [0.999, -1.0, NAN, INFINITE],
        m_squared as "waist_radius": [250.0],
    );
    refuses!(growth = 2.0 => beam().depth_of_focus(growth); growth: [1.0, 0.5, NAN, INFINITE]);
    refuses!(waist_distance = -1e30 => LocatedBeam::new(beam(), waist_distance);
        waist_distance: [NAN, INFINITE, -2e30]);
    refuses!(y = RED => AstigmaticBeam::new(located(RED), located(y)); y as "wavelength": [532e-9]);
    let round = AstigmaticBeam::stigmatic(located(RED));
    refuses!(rotation = -9.0 => round.with_rotation(rotation); rotation: [NAN, INFINITE]);
    refuses!(z = [0.0, 0.1] => round.with_waist_distances(z);
        z as "waist_distance": [[0.0, INFINITE], [NAN, 0.0]]);
    refuses!(divergences = [0.1, 0.5] => AstigmaticBeam::from_divergences(RED, divergences);
        divergences as "divergence": [[0.1, 0.6], [0.0, 0.1]]);
}

/// A wavelength in nanometres: it, and not the radius, is what looks wrong.
#[test]
fn a_tight_waist_shows_the_limit_that_the_wavelength_sets() {
    let refusal = GaussianBeam::from_waist(650.0, 1e-3).unwrap_err();
    let expected = "waist_radius must be at least 2 M² λ / π = 413.8028520389279 m to be paraxial, \
        got 0.001 m";
    assert_eq!(refusal.to_string(), expected);
}

const FAN: FanGeometry = FanGeometry {
    fan_angle: 0.9,
    apex_offset: 2e-3,
    focus_distance: 0.2,
    focus_curve: FocusCurve::EqualPlane,
};

fn line(profile: LineProfile) -> LaserLine {
    LaserLine::new(beam(), FAN, profile).unwrap()
}

#[test]
fn lines() {
    let radius = line(LineProfile::GaussianTan).source_radius();
    refuses!(fan = FAN => LaserLine::new(beam(), fan, LineProfile::GaussianTan);
        fan.fan_angle: [0.0, -0.1, PI, NAN, INFINITE],
        fan.apex_offset: [0.0, -1e-3, 99.0 * radius, 1e31, NAN],
        fan.focus_distance: [NAN, INFINITE, -1e31],
    );
    refuses!(edge = 1.0 => LaserLine::new(beam(), FAN, LineProfile::Powell { edge });
        edge: [0.0, -0.1, 1.001, NAN]);
}

#[test]
fn tables_of_angles() {
    refuses!(angles = &[-0.3, 0.0, 0.3][..], powers = &[1.0, 0.0, 1.0][..]
        => AngularProfile::new(angles, powers);
        powers as "powers must be as many": [&[1.0, 1.0][..], &[1.0; 4]],
        powers as "powers must be greater than 0": [&[0.0; 3][..]],
        powers as "got -1e-300 at index 2": [&[1.0, 1.0, -1e-300][..]],
        powers as "got NaN at index 0": [&[NAN, 1.0, 1.0][..]],
        powers as "got inf at index 1": [&[0.0, INFINITE, 1.0][..]],
        angles as "angles must be ascending within (-π/2, π/2) rad, got -0.3 rad at index 1":
            [&[-0.3, -0.3, 0.3][..]],
        angles as "at index 1": [&[-0.3, -0.3 + 1e-13, 0.3][..]],
        angles as "at index 2": [&[-0.3, 0.0, FRAC_PI_2][..], &[-0.3, 0.0, NAN]],
        angles as "at index 0": [&[-FRAC_PI_2, 0.0, 0.3][..]],
    );
    refuses!(count = 2 => AngularProfile::new(&[0.0, 0.1][..count], &[1.0; 2][..count]);
        count as "powers": [0, 1]);
}

#[test]
fn placed_lights() {
    let placement = || Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    let nan = DVec3::new(0.0, NAN, 0.0);
    refuses!(waist_distance = 0.1, place = placement(), power = 1e100 =>
        SpotLight::place(&beam(), waist_distance, &place, power);
        waist_distance: [NAN, -INFINITE, 1e31],
        power: [-1e-3, 1e101, NAN, INFINITE],
        place.origin: [nan, DVec3::X * 1e31, DVec3::Z * INFINITE],
        place.direction: [nan, DVec3::ZERO, DVec3::Z * INFINITE],
        place.fan_axis: [nan, DVec3::ZERO, -DVec3::Z, 3.0 * DVec3::Z + DVec3::X * 1e-7],
    );
    let table = AngularProfile::new(&[-0.3, 0.3], &[1.0; 2]).unwrap();
    let table = || LineProfile::Tabulated(table.clone());
    refuses!(profile = LineProfile::GaussianTan, power = 1.0 =>
        LineLight::place(&line(profile), &placement(), power);
        power: [-1e-3, 1e101, NAN],
        profile as "line must be placed as a TabulatedLineLight": [table()],
    );
    refuses!(profile = table(), power = 1.0 =>
        TabulatedLineLight::place(&line(profile), &placement(), power).map(drop);
        power: [-1.0],
        profile as "line must be placed as a LineLight": [LineProfile::UniformAngle],
    );
}
