use core::{error, fmt};
use std::borrow::Cow;

use glam::DVec3;
use tem00_numerics::{Refusal, RefusedValue};

/// Reason for which a description of surface, light or camera is refused.
#[derive(Clone, Debug, PartialEq)]
pub struct WaveError(Refusal);

impl WaveError {
    pub(crate) fn refused(
        parameter: &'static str,
        value: impl Into<RefusedValue>,
        allowed: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self(Refusal::new(parameter, value, allowed))
    }

    pub(crate) fn vector(parameter: &'static str, value: DVec3, allowed: &'static str) -> Self {
        Self::refused(parameter, value.to_array(), allowed)
    }

    /// Returns the name of the parameter.
    pub const fn parameter(&self) -> &'static str {
        self.0.parameter()
    }
}

impl fmt::Display for WaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl error::Error for WaveError {}
