use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DVec3};

use super::{
    rigid::RigidMotion,
    vectors::{Array3, array3, shown, vec3},
    wavefront::Wavefront,
};
use crate::{arrays::Components, error::OrRaise};

/// A light source in the world: from where it lights each point.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Illumination(pub(super) physics::Illumination);

#[pymethods]
impl Illumination {
    /// Return collimated light from the direction to its source, of shape (3,) and any length.
    #[staticmethod]
    fn collimated(direction_to_source: Components<'_>) -> PyResult<Self> {
        let direction = vec3("direction_to_source", &direction_to_source)?;
        Ok(Self(
            physics::Illumination::collimated(direction).or_raise()?,
        ))
    }

    /// Return the light of a point source at a position of shape (3,), in metres.
    #[staticmethod]
    fn point_source(position: Components<'_>) -> PyResult<Self> {
        let light = physics::Illumination::point_source(vec3("position", &position)?);
        Ok(Self(light.or_raise()?))
    }

    /// Return light from its wavefront at a position of shape (3,), in metres.
    #[staticmethod]
    fn near(position: Components<'_>, wavefront: PyRef<'_, Wavefront>) -> PyResult<Self> {
        let light = physics::Illumination::near(vec3("position", &position)?, wavefront.0);
        Ok(Self(light.or_raise()?))
    }

    /// Return the unit vector of shape (3,) from a point, in metres, to the source.
    ///
    /// ``None`` in a focus or at the source itself.
    fn direction_from<'py>(
        &self,
        py: Python<'py>,
        point: Components<'py>,
    ) -> PyResult<Option<Array3<'py>>> {
        let direction = self.0.direction_from(vec3("point", &point)?);
        Ok(direction.map(|direction| array3(py, direction)))
    }

    fn __repr__(&self) -> String {
        match self.0.direction_from(DVec3::ZERO) {
            Some(direction) => format!(
                "<Illumination: from {} as seen from the origin>",
                shown(direction)
            ),
            None => "<Illumination: from the origin>".to_owned(),
        }
    }

    /// Return the light after its source has moved.
    fn moved(&self, motion: PyRef<'_, RigidMotion>) -> Self {
        Self(self.0.moved(&motion.0))
    }
}

methods! {
    impl Illumination as this: this.0;

    unmade "collimated, point_source or near";
}
