//! The wave of a laser, where it lights a surface and where it does not.

use glam::DVec3;

use super::{Laser, Source};

impl Laser {
    /// Returns the unit direction from `point` along which the wave arrives, towards its source.
    ///
    /// Where the laser lights the point it is the direction of the light. Beyond its cut-off, where
    /// no light is followed any more, the wave goes on.
    ///
    /// Returns `None` at the apex of a line and behind it.
    pub fn wave_direction_at(&self, point: DVec3) -> Option<DVec3> {
        let offset = point - self.description.position;
        let along = |axis: [f64; 3]| offset.dot(DVec3::from_array(axis));
        let (slope, axes) = match &self.source {
            Source::Spot { beam, light } => {
                let [first, second] = beam.curvatures_at(along(light.ez));
                let slope = [along(light.ex) * first, along(light.ey) * second];
                (slope, [light.ex, light.ey, light.ez])
            }
            Source::Line { line, light } => {
                let depth = along(light.ez) + line.fan().apex_offset;
                if depth <= 0.0 {
                    return None;
                }
                let in_fan = along(light.ex) / depth;
                let secant = (1.0 + in_fan * in_fan).sqrt();
                let from_waist = depth * secant - line.waist_slant_distance_at(in_fan);
                let across = along(light.ey) * line.focus().curvature_at(from_waist);
                ([in_fan, across * secant], [light.ex, light.ey, light.ez])
            }
        };
        let [ex, ey, ez] = axes.map(DVec3::from_array);
        (-(slope[0] * ex + slope[1] * ey + ez)).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use tem00_beam::{FanGeometry, FocusCurve, LineProfile};

    use super::*;
    use crate::{BeamShape, LaserDescription, testing::spot};

    fn lasers() -> [Laser; 2] {
        let elliptic = LaserDescription {
            shape: BeamShape::Spot {
                waist_radius: [0.05e-3, 0.2e-3],
                waist_distance: [0.1, 0.5],
                m_squared: [1.0; 2],
            },
            ..spot(DVec3::new(0.1, 0.02, 0.3), 0.05e-3)
        };
        let line = LaserDescription {
            shape: BeamShape::Line {
                waist_radius: 0.05e-3,
                m_squared: 1.0,
                fan: FanGeometry {
                    fan_angle: 40_f64.to_radians(),
                    apex_offset: 2e-3,
                    focus_distance: 0.2,
                    focus_curve: FocusCurve::EqualDistance,
                },
                profile: LineProfile::GaussianTan,
            },
            ..spot(DVec3::new(-0.1, 0.02, 0.3), 0.05e-3)
        };
        [elliptic, line].map(|laser| Laser::new(laser).unwrap())
    }

    #[test]
    fn the_wave_arrives_as_the_light_does_and_goes_on_beyond_it() {
        for laser in lasers() {
            let mut lit = 0;
            for i in 0..400_u32 {
                let (x, y) = (f64::from(i % 20) - 9.5, f64::from(i / 20) - 9.5);
                let point = DVec3::new(3e-3 * x, 0.2e-3 * y, 1e-3 * x);
                let wave = laser.wave_direction_at(point).unwrap();
                assert!((wave.length() - 1.0).abs() < 1e-15, "{wave}");
                if let Some(light) = laser.illuminate(point) {
                    lit += 1;
                    let error = (wave - light.direction).length();
                    // Both are made of the same few products, in another order.
                    assert!(error < 1e-14, "{point}: {error:e}");
                }
            }
            assert!((10..400).contains(&lit), "{lit} of 400 points are lit");
        }
    }
}
