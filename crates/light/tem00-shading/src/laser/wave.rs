//! The wave of a laser, inside and outside of its lit region.

use glam::DVec3;
use tem00_beam::FocusCurve;

use super::{Laser, Source};

/// The wave of a laser at rest in its own axes: the slopes of its rays.
#[derive(Clone, Copy, Debug)]
pub(crate) enum WaveShape {
    Spot(SpotWave),
    Line(LineWave),
}

/// The wave of a beam: for each axis, the position of the waist and the square of the Rayleigh
/// range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpotWave {
    waist_distance: [f64; 2],
    rayleigh_range_squared: [f64; 2],
}

/// The wave of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineWave {
    apex_offset: f64,
    /// The slant distance of the waist from the apex in the middle of the fan, and its growth with
    /// the secant.
    waist_slant_distance: [f64; 2],
    rayleigh_range_squared: f64,
}

/// Pose of a laser.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WaveFrame {
    pub(crate) origin: DVec3,
    pub(crate) axes: [DVec3; 3],
}

/// A wave as numbers for a kernel, which treats spots and lines alike.
pub(crate) struct WaveNumbers {
    /// The waist along x, and the distance of the waist across it from there: a constant and a
    /// coefficient per secant of the ray.
    pub(crate) centres: [f64; 3],
    pub(crate) rayleigh_range_squared: [f64; 2],
    pub(crate) is_line: bool,
}

impl WaveShape {
    /// Returns the numbers of a kernel. Along a line the waves spread from its apex.
    pub(crate) const fn numbers(&self) -> WaveNumbers {
        match *self {
            Self::Spot(SpotWave {
                waist_distance: [x, y],
                rayleigh_range_squared,
            }) => WaveNumbers {
                centres: [x, y - x, 0.0],
                rayleigh_range_squared,
                is_line: false,
            },
            Self::Line(LineWave {
                apex_offset,
                waist_slant_distance: [middle, growth],
                rayleigh_range_squared,
            }) => WaveNumbers {
                centres: [-apex_offset, middle, growth],
                rayleigh_range_squared: [0.0, rayleigh_range_squared],
                is_line: true,
            },
        }
    }
}

impl SpotWave {
    /// The slopes of the ray through a point in the axes of the beam.
    #[inline(always)]
    pub(crate) fn slopes(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        let curvature = |axis: usize| {
            let from_waist = z - self.waist_distance[axis];
            curvature(from_waist, self.rayleigh_range_squared[axis])
        };
        [x * curvature(0), y * curvature(1)]
    }
}

impl LineWave {
    /// The slopes of the ray through a point in the axes of the line: NaN at the apex and behind
    /// it.
    #[inline(always)]
    pub(crate) fn slopes(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        let depth = z + self.apex_offset;
        let slope = x / depth;
        let secant = (1.0 + slope * slope).sqrt();
        let [middle, growth] = self.waist_slant_distance;
        let from_waist = depth * secant - (middle + growth * secant);
        let across = y * curvature(from_waist, self.rayleigh_range_squared) * secant;
        [if depth > 0.0 { slope } else { f64::NAN }, across]
    }
}

/// 1/R of a Gaussian beam.
#[inline(always)]
fn curvature(from_waist: f64, rayleigh_range_squared: f64) -> f64 {
    from_waist / (from_waist * from_waist + rayleigh_range_squared)
}

impl WaveFrame {
    /// Returns the unit direction from `point` along which the wave arrives, from the slopes of its
    /// rays; towards the aperture where the slopes are not finite.
    #[inline(always)]
    pub(crate) fn direction_to_source(
        &self,
        point: DVec3,
        slopes: impl Fn([f64; 3]) -> [f64; 2],
    ) -> DVec3 {
        let offset = point - self.origin;
        let [ex, ey, ez] = self.axes;
        let [sx, sy] = slopes([offset.dot(ex), offset.dot(ey), offset.dot(ez)]);
        let along = -(sx * ex + sy * ey + ez);
        let square = along.length_squared();
        let has_wave = square <= f64::MAX;
        let choose = |wave: f64, aperture: f64| if has_wave { wave } else { -aperture };
        let direction = DVec3::new(
            choose(along.x, offset.x),
            choose(along.y, offset.y),
            choose(along.z, offset.z),
        );
        direction * (1.0 / choose(square, -offset.length_squared()).sqrt())
    }
}

impl Laser {
    /// Returns the pose of the laser.
    pub(crate) fn wave_frame(&self) -> WaveFrame {
        WaveFrame {
            origin: self.description.position,
            axes: self.axes(),
        }
    }

    /// Returns the wave of the laser.
    pub(crate) fn wave_shape(&self) -> WaveShape {
        match &self.source {
            Source::Spot { beam, .. } => WaveShape::Spot(SpotWave {
                waist_distance: beam.axes().map(|axis| axis.waist_distance()),
                rayleigh_range_squared: beam
                    .axes()
                    .map(|axis| axis.beam().rayleigh_range().powi(2)),
            }),
            Source::Line { line, .. } => WaveShape::Line(LineWave {
                apex_offset: line.fan().apex_offset,
                waist_slant_distance: match line.fan().focus_curve {
                    FocusCurve::EqualDistance => [line.waist_slant_distance(), 0.0],
                    FocusCurve::EqualPlane => [0.0, line.waist_slant_distance()],
                },
                rayleigh_range_squared: line.focus().rayleigh_range().powi(2),
            }),
        }
    }

    /// Returns the unit direction from `point` along which the wave arrives, towards its source.
    ///
    /// Where the laser lights the point this is the direction of the light. The wave continues
    /// beyond the cut-off, where light is neglected. At the apex of a line and behind it there is
    /// no wave, and the direction leads to the middle of the aperture.
    pub fn wave_direction_at(&self, point: DVec3) -> DVec3 {
        let frame = self.wave_frame();
        match self.wave_shape() {
            WaveShape::Spot(wave) => frame.direction_to_source(point, |local| wave.slopes(local)),
            WaveShape::Line(wave) => frame.direction_to_source(point, |local| wave.slopes(local)),
        }
    }

    /// Returns the optical path of the wave to `point`, in metres, minus a constant that is the
    /// same for all points.
    ///
    /// ```text
    /// Φ = z + (κ_x x² + κ_y y²) / 2     of a spot; κ the curvatures of the wave at z
    /// Φ = r + κ y² / 2                  of a line; r from the apex, κ that of the focus at r
    /// ```
    ///
    /// The Gouy phase, half a wavelength over a focus, is not included. Returns `None` at the apex
    /// of a line and behind it.
    pub fn path_to(&self, point: DVec3) -> Option<f64> {
        let [x, y, z] = self.local(point);
        match &self.source {
            Source::Spot { beam, .. } => {
                let [first, second] = beam.curvatures_at(z);
                Some(z + 0.5 * (first * x * x + second * y * y))
            }
            Source::Line { line, .. } => {
                let depth = z + line.fan().apex_offset;
                let slope = x / depth;
                let distance = depth * (1.0 + slope * slope).sqrt();
                let from_waist = distance - line.waist_slant_distance_at(slope);
                let curvature = line.focus().curvature_at(from_waist);
                (depth > 0.0).then_some(distance + 0.5 * curvature * y * y)
            }
        }
    }

    /// Returns the radius of the beam at the distance of `point`, in metres, where 1/e² of the
    /// irradiance is left: across a line, and across an elliptic spot where it is narrower.
    pub fn narrow_radius_at(&self, point: DVec3) -> f64 {
        let [x, _, z] = self.local(point);
        match &self.source {
            Source::Spot { beam, .. } => {
                let [first, second] = beam.radii_at(z);
                first.min(second)
            }
            Source::Line { line, .. } => {
                let angle = libm::atan2(x, z + line.fan().apex_offset);
                line.half_thickness_at_angle(z, angle)
            }
        }
    }

    /// Returns how far `point` lies beside the beam, in metres: beyond the larger radius of a spot,
    /// or the half-thickness of a line; negative within.
    pub fn distance_beside(&self, point: DVec3) -> f64 {
        let [x, y, z] = self.local(point);
        match &self.source {
            Source::Spot { beam, .. } => {
                let [first, second] = beam.radii_at(z);
                x.hypot(y) - first.max(second)
            }
            Source::Line { .. } => y.abs() - self.narrow_radius_at(point),
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

#[cfg(test)]
mod tests {
    use tem00_beam::{FanGeometry, LineProfile};

    use tem00_testkit::assert_absolute;

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
                let wave = laser.wave_direction_at(point);
                let across = wave.any_orthonormal_vector();
                let slope = |direction: DVec3| {
                    let [ahead, behind] =
                        [1e-5, -1e-5].map(|step| laser.path_to(point + step * direction).unwrap());
                    (ahead - behind) / 2e-5
                };
                // The paraxial error is half the square of the rays' slope, which is at most 0.15.
                assert_absolute(slope(-wave), 1.0, 0.012);
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
                let wave = laser.wave_direction_at(point);
                assert!((wave.length() - 1.0).abs() < 1e-15, "{wave}");
                if let Some(light) = laser.next_event(point) {
                    lit += 1;
                    let error = (wave - light.wi).length();
                    // Both consist of the same few products, in a different order.
                    assert!(error < 1e-14, "{point}: {error:e}");
                }
            }
            assert!((10..400).contains(&lit), "{lit} of 400 points are lit");
        }
    }
}
