use glam::DVec3;
use tem00_beam::{
    BeamError, Emitter, FanGeometry, GaussianBeam, LaserLine, LineLight, LineProfile, NextEvent,
    Placement, SpotLight, TabulatedLineLight, paper,
};
use tem00_decorrelation::{DecorrelationError, Wavefront};

use crate::TracerError;

/// What determines a [`Laser`].
#[derive(Clone, Debug, PartialEq)]
pub struct LaserDescription {
    /// The vacuum wavelength, in metres.
    pub wavelength: f64,
    /// The power of the beam, in watts.
    pub power: f64,
    /// The centre of the aperture, in metres.
    pub position: DVec3,
    /// A point on the axis in front of the aperture, in metres.
    pub look_at: DVec3,
    /// Across the axis: the direction in which a line opens. Its part along the axis is ignored.
    pub line_direction: DVec3,
    /// The shape of the beam.
    pub shape: BeamShape,
}

/// The shape of a laser's beam.
#[derive(Clone, Debug, PartialEq)]
pub enum BeamShape {
    /// A round Gaussian beam.
    Spot {
        /// The waist radius, in metres.
        waist_radius: f64,
        /// The distance of the waist from the aperture, in metres; negative behind it.
        waist_distance: f64,
        /// The beam quality factor M².
        m_squared: f64,
    },
    /// A laser line.
    Line {
        /// The waist radius across the line, in metres: half its thickness in focus.
        waist_radius: f64,
        /// The beam quality factor M² across the line.
        m_squared: f64,
        /// The fan: full opening angle, offset of its apex, distance of the focus.
        fan: FanGeometry,
        /// How the power is spread along the line.
        profile: LineProfile,
    },
}

/// A laser in the scene: a spot or a line, placed, with its power.
#[derive(Clone, Debug, PartialEq)]
pub struct Laser {
    description: LaserDescription,
    source: Source,
}

/// The beam and the light prepared from it.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    Spot {
        beam: GaussianBeam,
        light: SpotLight<f64>,
    },
    /// The table of a tabulated profile stays in the line.
    Line {
        line: LaserLine,
        light: LineLight<f64>,
    },
}

impl Laser {
    /// Creates a laser.
    ///
    /// # Errors
    ///
    /// Returns an error if the beam is not possible (see [`BeamError`](tem00_beam::BeamError)), if
    /// `look_at` is the position, or if the line direction is parallel to the axis.
    pub fn new(description: LaserDescription) -> Result<Self, TracerError> {
        let placement = Placement {
            origin: description.position,
            direction: description.look_at - description.position,
            fan_axis: description.line_direction,
        };
        let (wavelength, power) = (description.wavelength, description.power);
        let source = match &description.shape {
            &BeamShape::Spot {
                waist_radius,
                waist_distance,
                m_squared,
            } => {
                let beam = beam(wavelength, waist_radius, m_squared)?;
                Source::Spot {
                    beam,
                    light: SpotLight::place(&beam, waist_distance, &placement, power)?,
                }
            }
            BeamShape::Line {
                waist_radius,
                m_squared,
                fan,
                profile,
            } => {
                let focus = beam(wavelength, *waist_radius, *m_squared)?;
                let line = LaserLine::new(focus, *fan, profile.clone())?;
                let light = line_light(&line, &placement, power)?;
                Source::Line { line, light }
            }
        };
        Ok(Self {
            description,
            source,
        })
    }

    /// Returns what the laser was created from.
    pub const fn description(&self) -> &LaserDescription {
        &self.description
    }

    /// Returns the vacuum wavelength, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.description.wavelength
    }

    /// Returns the power of the beam, in watts.
    pub const fn power(&self) -> f64 {
        self.description.power
    }

    /// Returns how the laser lights `point`, or `None` where it sends no light.
    pub(crate) fn illuminate(&self, point: DVec3) -> Option<Illumination> {
        let event = match &self.source {
            Source::Spot { light, .. } => light.next_event(point.to_array()),
            Source::Line { line, light } => line_event(line, light, point.to_array()),
        }?;
        Some(Illumination {
            source: DVec3::from_array(event.point),
            direction: DVec3::from_array(event.wi),
            irradiance: event.e_perp,
        })
    }

    /// Returns how the laser lights `point` of a surface with the unit normal `normal`, by eq. (3)
    /// of Bergmann et al. 2016 as printed.
    pub(crate) fn illuminate_as_printed(
        &self,
        point: DVec3,
        normal: DVec3,
    ) -> Option<Illumination> {
        let (point, normal) = (point.to_array(), normal.to_array());
        let event = match &self.source {
            Source::Spot { light, .. } => paper::spot_next_event(light, point, normal),
            Source::Line { light, .. } => paper::line_next_event(light, point, normal),
        }?;
        Some(Illumination {
            source: DVec3::from_array(event.point),
            direction: DVec3::from_array(event.wi),
            irradiance: event.radiance,
        })
    }

    /// Returns the wavefront at `point`, whose unit direction to the source is `direction`.
    ///
    /// A spot's wavefront has the curvature 1/R(z) of its beam in both directions. A line's has, in
    /// the fan, that of a wave from the apex and, across the fan, that of the focused beam.
    pub(crate) fn wavefront_at(
        &self,
        point: DVec3,
        direction: DVec3,
    ) -> Result<Wavefront, DecorrelationError> {
        let offset = point - self.description.position;
        let along = |axis: [f64; 3]| offset.dot(DVec3::from_array(axis));
        match &self.source {
            Source::Spot { beam, light } => {
                let from_waist = along(light.ez) - light.x.z0;
                Wavefront::spherical(direction, beam.curvature_at(from_waist))
            }
            Source::Line { line, light } => {
                let depth = along(light.ez) + line.fan().apex_offset;
                let slant = along(light.ex).hypot(depth);
                let waist = line.waist_slant_distance_at(along(light.ex) / depth);
                let across = line.focus().curvature_at(slant - waist);
                let normal = DVec3::from_array(light.ey);
                Wavefront::astigmatic(direction, normal, across, 1.0 / slant)
            }
        }
    }

    /// Returns the unit direction from `point` to the middle of the aperture.
    pub(crate) fn direction_from(&self, point: DVec3) -> Option<DVec3> {
        (self.description.position - point).try_normalize()
    }
}

fn beam(wavelength: f64, waist_radius: f64, m_squared: f64) -> Result<GaussianBeam, BeamError> {
    GaussianBeam::from_waist(wavelength, waist_radius)?.with_m_squared(m_squared)
}

/// Places a line; the table of a tabulated profile is left to [`line_event`].
fn line_light(
    line: &LaserLine,
    placement: &Placement,
    power: f64,
) -> Result<LineLight<f64>, BeamError> {
    match line.profile() {
        LineProfile::Tabulated(_) => {
            TabulatedLineLight::place(line, placement, power).map(|light| light.line)
        }
        _ => LineLight::place(line, placement, power),
    }
}

fn line_event(line: &LaserLine, light: &LineLight<f64>, point: [f64; 3]) -> Option<NextEvent<f64>> {
    match line.profile() {
        LineProfile::Tabulated(profile) => {
            let (line, knots) = (*light, profile.knots());
            TabulatedLineLight { line, knots }.next_event(point)
        }
        _ => light.next_event(point),
    }
}

/// How a laser lights a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Illumination {
    /// The point of the aperture from which the light comes, in metres.
    pub source: DVec3,
    /// The unit direction towards the light.
    pub direction: DVec3,
    /// The irradiance on a plane across that direction, in W/m².
    pub irradiance: f64,
}

#[cfg(test)]
mod tests {
    use tem00_beam::{AngularProfile, FocusCurve};

    use super::*;

    /// A line of 60° in focus at 0.3 m, from the origin along z.
    fn line(profile: LineProfile, focus_curve: FocusCurve) -> Laser {
        let shape = BeamShape::Line {
            waist_radius: 0.1e-3,
            m_squared: 1.0,
            fan: FanGeometry {
                fan_angle: 60_f64.to_radians(),
                apex_offset: 2e-3,
                focus_distance: 0.3,
                focus_curve,
            },
            profile,
        };
        Laser::new(LaserDescription {
            wavelength: 650e-9,
            power: 5e-3,
            position: DVec3::ZERO,
            look_at: DVec3::Z,
            line_direction: DVec3::X,
            shape,
        })
        .unwrap()
    }

    #[test]
    fn the_wavefront_across_a_line_is_flat_where_its_focus_curve_says() {
        let slope = 0.4_f64;
        let on_plane = DVec3::new(0.302 * slope, 0.0, 0.3);
        let cos = slope.atan().cos();
        let on_circle = DVec3::new(0.302 * slope * cos, 0.0, 0.302 * cos - 2e-3);
        let cases = [
            (FocusCurve::EqualPlane, on_plane, on_circle),
            (FocusCurve::EqualDistance, on_circle, on_plane),
        ];
        for (focus_curve, flat, curved) in cases {
            let laser = line(LineProfile::GaussianTan, focus_curve);
            let across = [flat, curved].map(|point| {
                let direction = laser.illuminate(point).unwrap().direction;
                let curvature = laser.wavefront_at(point, direction).unwrap().curvature();
                DVec3::Y.dot(curvature * DVec3::Y)
            });
            assert!(across[0].abs() < 1e-9, "{focus_curve:?}: {across:?}");
            assert!(across[1].abs() > 1.0, "{focus_curve:?}: {across:?}");
        }
    }

    #[test]
    fn a_tabulated_line_lights_what_its_table_says() {
        let table = AngularProfile::from_pairs(&[(-0.2, 1.0), (0.0, 2.0), (0.4, 0.0)]).unwrap();
        let laser = line(LineProfile::Tabulated(table), FocusCurve::EqualPlane);
        let at = |theta: f64| {
            let point = DVec3::new(0.302 * theta.tan(), 0.0, 0.3);
            let light = laser.illuminate(point);
            light.map_or(0.0, |light| light.irradiance)
        };
        // E = P f(θ) / r · √(2/π) / w₀ on the plane of focus, and ∫ f = 0.3 + 0.4.
        for (theta, f) in [(0.0, 2.0), (-0.1, 1.5), (0.2, 1.0)] {
            let r = 0.302 / f64::cos(theta);
            let expected = 5e-3 * (f / 0.7) / r * core::f64::consts::FRAC_2_PI.sqrt() / 0.1e-3;
            let error = at(theta) / expected - 1.0;
            assert!(error.abs() < 1e-12, "{theta}: {error:e}");
        }
        assert!(at(-0.21) <= 0.0 && at(0.41) <= 0.0, "outside the table");
    }
}
