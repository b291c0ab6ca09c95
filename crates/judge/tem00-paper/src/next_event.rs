use core::f64::consts::FRAC_2_PI;

use glam::DVec3;
use tem00_beam::{Axis, Emitter, GaussianBeam, LineLight, SpotLight};

/// The printed next-event estimation: a point of the aperture and the radiance from this point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedEvent {
    /// Point `s` of the aperture, found by the ratio of beam radii.
    pub point: [f64; 3],
    /// Distance to `point`, in metres.
    pub distance: f64,
    /// Unit vector towards `point`.
    pub wi: [f64; 3],
    /// `E / cos θ_s`, in W/m²: the coefficient of a delta distribution over directions.
    pub radiance: f64,
}

/// Returns the radiance of eq. (3), `L = E / cos θ_s`, in the unit of `irradiance`; `None` unless
/// the cosine is positive.
///
/// E is the irradiance of a plane perpendicular to the beam, eq. (2), and `θ_s` the angle between
/// the normal of the surface and the light.
///
/// # Validity
///
/// L has the unit W/m², not W/(m² sr): it is the coefficient of a delta distribution over
/// directions. Because of the division a surface of any tilt is as bright as if it faced the beam,
/// so that it receives `P / cos θ_s`: 1.15, 2.00 and 3.86 times the power at 30°, 60° and 75°,
/// without bound at grazing incidence. [`Emitter::next_event`] does not divide.
///
/// # Examples
///
/// ```
/// let tilted = tem00_paper::radiance(100.0, 60_f64.to_radians().cos());
/// assert!(tilted.is_some_and(|radiance| (radiance - 200.0).abs() < 1e-9));
/// assert_eq!(tem00_paper::radiance(100.0, -0.1), None);
/// ```
pub fn radiance(irradiance: f64, cos_surface: f64) -> Option<f64> {
    (cos_surface > 0.0).then(|| irradiance / cos_surface)
}

/// Returns the point of the aperture for `receiver`, by the ratio of beam radii (section 4, step
/// 3); both in the frame of the beam with the waist at z = 0.
///
/// ```text
/// (x w_A / w_R, y w_A / w_R, z_A)
/// ```
///
/// # Validity
///
/// The point lies exactly on the streamline of energy, a hyperbola. The straight line between the
/// two points is not the direction of the flow: with a waist between them, or at the receiver, it
/// deviates by up to the whole divergence. This matters for shadows, and hardly for reflection.
pub fn streamline_point(beam: &GaussianBeam, receiver: DVec3, aperture_z: f64) -> DVec3 {
    let ratio = beam.radius_at(aperture_z) / beam.radius_at(receiver.z);
    DVec3::new(receiver.x * ratio, receiver.y * ratio, aperture_z)
}

/// Returns the printed next-event estimation of a laser spot at `p`, a point of a surface with the
/// unit normal `n`; `None` outside the cut-off, behind the aperture, or on the unlit side.
///
/// See [`radiance`] and [`streamline_point`] for its errors.
pub fn spot_next_event(light: &SpotLight, p: [f64; 3], n: [f64; 3]) -> Option<PrintedEvent> {
    let irradiance = Some(light.irradiance(p)).filter(|&e| e > 0.0)?;
    let frame = Frame::new(light.origin, [light.ex, light.ey, light.ez]);
    let [x, y, z] = frame.local(p);
    let ratio = |axis: &Axis| (axis.radius_sq_at(0.0) / axis.radius_sq_at(z)).sqrt();
    let aperture = [x * ratio(&light.x), y * ratio(&light.y)];
    printed_event(frame.aperture_point(aperture), p, n, irradiance)
}

/// Returns the printed next-event estimation of a laser line at `p`, a point of a surface with the
/// unit normal `n`; `None` outside the cut-off, at or behind the lens, or on the unlit side.
///
/// The fan is a [`PrintedFan`](crate::PrintedFan), which has only the Gaussian profile. The ratio
/// of beam radii is applied to the scaled coordinate x′: the unscaled coordinate would end outside
/// the aperture. See [`radiance`] for its other errors.
pub fn line_next_event(light: &LineLight, p: [f64; 3], n: [f64; 3]) -> Option<PrintedEvent> {
    let frame = Frame::new(light.origin, [light.ex, light.ey, light.ez]);
    let [x, y, z] = frame.local(p);
    if z <= 0.0 {
        return None;
    }
    let w_sq = light.y.radius_sq_at(z + light.apex_offset);
    let x = x * w_sq.sqrt() / (light.half_slope * z);
    let rho_sq = (x * x + y * y) / w_sq;
    if rho_sq > light.cutoff * light.cutoff {
        return None;
    }
    let irradiance = FRAC_2_PI * light.power / w_sq * (-2.0 * rho_sq).exp();
    let ratio = (light.y.radius_sq_at(light.apex_offset) / w_sq).sqrt();
    let point = frame.aperture_point([x * ratio, y * ratio]);
    printed_event(point, p, n, irradiance)
}

/// The frame of a placed light.
struct Frame {
    origin: DVec3,
    axes: [DVec3; 3],
}

impl Frame {
    fn new(origin: [f64; 3], axes: [[f64; 3]; 3]) -> Self {
        Self {
            origin: DVec3::from(origin),
            axes: axes.map(DVec3::from),
        }
    }

    fn local(&self, p: [f64; 3]) -> [f64; 3] {
        let from_origin = DVec3::from(p) - self.origin;
        self.axes.map(|axis| from_origin.dot(axis))
    }

    fn aperture_point(&self, [x, y]: [f64; 2]) -> DVec3 {
        let [ex, ey, _] = self.axes;
        self.origin + (x * ex + y * ey)
    }
}

fn printed_event(point: DVec3, p: [f64; 3], n: [f64; 3], irradiance: f64) -> Option<PrintedEvent> {
    let towards = point - DVec3::from(p);
    let wi = towards.try_normalize()?;
    Some(PrintedEvent {
        point: point.to_array(),
        distance: towards.length(),
        wi: wi.to_array(),
        radiance: radiance(irradiance, wi.dot(DVec3::from(n)))?,
    })
}

#[cfg(test)]
mod tests {
    use tem00_beam::{FanGeometry, FocusCurve, LaserLine, LineProfile, Placement};

    use tem00_testkit::assert_relative;

    use super::*;
    use crate::PrintedFan;

    const PLACEMENT: Placement = Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };

    const GEOMETRY: FanGeometry = FanGeometry {
        fan_angle: 0.5,
        apex_offset: 2e-3,
        focus_distance: 0.1,
        focus_curve: FocusCurve::EqualDistance,
    };

    fn beam() -> GaussianBeam {
        GaussianBeam::from_waist(650e-9, 50e-6).unwrap()
    }

    #[test]
    fn a_tilted_surface_receives_too_much_by_the_cosine() {
        const NODES: i32 = 48;
        for degrees in [0.0_f64, 30.0, 60.0, 75.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let h = 4.3 * beam().radius_at(0.3) / f64::from(NODES);
            let mut power = 0.0;
            for i in -NODES..=NODES {
                for j in -NODES..=NODES {
                    // A node (s, t) of the surface, s along the tilt.
                    let (s, t) = (f64::from(i) * h / cos, f64::from(j) * h);
                    let r = (s * cos).hypot(t);
                    let printed = radiance(beam().irradiance_per_watt(r, 0.3 + s * sin), cos);
                    power += printed.unwrap() * cos * h * h / cos;
                }
            }
            // The beam widens along the surface, which adds an error of the square of δ tan τ / 2.
            let tolerance = (beam().divergence() * sin / cos).powi(2) / 2.0 + 1e-12;
            assert!((power * cos - 1.0).abs() < tolerance, "{degrees}°: {power}");
        }
    }

    #[test]
    fn the_ratio_of_radii_follows_the_energy() {
        // dx/dz = F_x / F_z from the receiver back to the aperture, by the Runge–Kutta method.
        const STEPS: u32 = 2_000;
        let (start, end) = (0.12, -0.15);
        let h = (end - start) / f64::from(STEPS);
        let slope = |x: f64, z: f64| {
            let flux = beam().flux_per_watt(DVec3::new(x, 0.0, z));
            flux.x / flux.z
        };
        let receiver = DVec3::new(3e-4, 0.0, start);
        let mut x = receiver.x;
        for i in 0..STEPS {
            let z = start + f64::from(i) * h;
            let k1 = slope(x, z);
            let k2 = slope(x + 0.5 * h * k1, z + 0.5 * h);
            let k3 = slope(x + 0.5 * h * k2, z + 0.5 * h);
            let k4 = slope(x + h * k3, z + h);
            x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        let point = streamline_point(&beam(), receiver, end);
        // The error is (h / z_R)⁴ = 2e−8 per Rayleigh range, over 20 Rayleigh ranges; most of it
        // cancels.
        assert!((x / point.x - 1.0).abs() < 1e-8, "{x:e}, {:e}", point.x);
    }

    #[test]
    fn printed_spot_is_brighter_than_the_correct_one_by_the_inverse_cosine() {
        let light = SpotLight::place(&beam(), 0.1, &PLACEMENT, 2e-3).unwrap();
        let p = [1e-4, 2e-4, 0.15];
        let n = DVec3::new(0.6, 0.0, -0.8);
        let printed = spot_next_event(&light, p, n.to_array()).unwrap();
        let aperture = streamline_point(&beam(), DVec3::new(1e-4, 2e-4, 0.05), -0.1);
        let expected = DVec3::new(aperture.x, aperture.y, 0.0);
        let miss = expected.distance(DVec3::from(printed.point));
        assert!(miss < 1e-17, "{printed:?}: {miss:e}");
        let cos = DVec3::from(printed.wi).dot(n);
        let e = light.irradiance(p);
        assert_relative(printed.radiance * cos, e, 1e-14);
        let back = DVec3::from(p) + DVec3::from(printed.wi) * printed.distance;
        assert!(back.distance(expected) < 1e-16, "{printed:?}");
    }

    #[test]
    fn printed_line_is_the_printed_fan() {
        for profile in [LineProfile::GaussianTan, LineProfile::Powell { edge: 0.1 }] {
            let line = LaserLine::new(beam(), GEOMETRY, profile.clone()).unwrap();
            let light = LineLight::place(&line, &PLACEMENT, 2e-3).unwrap();
            let fan = PrintedFan::new(&line);
            let p = DVec3::new(0.01, 2e-4, 0.15);
            let printed = line_next_event(&light, p.to_array(), [0.0, 0.0, -1.0]).unwrap();
            let e = printed.radiance * -printed.wi[2];
            let expected = 2e-3 * fan.irradiance_per_watt(p);
            assert_relative(e, expected, 1e-13);
            let within = DVec3::from(printed.point).length() / beam().radius_at(0.1);
            assert!(within < 1.0, "the point is inside the aperture: {within}");
        }
    }

    #[test]
    fn unlit_points_have_no_event() {
        let spot = SpotLight::place(&beam(), 0.1, &PLACEMENT, 2e-3).unwrap();
        let line = LaserLine::new(beam(), GEOMETRY, LineProfile::GaussianTan).unwrap();
        let line = LineLight::place(&line, &PLACEMENT, 2e-3).unwrap();
        let (facing, away) = ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
        // On the back side, beyond the cut-off, and behind the aperture or at the lens.
        for (p, n) in [([0.0, 0.0, 0.1], away), ([0.1, 0.0, 0.1], facing)] {
            assert!(spot_next_event(&spot, p, n).is_none(), "{p:?}");
        }
        for (p, n) in [([0.0, 0.0, 0.1], away), ([0.0, 0.1, 0.1], facing)] {
            assert!(line_next_event(&line, p, n).is_none(), "{p:?}");
        }
        assert_eq!(
            spot_next_event(&spot, [0.0, 0.0, -0.1], facing),
            None,
            "behind"
        );
        assert_eq!(
            line_next_event(&line, [0.0; 3], facing),
            None,
            "at the lens"
        );
    }
}
