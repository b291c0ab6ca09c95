mod builder;
mod emission;
mod wave;

use glam::DVec3;
use tem00_beam::{
    AstigmaticBeam, Emitter, FanGeometry, GaussianBeam, LaserLine, LineLight, LineProfile,
    LocatedBeam, NextEventSlices, Placement, Refusal, SpotLight, TabulatedLineLight,
};
use tem00_coherence::{SourceExtent, Spectrum};
use tem00_decorrelation::RigidMotion;

pub use self::builder::LaserBuilder;
pub use self::emission::{EmittedRay, SampledEvent};
pub(crate) use self::wave::{WaveFrame, WaveShape};
use crate::{ShadingError, Trajectory};

/// Parameters of a [`Laser`].
#[derive(Clone, Debug, PartialEq)]
pub struct LaserDescription {
    /// The vacuum wavelength and the spectrum about it. The beam has the wavelength of its middle.
    pub spectrum: Spectrum,
    /// The power of the beam, in watts.
    pub power: f64,
    /// The centre of the aperture, in metres.
    pub position: DVec3,
    /// A point on the axis in front of the aperture, in metres.
    pub look_at: DVec3,
    /// The direction in which a line opens, or the first axis of an elliptic spot. Its component
    /// along the beam axis is ignored.
    pub line_direction: DVec3,
    /// The shape of the beam.
    pub shape: BeamShape,
}

/// The shape of a laser's beam.
#[derive(Clone, Debug, PartialEq)]
pub enum BeamShape {
    /// A Gaussian beam, round or elliptic, with two values each: along the line direction and
    /// across it.
    Spot {
        /// The waist radii, in metres.
        waist_radius: [f64; 2],
        /// The distances of the waists from the aperture, in metres; negative behind it.
        waist_distance: [f64; 2],
        /// The beam quality factors M².
        m_squared: [f64; 2],
    },
    /// A laser line.
    Line {
        /// The waist radius across the line, in metres: half its thickness in focus.
        waist_radius: f64,
        /// The beam quality factor M² across the line.
        m_squared: f64,
        /// The fan: full opening angle, offset of its apex, distance of the focus.
        fan: FanGeometry,
        /// The distribution of the power along the line.
        profile: LineProfile,
    },
}

/// A laser in the scene: a spot or a line, placed, with its power.
#[derive(Clone, Debug, PartialEq)]
pub struct Laser {
    description: LaserDescription,
    source: Source,
    source_extent: SourceExtent,
    trajectory: Trajectory,
}

/// The beam and the light prepared from it.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    Spot {
        beam: AstigmaticBeam,
        light: SpotLight,
    },
    /// The table of a tabulated profile stays in the line.
    Line { line: LaserLine, light: LineLight },
}

impl Laser {
    /// Creates a laser.
    ///
    /// # Errors
    ///
    /// Returns an error if the beam is invalid (see [`GaussianBeam`](tem00_beam::GaussianBeam)), if
    /// `look_at` equals the position, or if the line direction is parallel to the axis.
    pub fn new(description: LaserDescription) -> Result<Self, ShadingError> {
        let placement = Placement {
            origin: description.position,
            direction: description.look_at - description.position,
            fan_axis: description.line_direction,
        };
        let (wavelength, power) = (description.spectrum.wavelength(), description.power);
        let source = match &description.shape {
            &BeamShape::Spot {
                waist_radius,
                waist_distance,
                m_squared,
            } => {
                let axis = |i: usize| {
                    let beam = beam(wavelength, waist_radius[i], m_squared[i])?;
                    LocatedBeam::new(beam, waist_distance[i])
                };
                let beam = AstigmaticBeam::new(axis(0)?, axis(1)?)?;
                let light = SpotLight::place_astigmatic(&beam, &placement, power);
                let light = light.map_err(of_description)?;
                Source::Spot { beam, light }
            }
            BeamShape::Line {
                waist_radius,
                m_squared,
                fan,
                profile,
            } => {
                let focus = beam(wavelength, *waist_radius, *m_squared)?;
                let line = LaserLine::new(focus, *fan, profile.clone())?;
                let light = line_light(&line, &placement, power).map_err(of_description)?;
                Source::Line { line, light }
            }
        };
        Ok(Self {
            description,
            source,
            source_extent: SourceExtent::default(),
            trajectory: Trajectory::default(),
        })
    }

    /// Returns the laser with an extended source, as seen from the surfaces. The extent affects the
    /// speckle only.
    #[must_use]
    pub fn with_source_extent(mut self, source_extent: SourceExtent) -> Self {
        self.source_extent = source_extent;
        self
    }

    /// Returns the directions from which light reaches a surface.
    pub const fn source_extent(&self) -> &SourceExtent {
        &self.source_extent
    }

    /// Returns whether the light has one wavelength and comes from a point.
    pub fn is_coherent(&self) -> bool {
        self.spectrum().is_monochromatic() && self.source_extent.is_point()
    }

    /// Returns the laser with a motion from frame to frame.
    #[must_use]
    pub fn with_trajectory(mut self, trajectory: Trajectory) -> Self {
        self.trajectory = trajectory;
        self
    }

    /// Returns the motion of the laser from frame to frame.
    pub const fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// Returns the laser in its pose in `frame`.
    #[must_use]
    pub fn in_frame(&self, frame: u32) -> Self {
        self.moved(&self.trajectory.pose_at(frame))
    }

    /// Returns the laser moved by a rigid motion: its aperture, its axis and the direction of its
    /// line.
    ///
    /// The laser in its new pose has no motion from frame to frame.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        let description = &self.description;
        Self {
            description: LaserDescription {
                position: motion.point(description.position),
                look_at: motion.point(description.look_at),
                line_direction: motion.direction(description.line_direction),
                ..description.clone()
            },
            source: self.source.moved(motion),
            source_extent: self.source_extent.clone(),
            trajectory: Trajectory::default(),
        }
    }

    /// Returns the description from which the laser was created.
    pub const fn description(&self) -> &LaserDescription {
        &self.description
    }

    /// Returns the vacuum wavelength of the middle of the line, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.description.spectrum.wavelength()
    }

    /// Returns the spectrum of the light.
    pub const fn spectrum(&self) -> &Spectrum {
        &self.description.spectrum
    }

    /// Returns the power of the beam, in watts.
    pub const fn power(&self) -> f64 {
        self.description.power
    }

    /// Returns the light of the laser at `point` as a delta light, or `None` where it sends no
    /// light. The light comes from one direction, along the mean energy flow at the point.
    pub fn next_event(&self, point: DVec3) -> Option<LaserEvent> {
        let event = self.with_emitter(|light| light.next_event(point.to_array()))?;
        Some(LaserEvent {
            point: event.point.into(),
            wi: event.wi.into(),
            e_perp: event.e_perp,
        })
    }

    /// Computes for each point the result of [`next_event`](Self::next_event), up to rounding of
    /// the aperture point, in less time.
    pub fn next_events(&self, events: &mut LaserEventBatch) {
        self.with_emitter(|light| events.by(light));
    }

    /// Returns the placed light as plain data, for a custom kernel; the table of a tabulated
    /// profile is in [`description`](Self::description).
    pub const fn placed(&self) -> PlacedLight {
        match &self.source {
            Source::Spot { light, .. } => PlacedLight::Spot(*light),
            Source::Line { light, .. } => PlacedLight::Line(*light),
        }
    }
}

/// A placed light as plain data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlacedLight {
    /// A spot.
    Spot(SpotLight),
    /// A line, without the table of its profile.
    Line(LineLight),
}

impl Source {
    fn moved(&self, motion: &RigidMotion) -> Self {
        let point = |p: [f64; 3]| motion.point(p.into()).to_array();
        let axis = |v: [f64; 3]| motion.direction(v.into()).to_array();
        match self {
            Self::Spot { beam, light } => Self::Spot {
                beam: *beam,
                light: SpotLight {
                    origin: point(light.origin),
                    ex: axis(light.ex),
                    ey: axis(light.ey),
                    ez: axis(light.ez),
                    ..*light
                },
            },
            Self::Line { line, light } => Self::Line {
                line: line.clone(),
                light: LineLight {
                    origin: point(light.origin),
                    ex: axis(light.ex),
                    ey: axis(light.ey),
                    ez: axis(light.ez),
                    ..*light
                },
            },
        }
    }
}

/// Names a refused vector of a placement as the description of a laser does.
fn of_description(refusal: Refusal) -> Refusal {
    match refusal.parameter() {
        "origin" => refusal.named("position"),
        "direction" => refusal.named("look_at"),
        "fan_axis" => refusal.named("line_direction"),
        _ => refusal,
    }
}

fn beam(wavelength: f64, waist_radius: f64, m_squared: f64) -> Result<GaussianBeam, Refusal> {
    GaussianBeam::from_waist(wavelength, waist_radius)?.with_m_squared(m_squared)
}

/// Places a line, without the table of a tabulated profile.
fn line_light(line: &LaserLine, placement: &Placement, power: f64) -> Result<LineLight, Refusal> {
    match line.profile() {
        LineProfile::Tabulated(_) => {
            TabulatedLineLight::place(line, placement, power).map(|light| light.line)
        }
        _ => LineLight::place(line, placement, power),
    }
}

/// Points and the light of a laser at them.
#[derive(Debug, Default)]
pub struct LaserEventBatch {
    /// Coordinates x, y, z of the points, in metres.
    points: [Vec<f64>; 3],
    /// The coordinates of the directions towards the light, the distances to the aperture and the
    /// irradiances.
    events: [Vec<f64>; 5],
}

impl LaserEventBatch {
    /// Sets the points.
    pub fn place(&mut self, points: impl Iterator<Item = DVec3>) {
        self.points.iter_mut().for_each(Vec::clear);
        for point in points {
            for (axis, value) in self.points.iter_mut().zip(point.to_array()) {
                axis.push(value);
            }
        }
    }

    fn by(&mut self, light: &dyn Emitter) {
        let [x, y, z] = &self.points;
        for values in &mut self.events {
            values.resize(x.len(), 0.0);
        }
        let [wi_x, wi_y, wi_z, distance, e_perp] = &mut self.events;
        let wi = [wi_x, wi_y, wi_z].map(Vec::as_mut_slice);
        let out = NextEventSlices {
            wi,
            distance,
            e_perp,
        };
        light.next_event_batch(x, y, z, out);
    }

    /// Returns the light at a point, or `None` where there is no light.
    #[inline(always)]
    pub fn at(&self, index: usize) -> Option<LaserEvent> {
        let vector = |of: &[Vec<f64>]| DVec3::new(of[0][index], of[1][index], of[2][index]);
        let [.., distances, irradiances] = &self.events;
        let irradiance = irradiances[index];
        (irradiance > 0.0).then(|| {
            let direction = vector(&self.events);
            LaserEvent {
                point: vector(&self.points) + distances[index] * direction,
                wi: direction,
                e_perp: irradiance,
            }
        })
    }
}

/// Laser light at a point, from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserEvent {
    /// The point of the aperture from which the light comes, in metres: where a shadow ray ends.
    pub point: DVec3,
    /// The unit direction towards the light.
    pub wi: DVec3,
    /// The irradiance on a plane perpendicular to this direction, in W/m².
    pub e_perp: f64,
}

#[cfg(test)]
mod tests;
