use pyo3::{prelude::*, types::PyDict};
use tem00_decorrelation::{self as physics, DVec3};

use super::{
    frame::LineOfSight,
    geometry::ImagingGeometry,
    vectors::{Array2, array2, orientation_of, shown, vec3},
    wavefront::Wavefront,
};
use crate::{
    arrays::{Components, Vector},
    error::OrRaise,
};

/// Small translations since the reference state, in world coordinates and metres.
///
/// Parameters
/// ----------
/// surface, camera, source : array_like, shape (3,), optional
///     Translations of each; what is left out stands still.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion(pub(super) physics::Motion);

#[pymethods]
impl Motion {
    #[new]
    #[pyo3(signature = (*, surface = None, camera = None, source = None))]
    fn new(
        surface: Option<Components<'_>>,
        camera: Option<Components<'_>>,
        source: Option<Components<'_>>,
    ) -> PyResult<Self> {
        let of = |name, vector: Option<Components<'_>>| {
            vector.map_or(Ok(DVec3::ZERO), |vector| vec3(name, &vector))
        };
        Ok(Self(physics::Motion {
            surface: of("surface", surface)?,
            camera: of("camera", camera)?,
            source: of("source", source)?,
        }))
    }

    fn __repr__(&self) -> String {
        let [surface, camera, source] = [self.0.surface, self.0.camera, self.0.source].map(shown);
        format!("Motion(surface={surface}, camera={camera}, source={source})")
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("surface", self.0.surface.to_array())?;
        named.set_item("camera", self.0.camera.to_array())?;
        named.set_item("source", self.0.source.to_array())?;
        Ok(((), named))
    }
}

methods! {
    impl Motion as this: this.0;

    /// Translation of the surface in metres, of shape (3,).
    field surface -> Vector<3>;

    /// Translation of the camera in metres, of shape (3,).
    field camera -> Vector<3>;

    /// Translation of the light source and its wavefront in metres, of shape (3,).
    field source -> Vector<3>;

    /// Displacement of the surface as the camera sees it, in metres, of shape (3,).
    get surface_seen_by_camera -> Vector<3>;

    /// Displacement of the surface through the illumination, in metres, of shape (3,).
    get surface_within_illumination -> Vector<3>;
}

/// A point of a rough surface, as the camera sees it and as the laser lights it.
///
/// Parameters
/// ----------
/// sight : LineOfSight
///     Line of sight to the point.
/// normal : array_like, shape (3,)
///     Normal of the surface, of any length and to either side.
/// wavefront : Wavefront
///     The light on the point.
#[pyclass(frozen, eq, module = "tem00.decorrelation")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint(pub(super) physics::SurfacePoint);

#[pymethods]
impl SurfacePoint {
    #[new]
    fn new(
        sight: PyRef<'_, LineOfSight>,
        normal: Components<'_>,
        wavefront: PyRef<'_, Wavefront>,
    ) -> PyResult<Self> {
        let normal = vec3("normal", &normal)?;
        let point = physics::SurfacePoint::new(sight.0, normal, wavefront.0);
        Ok(Self(point.or_raise()?))
    }

    fn __repr__(&self) -> String {
        let sight = LineOfSight(*self.0.sight()).__repr__();
        let normal = shown(self.0.normal());
        let wavefront = Wavefront(*self.0.wavefront()).__repr__();
        format!("<SurfacePoint: sight={sight}, normal={normal}, wavefront={wavefront}>")
    }

    /// Return how far the speckle moves in the image, in metres on the sensor.
    ///
    /// Parameters
    /// ----------
    /// geometry : ImagingGeometry
    ///     The camera.
    /// motion : Motion
    ///     What moved.
    /// orientation : {"screen_upright", "sensor_inverted"}
    ///     Which way up displacements are counted.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2,)
    ///     Components along b1 and b2.
    fn image_displacement<'py>(
        &self,
        py: Python<'py>,
        geometry: PyRef<'py, ImagingGeometry>,
        motion: PyRef<'py, Motion>,
        orientation: &str,
    ) -> PyResult<Array2<'py>> {
        let orientation = orientation_of(orientation)?;
        let displacement = self
            .0
            .image_displacement(&geometry.geometry, &motion.0, orientation);
        array2(py, "motion", displacement)
    }

    /// Return how far the speckle field moves across the pupil, in metres.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (2,) or None
    ///     Components along b1 and b2; ``None`` where the surface is seen edge-on under a curved wave,
    ///     and the pattern counts as decorrelated.
    fn pupil_displacement<'py>(
        &self,
        py: Python<'py>,
        motion: PyRef<'py, Motion>,
    ) -> PyResult<Option<Array2<'py>>> {
        let displacement = self.0.pupil_displacement(&motion.0);
        displacement
            .map(|displacement| array2(py, "motion", displacement))
            .transpose()
    }
}

methods! {
    impl SurfacePoint as this: this.0;

    /// Line of sight to the point.
    get sight -> LineOfSight = LineOfSight(*this.0.sight());

    /// Unit normal of the surface, of shape (3,).
    get normal -> Vector<3>;

    /// The light on the point.
    get wavefront -> Wavefront = Wavefront(*this.0.wavefront());
}
