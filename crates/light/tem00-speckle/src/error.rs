use core::{error, fmt};
use std::borrow::Cow;

use tem00_numerics::{Refusal, RefusedValue};

/// Reason for which a pupil, a field, a stack or light is refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpeckleError {
    /// An argument is out of its allowed range.
    Refused(Refusal),
    /// A stack takes more memory than [`StackOptions::memory_limit`] allows.
    ///
    /// [`StackOptions::memory_limit`]: crate::StackOptions::memory_limit
    MemoryLimit {
        /// Memory of the stack, in bytes.
        needed: u64,
        /// The memory limit, in bytes.
        limit: u64,
    },
    /// The memory of a stack could not be allocated.
    ///
    /// On Linux this includes every request above the available memory of the system.
    Memory {
        /// The requested memory, in bytes.
        bytes: u64,
    },
}

impl SpeckleError {
    pub(crate) fn refused(
        parameter: &'static str,
        value: impl Into<RefusedValue>,
        allowed: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self::Refused(Refusal::new(parameter, value, allowed))
    }

    /// Returns the name of the refused argument in the function that refused it; "memory" for
    /// [`Memory`](Self::Memory).
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
            Self::Refused(refusal) => refusal.parameter(),
            Self::MemoryLimit { .. } => "memory_limit",
            Self::Memory { .. } => "memory",
        }
    }
}

impl fmt::Display for SpeckleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::MemoryLimit { needed, limit } => write!(
                f,
                "memory for the stack must be at most {limit} bytes, got {needed}: take fewer \
                 slices or a smaller pattern"
            ),
            Self::Memory { bytes } => write!(f, "cannot allocate {bytes} bytes for the stack"),
        }
    }
}

impl error::Error for SpeckleError {}

impl From<Refusal> for SpeckleError {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

#[cfg(test)]
mod tests;
