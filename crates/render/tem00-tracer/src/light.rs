mod sample;
mod spherical_rectangle;

use core::f64::consts::PI;

use glam::DVec3;
use tem00_geometry::Rectangle;

pub use self::sample::LightSample;
use self::spherical_rectangle::SphericalRectangle;
use crate::{Environment, TracerError, error::check_light};

/// The wavelength of white light, in metres, which has its middle there: materials are evaluated at
/// it, and its photons are counted at it.
pub const WHITE_LIGHT_WAVELENGTH: f64 = 550e-9;

/// The solid angle, in steradian, below which near rectangles are sampled by area, as far
/// rectangles are: its rounding error is 1e−11 of this.
const SMALL_SOLID_ANGLE: f64 = 1e-4;

/// A source of incoherent light, without its own colour.
///
/// # Examples
///
/// A point light of 4π W gives 1 W/m² at 1 m, and a quarter of it at 2 m:
///
/// ```
/// use core::f64::consts::PI;
///
/// use glam::DVec3;
/// use tem00_tracer::Light;
///
/// let light = Light::point(DVec3::new(0.0, 0.0, 2.0), 4.0 * PI)?;
/// let sample = light.sample(DVec3::ZERO, [0.5, 0.5]).expect("light arrives");
/// assert_eq!((sample.direction, sample.distance), (DVec3::Z, 2.0));
/// assert!((sample.radiance_over_pdf - 0.25).abs() < 1e-15); // W/m²
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// A point that shines equally in all directions.
    Point {
        /// The position, in metres.
        position: DVec3,
        /// The radiant power, in watts.
        power: f64,
    },
    /// A rectangle that shines from its front, with the same radiance in all directions.
    Area {
        /// The rectangle; its normal points to the lit side.
        rectangle: Rectangle,
        /// The radiance, in W/(m² sr).
        radiance: f64,
    },
    /// Light from all around, from beyond the scene.
    Environment(Environment),
}

impl Light {
    /// Creates a point light of `power` watts at `position`.
    ///
    /// # Errors
    ///
    /// Returns an error if the power is negative or not finite, or the position is not finite.
    pub fn point(position: DVec3, power: f64) -> Result<Self, TracerError> {
        check_light("power", power)?;
        if !position.is_finite() {
            return Err(TracerError::Direction {
                parameter: "position",
                allowed: "a finite point",
            });
        }
        Ok(Self::Point { position, power })
    }

    /// Creates an area light of `radiance` W/(m² sr).
    ///
    /// # Errors
    ///
    /// Returns an error if the radiance is negative or not finite.
    pub fn area(rectangle: Rectangle, radiance: f64) -> Result<Self, TracerError> {
        check_light("radiance", radiance)?;
        Ok(Self::Area {
            rectangle,
            radiance,
        })
    }

    /// Draws a direction in which light comes to the point `from`, in metres, by two uniform
    /// numbers in [0, 1).
    ///
    /// Rectangles are drawn uniformly over their area from afar and, nearer than their diagonal,
    /// over the solid angle that they cover; environments in proportion to their radiance. Returns
    /// `None` where the light does not reach. The caller checks whether the path is free.
    pub fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<LightSample> {
        match self {
            Self::Point { position, power } => sample_point(*position - from, *power),
            Self::Area {
                rectangle,
                radiance,
            } => sample_rectangle(rectangle, *radiance, from, u),
            Self::Environment(environment) => environment.sample(u),
        }
        .filter(|sample| sample.radiance_over_pdf > 0.0)
    }

    /// Returns the density with which [`sample`](Self::sample) draws `direction`, of unit length,
    /// at the point `from`, in metres; per steradian.
    ///
    /// It is 0 for directions that miss the light, and for a point.
    pub fn pdf(&self, from: DVec3, direction: DVec3) -> f64 {
        match self {
            Self::Point { .. } => 0.0,
            Self::Area {
                rectangle,
                radiance,
            } if *radiance > 0.0 => pdf_of_rectangle(rectangle, from, direction),
            Self::Area { .. } => 0.0,
            Self::Environment(environment) => environment.pdf(direction),
        }
    }

    /// Returns the radiance, in W/(m² sr), that comes along a ray of this direction, of unit
    /// length, which meets the light or, for an environment, nothing at all.
    pub fn radiance_along(&self, direction: DVec3) -> f64 {
        match self {
            Self::Point { .. } => 0.0,
            Self::Area {
                rectangle,
                radiance,
            } => {
                let lit_side = rectangle.normal().dot(direction) < 0.0;
                if lit_side { *radiance } else { 0.0 }
            }
            Self::Environment(environment) => environment.radiance_along(direction),
        }
    }
}

#[inline(always)]
fn sample_point(offset: DVec3, power: f64) -> Option<LightSample> {
    let squared = offset.length_squared();
    let direction = offset.try_normalize()?;
    let irradiance = power / (4.0 * PI) / squared;
    irradiance.is_finite().then_some(LightSample {
        direction,
        distance: squared.sqrt(),
        radiance_over_pdf: irradiance,
        pdf: None,
    })
}

fn sample_rectangle(
    rectangle: &Rectangle,
    radiance: f64,
    from: DVec3,
    u: [f64; 2],
) -> Option<LightSample> {
    if !faces(rectangle, from) {
        return None;
    }
    let image = near_image(rectangle, from);
    let offset = match &image {
        Some(image) => image.sample(u),
        None => rectangle.point(u[0], u[1]) - from,
    };
    let distance = offset.length();
    let direction = offset / distance;
    let pdf = match &image {
        Some(image) => 1.0 / image.solid_angle(),
        None => pdf_by_area(rectangle, direction, distance),
    };
    // Rounding can put a point before a rectangle onto it.
    (distance > 0.0 && pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
        direction,
        distance,
        radiance_over_pdf: radiance / pdf,
        pdf: Some(pdf),
    })
}

fn pdf_of_rectangle(rectangle: &Rectangle, from: DVec3, direction: DVec3) -> f64 {
    let towards = -direction.dot(rectangle.normal());
    if towards <= 0.0 || !faces(rectangle, from) {
        return 0.0;
    }
    let distance = (from - rectangle.centre()).dot(rectangle.normal()) / towards;
    let on_plane = from + distance * direction - rectangle.centre();
    let [u, v] = rectangle.fractions(on_plane);
    if u.abs() > 1.0 || v.abs() > 1.0 {
        return 0.0;
    }
    match near_image(rectangle, from) {
        Some(image) => 1.0 / image.solid_angle(),
        None => pdf_by_area(rectangle, direction, distance),
    }
}

/// Returns whether a point sees the front of a rectangle.
fn faces(rectangle: &Rectangle, from: DVec3) -> bool {
    (from - rectangle.centre()).dot(rectangle.normal()) > 0.0
}

/// Returns the image of a rectangle for a point in front of it and nearer to its centre than its
/// diagonal is long. Farther away, points drawn by area do as well at a tenth of the cost.
fn near_image(rectangle: &Rectangle, from: DVec3) -> Option<SphericalRectangle> {
    let half_diagonal_squared =
        rectangle.half_u().length_squared() + rectangle.half_v().length_squared();
    (from.distance_squared(rectangle.centre()) < 4.0 * half_diagonal_squared)
        .then(|| SphericalRectangle::new(rectangle, from))
        .filter(|image| image.solid_angle() >= SMALL_SOLID_ANGLE)
}

/// r² / (A cos θ), the density per steradian of points that are uniform over the area.
fn pdf_by_area(rectangle: &Rectangle, direction: DVec3, distance: f64) -> f64 {
    let cosine = -direction.dot(rectangle.normal());
    distance * distance / (rectangle.area() * cosine)
}

#[cfg(test)]
mod tests;
