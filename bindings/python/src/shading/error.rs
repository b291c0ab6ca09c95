use pyo3::prelude::*;
use tem00_shading::ShadingError;

use crate::error::{IntoPython, refused};

impl IntoPython for ShadingError {
    fn into_python(self) -> PyErr {
        match self {
            Self::Speckle(source) => source.into_python(),
            Self::BeyondPoses { .. } => refused("surface", self.to_string()),
            _ => refused(self.parameter().unwrap_or("camera"), self.to_string()),
        }
    }
}
