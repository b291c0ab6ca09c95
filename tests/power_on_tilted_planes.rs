//! Every plane that cuts a beam receives the power of the beam, at any tilt: what a renderer sums
//! up as `e_perp · |n · wi|` is the energy flow through the plane.

use std::f64::consts::PI;

use tem00::beam::{
    DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile,
    Placement, SpotLight,
};

const WAVELENGTH: f64 = 650e-9;
const POWER: f64 = 5e-3;
const DISTANCE: f64 = 0.2;

/// A laser at the origin that looks along +z and opens a line along x.
fn placement() -> Placement {
    Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    }
}

/// The plane through (0, 0, `DISTANCE`), tilted by `tilt` about the axis at `azimuth` to x.
struct Plane {
    normal: DVec3,
}

impl Plane {
    fn tilted(tilt: f64, azimuth: f64) -> Self {
        let along = DVec3::new(azimuth.cos(), azimuth.sin(), 0.0);
        let across = tilt.cos() * DVec3::Z.cross(along) + tilt.sin() * DVec3::Z;
        Self {
            normal: across.cross(along),
        }
    }

    /// The point of the plane on the ray from `apex` with the slopes `s` in x and y.
    fn on_ray(&self, apex: DVec3, s: [f64; 2]) -> (DVec3, f64) {
        let centre = DVec3::new(0.0, 0.0, DISTANCE);
        let direction = DVec3::new(s[0], s[1], 1.0);
        let along_ray = self.normal.dot(centre - apex) / self.normal.dot(direction);
        // The area of the plane per area of slopes.
        let jacobian = along_ray.powi(2) / self.normal.dot(direction).abs();
        (apex + along_ray * direction, jacobian)
    }
}

/// Integrates the power that arrives on a plane, over cells of the slopes seen from `apex`.
fn power_on(light: &impl Emitter<f64>, plane: &Plane, apex: DVec3, slopes: [f64; 2]) -> f64 {
    const CELLS: [i32; 2] = [400, 200];
    let step = [0, 1].map(|i| 2.0 * slopes[i] / f64::from(CELLS[i]));
    let mut power = 0.0;
    for j in 0..CELLS[1] {
        for i in 0..CELLS[0] {
            let s = [i - CELLS[0] / 2, j - CELLS[1] / 2];
            let s = [0, 1].map(|k| (f64::from(s[k]) + 0.5) * step[k]);
            let (point, jacobian) = plane.on_ray(apex, s);
            if let Some(event) = light.next_event(point.to_array()) {
                let cosine = plane.normal.dot(DVec3::from_array(event.wi)).abs();
                power += event.e_perp * cosine * jacobian * step[0] * step[1];
            }
        }
    }
    power
}

/// The allowed relative error. The midpoint rule is exponentially exact for a Gaussian; the tails
/// cut off at four beam radii hold e⁻³² of the power.
const TOLERANCE: f64 = 1e-6;

#[test]
fn a_spot_brings_its_power_to_every_plane() {
    let beam = GaussianBeam::from_waist(WAVELENGTH, 50e-6).expect("a valid beam");
    // The waist lies before the plane by much more than the Rayleigh range, 12 mm.
    let light = SpotLight::place(&beam, 0.05, &placement(), POWER).expect("a valid light");
    let apex = DVec3::new(0.0, 0.0, 0.05);
    for tilt in [0.0, 30.0, 60.0, 75.0_f64] {
        for azimuth in [0.0, 0.7, 0.5 * PI] {
            let plane = Plane::tilted(tilt.to_radians(), azimuth);
            let slope = 4.0 * beam.radius_at(DISTANCE - 0.05) / (DISTANCE - 0.05);
            // A tilted plane is reached at other distances, where the waist matters less or more.
            let power = power_on(&light, &plane, apex, [1.4 * slope; 2]);
            let error = power / POWER - 1.0;
            assert!(
                error.abs() < TOLERANCE,
                "tilt {tilt}°, azimuth {azimuth}: {error:e}"
            );
        }
    }
}

#[test]
fn a_line_brings_its_power_to_every_plane() {
    let focus = GaussianBeam::from_waist(WAVELENGTH, 0.1e-3).expect("a valid beam");
    let fan = FanGeometry {
        fan_angle: 10_f64.to_radians(),
        apex_offset: 5e-3,
        focus_distance: DISTANCE,
        focus_curve: FocusCurve::EqualDistance,
    };
    let half_slope = (0.5 * fan.fan_angle).tan();
    let apex = DVec3::new(0.0, 0.0, -fan.apex_offset);
    let profiles = [
        (LineProfile::GaussianTan, 3.2 * half_slope),
        (LineProfile::Powell { edge: 0.1 }, 1.8 * half_slope),
    ];
    for (profile, reach) in profiles {
        let line = LaserLine::new(focus, fan, profile.clone()).expect("a valid line");
        let light = LineLight::place(&line, &placement(), POWER).expect("a valid light");
        for tilt in [0.0, 30.0, 60.0, 75.0_f64] {
            // The plane leans along the line, where the far end is many times as far as the near
            // one at 75°, and across it.
            for azimuth in [0.0, 0.5 * PI] {
                let plane = Plane::tilted(tilt.to_radians(), azimuth);
                let widest = 4.2 * 0.25e-3 / DISTANCE;
                let power = power_on(&light, &plane, apex, [reach, widest]);
                let error = power / POWER - 1.0;
                assert!(
                    error.abs() < TOLERANCE,
                    "{profile:?}, tilt {tilt}°, azimuth {azimuth}: {error:e}"
                );
            }
        }
    }
}
