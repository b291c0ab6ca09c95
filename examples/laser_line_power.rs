//! How much of a laser line's power does a tilted plane receive?
//!
//! All of it, whatever the tilt. Prints the power found by adding up the irradiance over the plane,
//! with correct physics and with the formulas as printed in Bergmann et al. 2016.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

use tem00::beam::{
    BeamError, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight,
    LineProfile, Placement,
};
use tem00_paper as paper;

const NODES: i32 = 200;

/// Adds up `irradiance(point, normal)` over a plane 200 mm from the lens, tilted about the line by
/// `tilt`: 110 mm along the line and 1 mm across it, as seen from the laser.
fn power(tilt: f64, irradiance: impl Fn(DVec3, DVec3) -> f64) -> f64 {
    let (sin, cos) = tilt.sin_cos();
    let normal = DVec3::new(0.0, sin, -cos);
    let [along, across] = [110e-3, 1e-3 / cos].map(|half: f64| half / f64::from(NODES));
    let at = |i: i32, j: i32| {
        let (s, t) = (f64::from(i) * along, f64::from(j) * across);
        irradiance(DVec3::new(s, t * cos, 0.2 + t * sin), normal)
    };
    let row = |i| (-NODES..=NODES).map(|j| at(i, j)).sum::<f64>();
    (-NODES..=NODES).map(row).sum::<f64>() * along * across
}

fn main() -> Result<(), BeamError> {
    let fan = FanGeometry {
        fan_angle: 20_f64.to_radians(),
        apex_offset: 2e-3,
        focus_distance: 0.2,
        focus_curve: FocusCurve::EqualDistance,
    };
    let focus = GaussianBeam::from_waist(650e-9, 0.1e-3)?;
    let line = LaserLine::new(focus, fan, LineProfile::GaussianTan)?;
    let placement = Placement {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
        fan_axis: DVec3::X,
    };
    let light = LineLight::place(&line, &placement, 1.0)?;

    let excess = paper::PrintedFan::new(&line).power_per_watt(0.2);

    println!("A 1 W line, 20° wide and 0.2 mm thick at 200 mm");
    println!("tilt | theory | measured | as printed | printed, with the fan normalised");
    for degrees in [0.0_f64, 30.0, 60.0, 75.0] {
        let tilt = degrees.to_radians();
        let ours = power(tilt, |p, n| -DVec3::from(light.flux(p.into())).dot(n));
        let theirs = power(tilt, |p, n| {
            paper::line_next_event(&light, p.into(), n.into())
                .map_or(0.0, |event| event.radiance * DVec3::from(event.wi).dot(n))
        });
        let scaled = theirs / excess;
        println!(" {degrees:>2}° | 1.0000 | {ours:.4}   | {theirs:<10.1} | {scaled:.4}");
    }
    Ok(())
}
