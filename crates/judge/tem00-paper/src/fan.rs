use glam::DVec3;
use tem00_beam::{GaussianBeam, LaserLine};

/// The laser fan as printed: the irradiance of the round beam, with x scaled to the line.
///
/// ```text
/// x′ = x w(z) / (T z)     with T = tan(α/2)
/// E(x, y, z) / P = 2 / (π w²) · exp(−2 (x′² + y²) / w²)
/// ```
///
/// The text writes one z for two distances. Here z in `w(z)` is measured from the waist, as in eq.
/// (1), and z in `T z` from the emitter, as a line of the angle α requires.
///
/// # Validity
///
/// The factor `w / (T z)` of the change of variable is missing, so that the power on a plane is
/// [`power_per_watt`](Self::power_per_watt) instead of 1, and z → 0 is singular. [`LaserLine`] has
/// neither error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedFan {
    focus: GaussianBeam,
    half_slope: f64,
    focus_distance: f64,
}

impl PrintedFan {
    /// Returns the printed form of a line, with the emitter at the position of its lens.
    pub const fn new(line: &LaserLine) -> Self {
        Self {
            focus: *line.focus(),
            half_slope: line.half_slope(),
            focus_distance: line.fan().focus_distance,
        }
    }

    /// Returns the printed irradiance per watt, in m⁻², of a plane of constant z at `point`; 0
    /// unless `point.z` is positive.
    ///
    /// The frame is the frame of the emitter: light travels along +z, z = 0 is the emitter, and the
    /// line is along x.
    pub fn irradiance_per_watt(&self, point: DVec3) -> f64 {
        if point.z <= 0.0 {
            return 0.0;
        }
        let from_waist = point.z - self.focus_distance;
        let x = point.x * self.focus.radius_at(from_waist) / (self.half_slope * point.z);
        self.focus.irradiance_per_watt(x.hypot(point.y), from_waist)
    }

    /// Returns the integral of the printed irradiance, in watts per watt of the laser, over the
    /// plane at the distance `z`, in metres, from the emitter.
    ///
    /// ```text
    /// T z / w(z)
    /// ```
    ///
    /// It is the ratio of the half-length of the line to its half-thickness, some hundreds; the
    /// correct value is 1.
    pub fn power_per_watt(&self, z: f64) -> f64 {
        self.half_slope * z / self.focus.radius_at(z - self.focus_distance)
    }
}

#[cfg(test)]
mod tests {
    use tem00_beam::{FanGeometry, FocusCurve, LineProfile};

    use tem00_testkit::assert_relative;

    use super::*;

    fn focus() -> GaussianBeam {
        GaussianBeam::from_waist(650e-9, 0.1e-3).unwrap()
    }

    /// A line of 0.5 rad that is thinnest 0.2 m from its apex.
    fn line(apex_offset: f64) -> LaserLine {
        let geometry = FanGeometry {
            fan_angle: 0.5,
            apex_offset,
            focus_distance: 0.2 - apex_offset,
            focus_curve: FocusCurve::EqualDistance,
        };
        LaserLine::new(focus(), geometry, LineProfile::GaussianTan).unwrap()
    }

    /// The printed fan that is thinnest 0.2 m from its emitter.
    fn fan() -> PrintedFan {
        PrintedFan {
            focus_distance: 0.2,
            ..PrintedFan::new(&line(1e-3))
        }
    }

    #[test]
    fn power_is_off_by_length_over_thickness() {
        const NODES: i32 = 64;
        let fan = fan();
        for z in [0.1, 0.2, 0.4] {
            // The trapezoidal rule on four radii converges to rounding; 1e−14 of the power lies
            // outside.
            let h = 4.0 * 0.25_f64.tan() * z / f64::from(NODES);
            let v = 4.0 * focus().radius_at(z - 0.2) / f64::from(NODES);
            let mut power = 0.0;
            for i in -NODES..=NODES {
                for j in -NODES..=NODES {
                    let point = DVec3::new(f64::from(i) * h, f64::from(j) * v, z);
                    power += fan.irradiance_per_watt(point) * h * v;
                }
            }
            assert_relative(power, fan.power_per_watt(z), 1e-12);
            assert!(power > 100.0, "z = {z}: {power}");
        }
    }

    #[test]
    fn normalised_it_is_the_line_from_an_apex_in_the_lens() {
        let apex_offset = 1e-3;
        let line = line(apex_offset);
        let fan = fan();
        let z = 0.3;
        for x in [0.0, 0.004] {
            let from_apex = DVec3::new(x, 5e-5, z);
            let from_lens = from_apex - DVec3::Z * apex_offset;
            let printed = fan.irradiance_per_watt(from_apex) / fan.power_per_watt(z);
            let ratio = printed / line.irradiance_per_watt(from_lens);
            // The printed form takes the width on the plane, not on the circle: to first order w
            // changes by w'(r − z) = 2e−3 x² / 2z, 6e−8 m compared with 2.3e−4 m.
            assert!((ratio - 1.0).abs() < 4e-4, "x = {x}: {ratio}");
        }
    }

    #[test]
    fn nothing_is_lit_at_or_behind_the_emitter() {
        let fan = fan();
        for z in [0.0, -0.1] {
            let irradiance = fan.irradiance_per_watt(DVec3::Z * z);
            assert!(
                irradiance.abs() < f64::MIN_POSITIVE,
                "z = {z}: {irradiance}"
            );
        }
    }
}
