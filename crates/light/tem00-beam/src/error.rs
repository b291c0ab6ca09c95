use core::{error, fmt};

use glam::DVec3;

/// Reasons to refuse a beam, an optical system, a laser line or a placed light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BeamError {
    /// A number is outside its range.
    OutOfRange {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The unit of the value, empty for a plain number.
        unit: &'static str,
        /// The allowed values, with their unit.
        allowed: &'static str,
    },
    /// An entry of a list is outside its range.
    Entry {
        /// The name of the list.
        parameter: &'static str,
        /// The position in the list, from 0.
        index: usize,
        /// The rejected value.
        value: f64,
        /// The unit of the value, empty for a plain number.
        unit: &'static str,
        /// The allowed values, with their unit.
        allowed: &'static str,
    },
    /// A vector is not finite, or does not point where it must.
    Vector {
        /// The name of the parameter.
        parameter: &'static str,
        /// The rejected vector.
        value: DVec3,
        /// The allowed values, with their unit.
        allowed: &'static str,
    },
    /// The two axes of a beam or a system differ in what they must share.
    AxesDiffer {
        /// The name of the quantity.
        parameter: &'static str,
        /// Its value in the first and in the second axis.
        values: [f64; 2],
    },
    /// The waist is tighter than the paraxial model allows. Often the two arguments were swapped.
    NotParaxial {
        /// The rejected waist radius, in metres.
        waist_radius: f64,
        /// The smallest waist radius the model accepts at this wavelength and M², in metres.
        minimum: f64,
    },
    /// The distance of the virtual apex behind the lens is too short for the beam it belongs to.
    ApexOffset {
        /// The rejected distance, in metres.
        apex_offset: f64,
        /// The smallest accepted distance, in metres.
        minimum: f64,
    },
    /// A table of angles and powers differs in length, or has fewer than two entries.
    ProfileLength {
        /// The number of angles.
        angles: usize,
        /// The number of powers.
        powers: usize,
    },
    /// A `LineLight` cannot hold a table; a `TabulatedLineLight` can.
    TabulatedProfile,
    /// A `TabulatedLineLight` needs a table; a `LineLight` holds the other profiles.
    NotTabulated,
}

impl BeamError {
    pub(crate) const fn out_of_range(
        parameter: &'static str,
        value: f64,
        unit: &'static str,
        allowed: &'static str,
    ) -> Self {
        Self::OutOfRange {
            parameter,
            value,
            unit,
            allowed,
        }
    }

    /// A field of a placed light is outside the range that single precision can carry.
    pub(crate) const fn single_precision(field: f64) -> Self {
        let allowed = "able to hold all fields of the light in f32";
        Self::out_of_range("single_precision", field, "", allowed)
    }

    /// Returns the name of the argument or field that was refused, as its caller wrote it.
    ///
    /// Where the refused quantity follows from several arguments, it is the name of that quantity,
    /// as `determinant`.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_beam::GaussianBeam;
    ///
    /// let error = GaussianBeam::from_waist(100e-6, 650e-9).unwrap_err();
    /// assert_eq!(error.parameter(), "waist_radius");
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::OutOfRange { parameter, .. }
            | Self::Entry { parameter, .. }
            | Self::Vector { parameter, .. }
            | Self::AxesDiffer { parameter, .. } => parameter,
            Self::NotParaxial { .. } => "waist_radius",
            Self::ApexOffset { .. } => "apex_offset",
            Self::ProfileLength { .. } => "powers",
            Self::TabulatedProfile | Self::NotTabulated => "line",
        }
    }
}

impl fmt::Display for BeamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange {
                parameter,
                value,
                unit,
                allowed,
            } => {
                write!(f, "{parameter} must be {allowed}, got {value:e}")?;
                with_unit(f, unit)
            }
            Self::Entry {
                parameter,
                index,
                value,
                unit,
                allowed,
            } => {
                write!(f, "{parameter} must be {allowed}, got {value:e}")?;
                with_unit(f, unit)?;
                write!(f, " at index {index}")
            }
            Self::Vector {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {value}"),
            Self::AxesDiffer {
                parameter,
                values: [x, y],
            } => write!(
                f,
                "{parameter} must be equal in both axes, got {x:e} and {y:e}"
            ),
            Self::NotParaxial {
                waist_radius,
                minimum,
            } => write!(
                f,
                "waist radius must be at least 2 M² λ / π = {minimum:e} m to be paraxial, \
                 got {waist_radius:e} m"
            ),
            Self::ApexOffset {
                apex_offset,
                minimum,
            } => write!(
                f,
                "apex offset must be at least {minimum:e} m and at most 1e30 m, \
                 got {apex_offset:e} m"
            ),
            Self::ProfileLength { angles, powers } => write!(
                f,
                "profile must have as many powers as angles, and at least 2, \
                 got {angles} angles and {powers} powers"
            ),
            Self::TabulatedProfile => write!(
                f,
                "a tabulated profile must be placed as a TabulatedLineLight, got a LineLight"
            ),
            Self::NotTabulated => write!(
                f,
                "a profile that is not tabulated must be placed as a LineLight, \
                 got a TabulatedLineLight"
            ),
        }
    }
}

fn with_unit(f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
    if unit.is_empty() {
        Ok(())
    } else {
        write!(f, " {unit}")
    }
}

impl error::Error for BeamError {}

#[cfg(test)]
mod tests;
