use core::{error, fmt};

/// Error of constructing a pupil, a field, a stack or light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpeckleError {
    /// A quantity is outside its range.
    OutOfRange {
        /// The name of the argument.
        parameter: &'static str,
        /// The rejected value; a number of things is rounded above 2⁵³.
        value: f64,
        /// The allowed values, with the unit.
        allowed: &'static str,
    },
    /// A quantity is outside the limits that another argument sets.
    OutOfLimits {
        /// The name of the argument.
        parameter: &'static str,
        /// The rejected value.
        value: f64,
        /// The smallest and the largest value.
        limits: [f64; 2],
        /// The unit, and what sets the limits.
        unit: &'static str,
    },
    /// A sample of an external field is not finite.
    Sample {
        /// The column of the sample.
        x: usize,
        /// The row of the sample.
        y: usize,
    },
    /// A weight of a sum is negative or not finite.
    Weight {
        /// The position of the weight.
        index: usize,
        /// The rejected weight.
        weight: f64,
    },
    /// Independent patterns need a field with a seed, not one of samples.
    NoSeed,
    /// A stack takes more memory than [`StackOptions::memory_limit`] allows.
    ///
    /// [`StackOptions::memory_limit`]: crate::StackOptions::memory_limit
    MemoryLimit {
        /// The bytes that the stack takes.
        needed: u64,
        /// The bytes that it may take.
        limit: u64,
    },
    /// The machine refused the memory of a stack.
    ///
    /// On Linux this includes whatever exceeds the memory that the system has available.
    Memory {
        /// The bytes that were asked for.
        bytes: u64,
    },
}

impl SpeckleError {
    pub(crate) const fn out_of_range(
        parameter: &'static str,
        value: f64,
        allowed: &'static str,
    ) -> Self {
        Self::OutOfRange {
            parameter,
            value,
            allowed,
        }
    }

    pub(crate) const fn out_of_limits(
        parameter: &'static str,
        value: f64,
        limits: [f64; 2],
        unit: &'static str,
    ) -> Self {
        Self::OutOfLimits {
            parameter,
            value,
            limits,
            unit,
        }
    }

    /// Returns the name of the argument that was refused, as the function that refused it calls it;
    /// "memory" for [`Memory`](Self::Memory), which is about none.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{Pupil, PupilField};
    ///
    /// let field = PupilField::new(64, 16, 1)?;
    /// let error = field.with_pupil(Pupil::Annulus { inner: 1.5 }).unwrap_err();
    /// assert_eq!(error.parameter(), "inner");
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::OutOfRange { parameter, .. } | Self::OutOfLimits { parameter, .. } => parameter,
            Self::Sample { .. } => "samples",
            Self::Weight { .. } => "weights",
            Self::NoSeed => "field",
            Self::MemoryLimit { .. } => "memory_limit",
            Self::Memory { .. } => "memory",
        }
    }
}

impl fmt::Display for SpeckleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange {
                parameter,
                value,
                allowed,
            } => write!(f, "{parameter} must be {allowed}, got {}", Short(*value)),
            Self::OutOfLimits {
                parameter,
                value,
                limits: [smallest, largest],
                unit,
            } => write!(
                f,
                "{parameter} must be {} to {} {unit}, got {}",
                Short(*smallest),
                Short(*largest),
                Short(*value)
            ),
            Self::Sample { x, y } => write!(
                f,
                "samples must be finite, got another at column {x} of row {y}"
            ),
            Self::Weight { index, weight } => write!(
                f,
                "weights must be finite and not negative, got {weight} at index {index}"
            ),
            Self::NoSeed => write!(
                f,
                "field must have a seed for independent patterns, got one of samples"
            ),
            Self::MemoryLimit { needed, limit } => write!(
                f,
                "memory for the stack must be at most {limit} bytes, got {needed}: take fewer \
                 slices or a smaller pattern"
            ),
            Self::Memory { bytes } => write!(
                f,
                "memory for the stack refused: {bytes} bytes are more than the machine has to give"
            ),
        }
    }
}

impl error::Error for SpeckleError {}

/// A number that is legible at any size.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size.is_finite() && size > 0.0 && !(1e-3..1e9).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

/// Asserts the text of a refusal: the rule, such as "inner must be inside (0, 1)", and the value.
#[cfg(test)]
#[track_caller]
pub(crate) fn assert_refused<T: fmt::Debug>(
    result: Result<T, SpeckleError>,
    rule: &str,
    value: impl Into<f64>,
) {
    let text = result.unwrap_err().to_string();
    assert_eq!(text, format!("{rule}, got {}", Short(value.into())));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_legible_at_any_size() {
        let text = |value| SpeckleError::out_of_range("x", value, "else").to_string();
        for (value, shown) in [
            (0.0, "0"),
            (-1.5, "-1.5"),
            (32_768.0, "32768"),
            (6.5e-7, "6.5e-7"),
            (-2e12, "-2e12"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(text(value), format!("x must be else, got {shown}"));
        }
        let wide = SpeckleError::out_of_limits("x", 1.0, [0.0, 6.5e-8], "m");
        assert_eq!(wide.to_string(), "x must be 0 to 6.5e-8 m, got 1");
    }

    #[test]
    fn every_refusal_names_its_argument() {
        let [needed, limit] = [2, 1];
        for (error, parameter, part) in [
            (
                SpeckleError::Sample { x: 3, y: 2 },
                "samples",
                "column 3 of row 2",
            ),
            (
                SpeckleError::Weight {
                    index: 3,
                    weight: -1.5,
                },
                "weights",
                "-1.5 at index 3",
            ),
            (SpeckleError::NoSeed, "field", "must have a seed"),
            (
                SpeckleError::MemoryLimit { needed, limit },
                "memory_limit",
                "at most 1 bytes, got 2",
            ),
            (SpeckleError::Memory { bytes: 9 }, "memory", "9 bytes"),
        ] {
            assert_eq!(error.parameter(), parameter, "{error}");
            assert!(error.to_string().contains(part), "{error}");
        }
    }
}
