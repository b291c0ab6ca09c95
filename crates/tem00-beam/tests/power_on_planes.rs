//! A plane that cuts the whole beam receives the whole power, whatever its tilt.
//!
//! The power is the flux of the energy-flow vector through the plane, by the trapezoidal rule,
//! which converges faster than any power of the spacing for these profiles: with a spacing of half
//! a standard deviation the error is exp(−2π² · 4) ≈ 1e−34. What lies beyond the range of
//! integration is below 1e−14.
#![expect(clippy::expect_used, reason = "helpers of tests")]

use proptest::prelude::*;
use tem00_beam::{DVec3, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineProfile};

const WAVELENGTH: f64 = 650e-9;
/// Beam radii that hold all but exp(−2 · 4.2²) = 5e−16 of the power.
const REACH: f64 = 4.2;

/// The nodes of the trapezoidal rule on [−half, half], and their weight.
fn nodes(half: f64, intervals: u32) -> (impl Iterator<Item = f64>, f64) {
    let h = 2.0 * half / f64::from(intervals);
    ((0..=intervals).map(move |i| f64::from(i) * h - half), h)
}

/// The normal of a plane, tilted by `tilt` from the beam towards the azimuth `azimuth`.
fn tilted_normal(tilt: f64, azimuth: f64) -> DVec3 {
    DVec3::new(
        tilt.sin() * azimuth.cos(),
        tilt.sin() * azimuth.sin(),
        tilt.cos(),
    )
}

/// The power of `flux` through the plane through (0, 0, `distance`) with the normal `n`.
fn power_of_beam(beam: &GaussianBeam, distance: f64, n: DVec3) -> f64 {
    let across = n.any_orthonormal_vector();
    let along = n.cross(across);
    // A point at s on the plane is s cos τ off the axis; w grows by δ s sin τ at most.
    let slack = n.z - REACH * beam.divergence() * (1.0 - n.z * n.z).sqrt();
    let half = REACH * beam.radius_at(distance) / slack;
    let (steps, h) = nodes(half, 120);
    let steps: Vec<f64> = steps.collect();
    let centre = DVec3::new(0.0, 0.0, distance);
    let flux = |s: f64, t: f64| beam.flux_per_watt(centre + s * across + t * along).dot(n);
    steps
        .iter()
        .flat_map(|&s| steps.iter().map(move |&t| (s, t)))
        .map(|(s, t)| flux(s, t))
        .sum::<f64>()
        * h
        * h
}

/// The power of the line through the plane through (0, 0, `distance`) with the normal `n`.
///
/// The plane is covered by the slope u = x / Z and by y. From `n · p = n_z d` follows
/// `Z (n_z + n_x u) = n_z (d + z_a) − n_y y`.
fn power_of_line(line: &LaserLine, distance: f64, n: DVec3) -> f64 {
    let z_a = line.fan().apex_offset;
    let (reach_u, intervals) = match line.profile() {
        LineProfile::Powell { edge } => {
            (1.0 + 8.2 * edge, (4.0 * (1.0 + 8.2 * edge) / edge).ceil())
        }
        _ => (REACH, 40.0),
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small count"
    )]
    let (slopes, h_u) = nodes(reach_u * line.half_slope(), intervals as u32);
    let mut power = 0.0;
    for u in slopes {
        let tilt = n.z + n.x * u;
        assert!(tilt > 0.0, "the fan must hit the plane");
        let sec = 1.0_f64.hypot(u);
        let axis = n.z * (distance + z_a) / tilt;
        let w = line
            .focus()
            .radius_at(axis * sec - line.waist_slant_distance());
        // The slant distance, and with it w, changes with y along the plane.
        let change = line.focus().divergence() * sec * (n.y / tilt).abs();
        let (ys, h_y) = nodes(REACH * w / (1.0 - REACH * change), 60);
        for y in ys {
            let z = (n.z * (distance + z_a) - n.y * y) / tilt;
            let (z_u, z_y) = (-z * n.x / tilt, -n.y / tilt);
            let by_u = DVec3::new(z + u * z_u, 0.0, z_u);
            let by_y = DVec3::new(u * z_y, 1.0, z_y);
            let flux = line.flux_per_watt(DVec3::new(u * z, y, z - z_a));
            power += flux.dot(by_u.cross(by_y)) * h_u * h_y;
        }
    }
    power
}

fn line(fan_angle: f64, focus_distance: f64, waist: f64, profile: LineProfile) -> LaserLine {
    let fan = FanGeometry {
        fan_angle,
        apex_offset: 10e-3,
        focus_distance,
        focus_curve: FocusCurve::EqualDistance,
    };
    LaserLine::new(
        GaussianBeam::from_waist(WAVELENGTH, waist).expect("a valid beam"),
        fan,
        profile,
    )
    .expect("a valid line")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// From 20 µm on, the divergence is small enough for a plane at 75° to cut the whole beam.
    #[test]
    fn a_tilted_plane_receives_the_power_of_a_beam(
        waist in (20e-6_f64.ln()..1e-3_f64.ln()).prop_map(f64::exp),
        m_squared in 1.0..1.5_f64,
        distance in -0.5..0.5_f64,
        tilt in 0.0..75.0_f64,
        azimuth in 0.0..360.0_f64,
    ) {
        let beam = GaussianBeam::from_waist(WAVELENGTH, waist)
            .and_then(|beam| beam.with_m_squared(m_squared))
            .expect("a valid beam");
        let n = tilted_normal(tilt.to_radians(), azimuth.to_radians());
        let power = power_of_beam(&beam, distance, n);
        prop_assert!((power - 1.0).abs() < 1e-6, "{power}");
    }

    /// A fan of up to 5° is cut as a whole by any plane of up to 75°.
    #[test]
    fn a_tilted_plane_receives_the_power_of_a_line(
        fan_angle in 1.0..5.0_f64,
        waist in 30e-6..0.5e-3_f64,
        focus_distance in -0.1..0.4_f64,
        distance in 0.1..0.4_f64,
        tilt in 0.0..75.0_f64,
        azimuth in 0.0..360.0_f64,
        powell in any::<bool>(),
    ) {
        let profile = if powell {
            LineProfile::Powell { edge: 0.08 }
        } else {
            LineProfile::GaussianTan
        };
        let line = line(fan_angle.to_radians(), focus_distance, waist, profile);
        let n = tilted_normal(tilt.to_radians(), azimuth.to_radians());
        let power = power_of_line(&line, distance, n);
        prop_assert!((power - 1.0).abs() < 1e-6, "{power}");
    }

    /// A wide fan is cut as a whole by planes that contain its direction.
    #[test]
    fn a_plane_tilted_about_the_line_receives_the_power_of_a_wide_fan(
        fan_angle in 10.0..90.0_f64,
        distance in 0.1..0.4_f64,
        tilt in -75.0..75.0_f64,
        powell in any::<bool>(),
    ) {
        let profile = if powell {
            LineProfile::Powell { edge: 0.05 }
        } else {
            LineProfile::GaussianTan
        };
        let line = line(fan_angle.to_radians(), 0.2, 0.1e-3, profile);
        let n = tilted_normal(tilt.to_radians(), core::f64::consts::FRAC_PI_2);
        let power = power_of_line(&line, distance, n);
        prop_assert!((power - 1.0).abs() < 1e-6, "{power}");
    }
}
