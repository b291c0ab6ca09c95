//! Bindings of `tem00-shading`, the module `tem00.shading`.

mod camera;
mod frame;
mod laser;
mod speckle;

use pyo3::prelude::*;
use tem00_shading::DVec3;

use crate::arrays::Components;

/// One call per hit: the factor by which speckle that moves multiplies the light of a laser.
///
/// The package has these names itself, and ``Pose`` for ``tem00.decorrelation.RigidMotion``. Camera
/// and laser are given as they stand in the reference state, from which poses lead to now. Points,
/// normals and image points are arrays whose last axis holds a vector; image points are in pixels,
/// with y down.
#[pymodule(submodule)]
pub(crate) mod shading {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{camera::Camera, frame::SpeckleFrame, laser::Laser, speckle::Speckle};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::arrays::add_named(module, &["SpeckleShift"])
    }
}

/// A vector of finite components, or what stands for one that is left out.
fn vector<const K: usize>(
    name: &'static str,
    given: Option<&Components<'_>>,
    default: [f64; K],
) -> PyResult<[f64; K]> {
    given.map_or(Ok(default), |given| given.vector(name))
}

/// Vectors may be whatever they are: the laws have an answer for NaN.
const LIMIT: f64 = f64::INFINITY;

/// The vectors with these components.
fn vectors([x, y, z]: [&[f64]; 3]) -> Vec<DVec3> {
    (0..x.len()).map(|i| DVec3::new(x[i], y[i], z[i])).collect()
}
