mod arguments;
mod camera;
mod error;
mod frame;
mod laser;
mod speckle;

use pyo3::prelude::*;

/// One call per hit: the factor by which speckle that moves multiplies the light of a laser.
///
/// The package has these names itself, and ``Pose`` for ``tem00.decorrelation.RigidMotion``. Camera and laser are given
/// as they stand in the reference state, from which poses lead to now. Points, normals and image points are arrays whose
/// last axis holds a vector; image points are in pixels, with y down.
#[pymodule(submodule)]
pub(crate) mod shading {
    #[pymodule_export]
    use super::{
        camera::Camera,
        frame::{SpeckleFrame, SpeckleShift},
        laser::Laser,
        speckle::Speckle,
    };
}
