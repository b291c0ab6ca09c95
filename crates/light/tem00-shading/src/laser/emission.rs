//! A laser as a source of rays: sampling and evaluation of the phase-space density of its beam.

use glam::DVec3;
use tem00_beam::{Emitter, LineProfile, TabulatedLineLight};
use tem00_camera::Ray;

use super::{Laser, Source};

/// A ray that a laser sends out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmittedRay {
    /// The ray, from the plane of the aperture.
    pub ray: Ray,
    /// The power of the laser, in watts. Divided by the number of rays, it is the power that the
    /// ray carries.
    pub flux: f64,
}

/// Illumination of a point by a laser, along a direction drawn at random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledEvent {
    /// The point of the plane of the aperture from which the light comes, in metres.
    pub point: DVec3,
    /// The unit direction towards the light.
    pub wi: DVec3,
    /// The radiance along the direction divided by `pdf`, in W/m².
    pub value: f64,
    /// The density with which the direction was drawn, per steradian.
    pub pdf: f64,
}

impl Laser {
    /// Draws a ray from four uniform numbers in [0, 1).
    ///
    /// Every ray carries the same power, so that tracing rays through mirrors and lenses propagates
    /// the beam: straight rays drawn from the phase-space density of a Gaussian beam obey the
    /// complex q law behind every paraxial system.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_shading::{DVec3, Laser};
    ///
    /// let laser = Laser::spot(650e-9, 0.1e-3).power(5e-3);
    /// let laser = laser.placed(DVec3::new(0.0, 0.0, 0.3), DVec3::ZERO, DVec3::X)?;
    /// let emitted = laser.sample_ray([0.5; 4]);
    /// assert_eq!(emitted.ray.direction, -DVec3::Z);
    /// assert_eq!(emitted.flux, 5e-3);
    ///
    /// // On the axis of the waist the radiance is 4P / λ².
    /// let radiance = laser.radiance(DVec3::ZERO, DVec3::Z);
    /// assert!((radiance / (4.0 * 5e-3 / 650e-9_f64.powi(2)) - 1.0).abs() < 1e-12);
    /// # Ok::<(), tem00_shading::ShadingError>(())
    /// ```
    pub fn sample_ray(&self, u: [f64; 4]) -> EmittedRay {
        let sample = self.with_emitter(|light| light.sample_ray(u));
        EmittedRay {
            ray: Ray {
                origin: DVec3::from_array(sample.origin),
                direction: DVec3::from_array(sample.direction),
            },
            flux: sample.flux,
        }
    }

    /// Draws a direction from which the laser lights `point`, from two uniform numbers in [0, 1),
    /// or returns `None` where it sends no light.
    ///
    /// The estimate of the reflected radiance is `f · |n·direction| · value`, where the source is
    /// visible. Light beyond four beam radii is neglected; [`next_event_pdf`](Self::next_event_pdf)
    /// is 0 there.
    pub fn next_event_sampled(&self, point: DVec3, u: [f64; 2]) -> Option<SampledEvent> {
        let event = self.with_emitter(|light| light.next_event_sampled(point.to_array(), u))?;
        Some(SampledEvent {
            point: DVec3::from_array(event.point),
            wi: DVec3::from_array(event.wi),
            value: event.value,
            pdf: event.pdf,
        })
    }

    /// Returns the density, per steradian, with which
    /// [`next_event_sampled`](Self::next_event_sampled) draws the unit `direction` at `point`.
    pub fn next_event_pdf(&self, point: DVec3, direction: DVec3) -> f64 {
        self.with_emitter(|light| light.next_event_pdf(point.to_array(), direction.to_array()))
    }

    /// Returns the radiance, in W/(m² sr), that arrives at `origin` from the unit `direction`; 0
    /// behind the aperture.
    ///
    /// It is the radiance in free space: the caller checks for occluders between `origin` and the
    /// aperture, at [`aperture_distance`](Self::aperture_distance).
    pub fn radiance(&self, origin: DVec3, direction: DVec3) -> f64 {
        if self.aperture_distance(origin, direction).is_none() {
            return 0.0;
        }
        let travel = -direction;
        self.with_emitter(|light| light.radiance(origin.to_array(), travel.to_array()))
    }

    /// Returns the distance, in metres, at which the ray from `origin` along the unit `direction`
    /// crosses the plane of the aperture from the lit side, or `None` if it does not.
    pub fn aperture_distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let [aperture, axis] =
            self.with_emitter(|light| [light.origin(), light.axis()].map(DVec3::from_array));
        let height = (origin - aperture).dot(axis);
        let descent = -direction.dot(axis);
        let distance = height / descent;
        (height >= 0.0 && descent > 0.0 && distance.is_finite()).then_some(distance)
    }

    /// Calls `query` with the light of any kind.
    pub fn with_emitter<R>(&self, query: impl FnOnce(&dyn Emitter) -> R) -> R {
        match &self.source {
            Source::Spot { light, .. } => query(light),
            Source::Line { line, light } => match line.profile() {
                LineProfile::Tabulated(profile) => query(&TabulatedLineLight {
                    line: *light,
                    knots: profile.knots(),
                }),
                _ => query(light),
            },
        }
    }
}
