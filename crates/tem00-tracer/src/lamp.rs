use glam::DVec3;

use crate::{Rectangle, TracerError};

/// A source of incoherent light, without colour of its own.
#[derive(Clone, Debug, PartialEq)]
pub enum Lamp {
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
}

impl Lamp {
    /// Creates a point lamp of `power` watts at `position`.
    ///
    /// # Errors
    ///
    /// Returns an error if the power is negative or not finite, or the position is not finite.
    pub fn point(position: DVec3, power: f64) -> Result<Self, TracerError> {
        check("power", power)?;
        if !position.is_finite() {
            return Err(TracerError::Direction {
                parameter: "position",
                allowed: "a finite point",
            });
        }
        Ok(Self::Point { position, power })
    }

    /// Creates an area lamp of `radiance` W/(m² sr).
    ///
    /// # Errors
    ///
    /// Returns an error if the radiance is negative or not finite.
    pub fn area(rectangle: Rectangle, radiance: f64) -> Result<Self, TracerError> {
        check("radiance", radiance)?;
        Ok(Self::Area {
            rectangle,
            radiance,
        })
    }
}

fn check(parameter: &'static str, value: f64) -> Result<(), TracerError> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(TracerError::OutOfRange {
        parameter,
        value,
        allowed: "finite and not negative",
    })
}
