//! The wave of a laser, where it lights a surface and where it does not.

use glam::DVec3;
use tem00_beam::LaserLine;

use super::{Laser, Source};

impl Laser {
    /// Returns the unit direction from `point` along which the wave arrives, towards its source.
    ///
    /// Where the laser lights the point it is the direction of the light. Beyond its cut-off, where
    /// no light is followed any more, the wave goes on.
    ///
    /// Returns `None` at the apex of a line and behind it.
    pub fn wave_direction_at(&self, point: DVec3) -> Option<DVec3> {
        let [x, y, z] = self.local(point);
        let slope = match &self.source {
            Source::Spot { beam, .. } => {
                let [first, second] = beam.curvatures_at(z);
                [x * first, y * second]
            }
            Source::Line { line, .. } => {
                let fan = FanPoint::new(line, [x, z])?;
                [fan.slope, y * fan.curvature * fan.secant]
            }
        };
        let [ex, ey, ez] = self.axes();
        (-(slope[0] * ex + slope[1] * ey + ez)).try_normalize()
    }

    /// Returns the optical path of the wave to `point`, in metres, less one that is the same for all points.
    ///
    /// ```text
    /// Φ = z + (κ_x x² + κ_y y²) / 2     of a spot; κ the curvatures of the wave at z
    /// Φ = r + κ y² / 2                  of a line; r from the apex, κ that of the focus at r
    /// ```
    ///
    /// The Gouy phase, half a wavelength over a focus, is left out. Returns `None` at the apex of a line and behind it.
    pub(crate) fn path_to(&self, point: DVec3) -> Option<f64> {
        let [x, y, z] = self.local(point);
        match &self.source {
            Source::Spot { beam, .. } => {
                let [first, second] = beam.curvatures_at(z);
                Some(z + 0.5 * (first * x * x + second * y * y))
            }
            Source::Line { line, .. } => {
                let fan = FanPoint::new(line, [x, z])?;
                Some(fan.distance + 0.5 * fan.curvature * y * y)
            }
        }
    }

    /// The coordinates of a point along the axes of the beam, from the middle of the aperture.
    fn local(&self, point: DVec3) -> [f64; 3] {
        let offset = point - self.description.position;
        self.axes().map(|axis| offset.dot(axis))
    }

    fn axes(&self) -> [DVec3; 3] {
        let axes = match &self.source {
            Source::Spot { light, .. } => [light.ex, light.ey, light.ez],
            Source::Line { light, .. } => [light.ex, light.ey, light.ez],
        };
        axes.map(DVec3::from_array)
    }
}

/// A point in the fan of a line.
struct FanPoint {
    /// The tangent of the angle in the fan, and the secant.
    slope: f64,
    secant: f64,
    /// The distance from the apex, in metres.
    distance: f64,
    /// The curvature of the wave across the line, in m⁻¹.
    curvature: f64,
}

impl FanPoint {
    fn new(line: &LaserLine, [x, z]: [f64; 2]) -> Option<Self> {
        let depth = z + line.fan().apex_offset;
        if depth <= 0.0 {
            return None;
        }
        let slope = x / depth;
        let secant = (1.0 + slope * slope).sqrt();
        let distance = depth * secant;
        let from_waist = distance - line.waist_slant_distance_at(slope);
        Some(Self {
            slope,
            secant,
            distance,
            curvature: line.focus().curvature_at(from_waist),
        })
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
    fn the_path_grows_along_the_wave() {
        for laser in lasers() {
            for i in 0..400_u32 {
                let (x, y) = (f64::from(i % 20) - 9.5, f64::from(i / 20) - 9.5);
                let point = DVec3::new(3e-3 * x, 0.02e-3 * y, 1e-3 * x);
                let wave = laser.wave_direction_at(point).unwrap();
                let across = wave.any_orthonormal_vector();
                let slope = |direction: DVec3| {
                    let [ahead, behind] =
                        [1e-5, -1e-5].map(|step| laser.path_to(point + step * direction).unwrap());
                    (ahead - behind) / 2e-5
                };
                // Paraxially: half the square of the slope of the rays, at most 0.15 to the side.
                assert!(
                    (slope(-wave) - 1.0).abs() < 0.012,
                    "{point}: {}",
                    slope(-wave)
                );
                assert!(slope(across).abs() < 2e-3, "{point}: {}", slope(across));
            }
        }
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
