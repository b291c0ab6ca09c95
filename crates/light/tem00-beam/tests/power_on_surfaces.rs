//! A surface that cuts the whole light receives the whole power, whatever its shape and tilt:
//! planes, spheres and cylinders, and beams and lines of every profile, as laser and as placed
//! light.
//!
//! The power is the flux of the energy-flow vector through the surface. For a beam, and across a
//! line, it is summed by the trapezoidal rule, which converges faster than any power of the spacing
//! for a Gaussian: with a spacing of half a standard deviation the error is exp(−2π² · 4) ≈ 1e−34.
//! Along a line, where a profile may have edges and kinks, it is summed by Gauss's rule on pieces
//! between them. What lies beyond the range of integration is below 1e−14.

use proptest::prelude::*;
use tem00_beam::{
    AstigmaticBeam, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight,
    LocatedBeam, Placement, SpotLight, TabulatedLineLight,
};

use crate::lights::{REACH, profiles, slopes};

const WAVELENGTH: f64 = 650e-9;

/// The energy flow per watt at a point, both in the frame of the light.
type Flux<'a> = dyn Fn(DVec3) -> DVec3 + 'a;

/// A surface that is cut by a ray at most twice.
#[derive(Clone, Copy, Debug)]
enum Surface {
    Plane {
        point: DVec3,
        normal: DVec3,
    },
    Sphere {
        centre: DVec3,
        radius: f64,
    },
    Cylinder {
        centre: DVec3,
        axis: DVec3,
        radius: f64,
    },
}

impl Surface {
    /// Returns how far along `o + t d` the surface is left for good, and a vector along its normal.
    fn exit(&self, o: DVec3, d: DVec3) -> (f64, DVec3) {
        match *self {
            Self::Plane { point, normal } => ((point - o).dot(normal) / d.dot(normal), normal),
            Self::Sphere { centre, radius } => leave(o - centre, d, radius),
            Self::Cylinder {
                centre,
                axis,
                radius,
            } => {
                let from_axis = |v: DVec3| v - v.dot(axis) * axis;
                leave(from_axis(o - centre), from_axis(d), radius)
            }
        }
    }
}

/// The greater root t of |o + t d| = radius, and the vector there.
fn leave(o: DVec3, d: DVec3, radius: f64) -> (f64, DVec3) {
    let (a, half_b) = (d.length_squared(), o.dot(d));
    let root = (half_b * half_b - a * (o.length_squared() - radius * radius)).sqrt();
    let t = (root - half_b) / a;
    (t, o + t * d)
}

/// The nodes of the trapezoidal rule on [−half, half], and their weight.
fn trapezoid(half: f64, intervals: f64) -> (impl Iterator<Item = f64> + Clone, f64) {
    let h = 2.0 * half / intervals;
    let nodes = (0_u32..)
        .map(f64::from)
        .take_while(move |&i| i <= intervals);
    (nodes.map(move |i| i * h - half), h)
}

/// The power of a beam through a surface, which is covered by x and y.
fn power_of_beam(flux: &Flux<'_>, beam: &AstigmaticBeam, surface: &Surface) -> f64 {
    let hit = |x: f64, y: f64| surface.exit(DVec3::new(x, y, 0.0), DVec3::Z);
    let (z, n) = hit(0.0, 0.0);
    // A point at x from the axis is x tan τ further on, and w grows by δ at most.
    let steepness = (n.x.hypot(n.y) / n.z).abs();
    let [a, b] = beam.radii_at(z);
    let (long, short) = (a.max(b), a.min(b));
    let [a, b] = beam.axes().map(|axis| axis.beam().divergence());
    let divergence = a.max(b);
    let half = 1.1 * REACH * long / (1.0 - REACH * divergence * steepness);
    let intervals = (16.0 * half / short).ceil().clamp(160.0, 1_200.0);
    let (steps, h) = trapezoid(half, intervals);
    let mut power = 0.0;
    for x in steps.clone() {
        for y in steps.clone() {
            let (z, n) = hit(x, y);
            // ∂p/∂x × ∂p/∂y
            let area = n / n.z;
            power += flux(DVec3::new(x, y, z)).dot(area) * h * h;
        }
    }
    power
}

fn round(beam: GaussianBeam, waist_distance: f64) -> AstigmaticBeam {
    let located = LocatedBeam::new(beam, waist_distance).expect("a valid distance");
    AstigmaticBeam::stigmatic(located)
}

/// The power of a line through a surface, which is covered by the slope u = x / Z and by y.
fn power_of_line(flux: &Flux<'_>, line: &LaserLine, surface: &Surface) -> f64 {
    let apex = |y: f64| DVec3::new(0.0, y, -line.fan().apex_offset);
    let divergence = line.focus().divergence();
    let mut power = 0.0;
    for (u, du) in slopes(line) {
        let along = DVec3::new(u, 0.0, 1.0);
        // Z and its derivatives: the normal n is at right angles to the surface.
        let (z, n) = surface.exit(apex(0.0), along);
        let sec = 1.0_f64.hypot(u);
        let w = line
            .focus()
            .radius_at(z * sec - line.waist_slant_distance_at(u));
        // The slant distance, and with it w, changes with y along the surface.
        let change = divergence * sec * (n.y / n.dot(along)).abs();
        assert!(REACH * change < 1.0, "the fan must hit the surface");
        let (ys, dy) = trapezoid(1.1 * REACH * w / (1.0 - REACH * change), 80.0);
        for y in ys {
            let (z, n) = surface.exit(apex(y), along);
            let tilt = n.dot(along);
            let (z_u, z_y) = (-n.x * z / tilt, -n.y / tilt);
            let by_u = DVec3::new(z + u * z_u, 0.0, z_u);
            let by_y = DVec3::new(u * z_y, 1.0, z_y);
            power += flux(apex(y) + z * along).dot(by_u.cross(by_y)) * du * dy;
        }
    }
    power
}

/// A direction, tilted by `tilt` from z towards the azimuth `azimuth`, both in degrees.
fn tilted(tilt: f64, azimuth: f64) -> DVec3 {
    let (sin, cos) = tilt.to_radians().sin_cos();
    let azimuth = azimuth.to_radians();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

fn plane(distance: f64, normal: DVec3) -> Surface {
    Surface::Plane {
        point: DVec3::new(0.0, 0.0, distance),
        normal,
    }
}

/// A line of `fan_angle`, in degrees, with one of the profiles.
fn line(profile: usize, focus_curve: FocusCurve, fan_angle: f64, focus: [f64; 2]) -> LaserLine {
    let fan_angle = fan_angle.to_radians();
    let [focus_distance, waist] = focus;
    let fan = FanGeometry {
        fan_angle,
        apex_offset: 10e-3,
        focus_distance,
        focus_curve,
    };
    let focus = GaussianBeam::from_waist(WAVELENGTH, waist).expect("a valid beam");
    LaserLine::new(focus, fan, profiles(fan_angle)[profile].clone()).expect("a valid line")
}

fn curves() -> impl Strategy<Value = FocusCurve> {
    prop_oneof![
        Just(FocusCurve::EqualDistance),
        Just(FocusCurve::EqualPlane)
    ]
}

/// Waists from 20 µm to 1 mm: from 20 µm on, a plane at 75° cuts the whole beam.
fn waists() -> impl Strategy<Value = f64> {
    (20e-6_f64.ln()..1e-3_f64.ln()).prop_map(f64::exp)
}

/// Spheres and cylinders about the lens, the axis of the latter within 40° of the normal of the
/// fan.
fn round_surfaces() -> impl Strategy<Value = Surface> {
    let place = (
        -0.03..0.03_f64,
        -0.03..0.03_f64,
        -0.03..0.03_f64,
        0.15..0.4_f64,
    );
    (place, any::<bool>(), 0.0..40.0_f64, 0.0..360.0_f64).prop_map(
        |((x, y, z, radius), sphere, tilt, azimuth)| {
            let centre = DVec3::new(x, y, z);
            let axis = tilted(tilt, azimuth);
            let axis = DVec3::new(axis.x, axis.z, axis.y);
            if sphere {
                Surface::Sphere { centre, radius }
            } else {
                Surface::Cylinder {
                    centre,
                    axis,
                    radius,
                }
            }
        },
    )
}

/// The flow per watt of a light placed anywhere, in its own frame.
fn local_flux<'a>(light: &'a dyn Emitter, placement: &Placement) -> impl Fn(DVec3) -> DVec3 + 'a {
    let ez = placement.direction.normalize();
    let ex = placement.fan_axis.reject_from_normalized(ez).normalize();
    let (origin, ey) = (placement.origin, ez.cross(ex));
    move |p| {
        let world = origin + p.x * ex + p.y * ey + p.z * ez;
        let flux = DVec3::from(light.flux(world.to_array()));
        DVec3::new(flux.dot(ex), flux.dot(ey), flux.dot(ez))
    }
}

fn placements() -> impl Strategy<Value = Placement> {
    (0.0..180.0_f64, 0.0..360.0_f64, -0.5..0.5_f64).prop_map(|(tilt, azimuth, x)| {
        let direction = tilted(tilt, azimuth);
        Placement {
            origin: DVec3::new(x, 0.2, -0.1),
            direction,
            fan_axis: tilted(tilt + 90.0, azimuth) + 0.3 * direction,
        }
    })
}

/// Elliptic beams with two waists that stand up to 0.1 m apart, turned by any angle.
fn elliptic_beams() -> impl Strategy<Value = AstigmaticBeam> {
    let axis = || (0.2e-3..0.6e-3_f64, 1.0..1.5_f64, -0.05..0.05_f64);
    (axis(), axis(), 0.0..3.0_f64).prop_map(|(x, y, rotation)| {
        let [x, y] = [x, y].map(|(waist, m_squared, waist_distance)| {
            let beam = GaussianBeam::from_waist(WAVELENGTH, waist)
                .and_then(|beam| beam.with_m_squared(m_squared))
                .expect("a valid beam");
            LocatedBeam::new(beam, waist_distance).expect("a valid distance")
        });
        AstigmaticBeam::new(x, y)
            .and_then(|beam| beam.with_rotation(rotation))
            .expect("a valid beam")
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_tilted_plane_receives_the_power_of_a_beam(
        waist in waists(),
        m_squared in 1.0..1.5_f64,
        distance in 0.1..0.5_f64,
        waist_distance in -0.5..0.5_f64,
        tilt in 0.0..75.0_f64,
        azimuth in 0.0..360.0_f64,
    ) {
        let beam = GaussianBeam::from_waist(WAVELENGTH, waist)
            .and_then(|beam| beam.with_m_squared(m_squared))
            .expect("a valid beam");
        let flux = |p: DVec3| beam.flux_per_watt(p - DVec3::Z * waist_distance);
        let beam = round(beam, waist_distance);
        let power = power_of_beam(&flux, &beam, &plane(distance, tilted(tilt, azimuth)));
        prop_assert!((power - 1.0).abs() < 1e-6, "{power}");
    }

    #[test]
    fn any_surface_receives_the_power_of_a_placed_elliptic_beam(
        beam in elliptic_beams(),
        plane in (0.15..0.4_f64, 0.0..60.0_f64, 0.0..360.0_f64),
        round_surface in round_surfaces(),
        placement in placements(),
    ) {
        let spot = SpotLight::place_astigmatic(&beam, &placement, 1.0).expect("a valid light");
        let (distance, tilt, azimuth) = plane;
        let flat = Surface::Plane {
            point: DVec3::new(0.0, 0.0, distance),
            normal: tilted(tilt, azimuth),
        };
        for surface in [flat, round_surface] {
            let power = power_of_beam(&local_flux(&spot, &placement), &beam, &surface);
            prop_assert!((power - 1.0).abs() < 1e-6, "{surface:?}: {power}");
        }
    }

    /// A fan of up to 5° is cut as a whole by any plane of up to 75°.
    #[test]
    fn a_tilted_plane_receives_the_power_of_a_line(
        profile in 0..7_usize,
        focus_curve in curves(),
        fan_angle in 1.0..5.0_f64,
        waist in 30e-6..0.5e-3_f64,
        focus_distance in -0.1..0.4_f64,
        distance in 0.1..0.4_f64,
        tilt in 0.0..75.0_f64,
        azimuth in 0.0..360.0_f64,
    ) {
        let line = line(profile, focus_curve, fan_angle, [focus_distance, waist]);
        let surface = plane(distance, tilted(tilt, azimuth));
        let power = power_of_line(&|p| line.flux_per_watt(p), &line, &surface);
        prop_assert!((power - 1.0).abs() < 1e-6, "{power}");
    }

    /// A wide fan is cut as a whole by planes that contain its direction, if it ends before π/2.
    #[test]
    fn a_plane_tilted_about_the_line_receives_the_power_of_a_wide_fan(
        profile in 0..7_usize,
        focus_curve in curves(),
        fan_angle in 10.0..40.0_f64,
        distance in 0.1..0.4_f64,
        tilt in -75.0..75.0_f64,
    ) {
        // 4.2 half-widths of the Gaussian profiles in θ and sin θ reach π/2 from 42° and 27° on.
        let fan_angle = match profile {
            0 | 3..=6 => 2.25 * fan_angle,
            1 => fan_angle,
            _ => 0.6 * fan_angle,
        };
        let line = line(profile, focus_curve, fan_angle, [0.2, 0.1e-3]);
        let surface = plane(distance, tilted(tilt, 90.0));
        let power = power_of_line(&|p| line.flux_per_watt(p), &line, &surface);
        prop_assert!((power - 1.0).abs() < 1e-6, "{:?}: {power}", line.profile());
    }

    #[test]
    fn a_sphere_and_a_cylinder_receive_the_power_of_a_placed_line(
        profile in 0..7_usize,
        focus_curve in curves(),
        fan_angle in 1.0..20.0_f64,
        focus_distance in -0.1..0.4_f64,
        waist in 30e-6..0.5e-3_f64,
        surface in round_surfaces(),
        placement in placements(),
    ) {
        let line = line(profile, focus_curve, fan_angle, [focus_distance, waist]);
        let smooth = LineLight::place(&line, &placement, 1.0);
        let tabulated = TabulatedLineLight::place(&line, &placement, 1.0);
        let power = match (&smooth, &tabulated) {
            (Ok(light), _) => power_of_line(&local_flux(light, &placement), &line, &surface),
            (_, Ok(light)) => power_of_line(&local_flux(light, &placement), &line, &surface),
            (Err(error), _) => panic!("{error}"),
        };
        prop_assert!((power - 1.0).abs() < 1e-6, "{:?}, {surface:?}: {power}", line.profile());
    }
}
