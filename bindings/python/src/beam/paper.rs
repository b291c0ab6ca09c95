//! Formulas as Bergmann et al. 2016 print them.

use pyo3::prelude::*;
use tem00_beam::{self as physics, DVec3};

use super::{
    arguments::{columns, components, map, map_inner, try_map, uniforms},
    emitter::is_dark_number,
    gaussian::GaussianBeam,
    light::vectors,
    lights::SpotLight,
    line_lights::LineLight,
    records::record,
};
use crate::{
    arrays::{Numbers, evaluate},
    error::OrRaise,
};

/// Formulas as Bergmann et al. 2016 print them, each with the size of its error.
///
/// The rest of the package does not use them. They are here to reproduce that paper's figures and to
/// lay the difference beside them.
#[pymodule(submodule)]
pub(crate) mod paper {
    #[pymodule_export]
    use super::{
        DiscConeRay, DiscConeSampler, PrintedEvent, PrintedFan, line_next_event, lost_by_cone,
        lost_by_fan_cone, modified_divergence, radiance, spot_next_event, streamline_point,
    };
}

record! {
    "tem00.beam.paper",
    /// The printed next-event estimation: a point of the aperture and a radiance from there.
    ///
    /// For arrays of points all members are arrays, and 0 where there is no event.
    PrintedEvent {
        /// Point of the aperture, by the ratio of beam radii, shape (..., 3).
        point,
        /// Distance to ``point``, in metres, shape (...).
        distance,
        /// Unit vector towards ``point``, shape (..., 3).
        wi,
        /// ``E / cos θ``, in W/m²: the coefficient of a delta distribution over directions,
        /// shape (...).
        radiance,
    }
}

record! {
    "tem00.beam.paper",
    /// A ray of the printed sampler, in the frame of the aperture: +z travel, z = 0 the disc.
    DiscConeRay {
        /// Point of the disc, in metres, shape (..., 3).
        origin,
        /// Unit vector along the ray, shape (..., 3).
        direction,
        /// Probability density of ``origin``, per m² of the disc, shape (...).
        pdf_position,
        /// Probability density of ``direction``, per steradian, shape (...).
        pdf_direction,
    }
}

/// Return the modified divergence ``θ √(−½ ln l)`` in radians.
///
/// The formula is right; the cone leaves out ``lost_by_cone`` of the power.
///
/// Parameters
/// ----------
/// beam : GaussianBeam
/// l : float or array_like
///     Fraction of the peak that the cone reaches down to, in (0, 1).
///
/// Returns
/// -------
/// float or ndarray
///     Half-angle in radians, in the shape of ``l``.
#[pyfunction]
fn modified_divergence<'py>(
    py: Python<'py>,
    beam: &GaussianBeam,
    l: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    try_map(py, ("l", &l), |l| {
        physics::paper::modified_divergence(&beam.0, l)
    })
}

/// Return the fraction of the power of a circular beam outside the cone.
///
/// Parameters
/// ----------
/// l : float or array_like
///     Fraction of the peak that the cone reaches down to, in (0, 1).
///
/// Returns
/// -------
/// float or ndarray
///     Fraction lost, in the shape of ``l``.
#[pyfunction]
fn lost_by_cone<'py>(py: Python<'py>, l: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
    try_map(py, ("l", &l), physics::paper::lost_by_cone)
}

/// Return the fraction of the power of a laser line outside the wedge, ``1 − erf(√(−ln l))``.
///
/// Parameters
/// ----------
/// l : float or array_like
///     Fraction of the peak that the wedge reaches down to, in (0, 1).
///
/// Returns
/// -------
/// float or ndarray
///     Fraction lost, in the shape of ``l``.
#[pyfunction]
fn lost_by_fan_cone<'py>(py: Python<'py>, l: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
    try_map(py, ("l", &l), physics::paper::lost_by_fan_cone)
}

/// Return the radiance of eq. (3), ``L = E / cos θ``.
///
/// It stands before a delta distribution over directions. The division makes a surface as bright as if
/// it faced the beam whatever its tilt, so that it receives ``P / cos θ``.
///
/// Parameters
/// ----------
/// irradiance, cos_surface : float or array_like
///     Irradiance of a plane across the beam, and cosine between the normal of the surface and the
///     light; they broadcast together.
///
/// Returns
/// -------
/// float, ndarray or None
///     In the unit of ``irradiance`` and in the common shape. Where the cosine is not positive None
///     for numbers, and 0 in arrays.
#[pyfunction]
fn radiance<'py>(
    py: Python<'py>,
    irradiance: Numbers<'py>,
    cos_surface: Numbers<'py>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let arguments = [("irradiance", &irradiance), ("cos_surface", &cos_surface)];
    let [radiance, lit] = evaluate(py, columns(arguments)?, [&[], &[]], |[e, cos], [l, lit]| {
        for i in 0..e.len() {
            if let Some(radiance) = physics::paper::radiance(e[i], cos[i]) {
                (l[i], lit[i]) = (radiance, 1.0);
            }
        }
    })?;
    Ok((!is_dark_number(&lit)).then_some(radiance))
}

/// Return the point of the aperture that belongs to a receiver, by the ratio of beam radii.
///
/// It follows the streamline of energy exactly; the straight line between the two is not the direction
/// of the flow.
///
/// Parameters
/// ----------
/// beam : GaussianBeam
/// x, y, z : float or array_like
///     Coordinates of the receiver, in metres, with the waist at z = 0.
/// aperture_z : float or array_like
///     Coordinate of the aperture along the beam, in metres. All broadcast together.
///
/// Returns
/// -------
/// ndarray, shape (..., 3)
///     Points of the aperture.
#[pyfunction]
fn streamline_point<'py>(
    py: Python<'py>,
    beam: &GaussianBeam,
    x: Numbers<'py>,
    y: Numbers<'py>,
    z: Numbers<'py>,
    aperture_z: Numbers<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments = [("x", &x), ("y", &y), ("z", &z), ("aperture_z", &aperture_z)];
    map_inner(py, columns(arguments)?, &[3], |[x, y, z, aperture_z]| {
        let receiver = DVec3::new(x, y, z);
        physics::paper::streamline_point(&beam.0, receiver, aperture_z).to_array()
    })
}

/// Return the printed next-event estimation of a laser spot.
///
/// Parameters
/// ----------
/// light : SpotLight
/// x, y, z : float or array_like
///     Coordinates of the points, in metres; they broadcast together and with ``n[..., 0]``.
/// n : array_like, shape (..., 3)
///     Unit normals of the surface.
///
/// Returns
/// -------
/// PrintedEvent or None
///     For numbers None outside the cut-off, behind the aperture, or on the unlit side. For arrays all
///     members are 0 there.
#[pyfunction]
fn spot_next_event<'py>(
    py: Python<'py>,
    light: &SpotLight,
    x: Numbers<'py>,
    y: Numbers<'py>,
    z: Numbers<'py>,
    n: Numbers<'py>,
) -> PyResult<Option<PrintedEvent>> {
    printed_events(py, [x, y, z, n], |p, n| {
        physics::paper::spot_next_event(&light.0, p, n)
    })
}

/// Return the printed next-event estimation of a laser line.
///
/// Parameters
/// ----------
/// light : LineLight
/// x, y, z : float or array_like
///     Coordinates of the points, in metres; they broadcast together and with ``n[..., 0]``.
/// n : array_like, shape (..., 3)
///     Unit normals of the surface.
///
/// Returns
/// -------
/// PrintedEvent or None
///     For numbers None outside the cut-off, at or behind the lens, or on the unlit side. For arrays
///     all members are 0 there.
#[pyfunction]
fn line_next_event<'py>(
    py: Python<'py>,
    light: &LineLight,
    x: Numbers<'py>,
    y: Numbers<'py>,
    z: Numbers<'py>,
    n: Numbers<'py>,
) -> PyResult<Option<PrintedEvent>> {
    printed_events(py, [x, y, z, n], |p, n| {
        physics::paper::line_next_event(&light.0, p, n)
    })
}

fn printed_events(
    py: Python<'_>,
    [x, y, z, n]: [Numbers<'_>; 4],
    query: impl Fn([f64; 3], [f64; 3]) -> Option<physics::paper::PrintedEvent> + Send + Sync,
) -> PyResult<Option<PrintedEvent>> {
    let [x, y, z] = columns([("x", &x), ("y", &y), ("z", &z)])?;
    let [n_x, n_y, n_z] = components(("n", &n))?;
    let inner: [&[usize]; 5] = [&[3], &[], &[3], &[], &[]];
    let arguments = [x, y, z, n_x, n_y, n_z];
    let [point, distance, wi, radiance, lit] = evaluate(py, arguments, inner, |columns, out| {
        let [point, distance, wi, radiance, lit] = out;
        for (i, (point, wi)) in vectors(point).zip(vectors(wi)).enumerate() {
            let [x, y, z, n @ ..] = columns.map(|column| column[i]);
            if let Some(event) = query([x, y, z], n) {
                (*point, *wi) = (event.point, event.wi);
                (distance[i], radiance[i], lit[i]) = (event.distance, event.radiance, 1.0);
            }
        }
    })?;
    let event = PrintedEvent {
        point: point.unbind(),
        distance: distance.unbind(),
        wi: wi.unbind(),
        radiance: radiance.unbind(),
    };
    Ok((!is_dark_number(&lit)).then_some(event))
}

/// The laser fan as printed: the irradiance of the round beam, with x scaled to the line.
///
/// The factor that a change of variable brings is missing, so that the power on a plane is
/// ``power_per_watt`` instead of 1.
///
/// Parameters
/// ----------
/// focus : GaussianBeam
/// fan_angle : float
///     Full fan angle, in radians, in (0, π).
/// focus_distance : float
///     Distance from the emitter to the waist, in metres.
#[pyclass(frozen, eq, module = "tem00.beam.paper")]
#[derive(Clone, Copy, Debug, PartialEq)]
struct PrintedFan(physics::paper::PrintedFan);

#[pymethods]
impl PrintedFan {
    #[new]
    fn new(focus: &GaussianBeam, fan_angle: f64, focus_distance: f64) -> PyResult<Self> {
        let fan = physics::paper::PrintedFan::new(focus.0, fan_angle, focus_distance);
        Ok(Self(fan.or_raise()?))
    }

    /// Return the printed irradiance per watt, in 1/m², on planes square to the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates in the frame of the emitter, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Irradiance per watt, in the common shape; 0 unless z is positive.
    fn irradiance_per_watt<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("x", &x), ("y", &y), ("z", &z)], |p| {
            self.0.irradiance_per_watt(DVec3::from(p))
        })
    }

    /// Return the power, per watt of the laser, that the printed irradiance adds up to on a plane.
    ///
    /// Parameters
    /// ----------
    /// z : float or array_like
    ///     Distance from the emitter, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     ``T z / w(z)``, in the shape of ``z``; 1 if all were right.
    fn power_per_watt<'py>(&self, py: Python<'py>, z: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        map(py, [("z", &z)], |[z]| self.0.power_per_watt(z))
    }
}

/// The printed sampler of rays: a uniform point of the aperture disc, a uniform direction of the
/// modified cone.
///
/// It does not sample the beam: taken literally its mean on a plane has the unit W·sr, and light is
/// lost.
///
/// Parameters
/// ----------
/// beam : GaussianBeam
/// waist_distance : float
///     Signed distance from the aperture to the waist, in metres.
/// l : float
///     Fraction of the peak that the cone reaches down to, in (0, 1).
#[pyclass(frozen, eq, module = "tem00.beam.paper")]
#[derive(Clone, Copy, Debug, PartialEq)]
struct DiscConeSampler(physics::paper::DiscConeSampler);

#[pymethods]
impl DiscConeSampler {
    #[new]
    fn new(beam: &GaussianBeam, waist_distance: f64, l: f64) -> PyResult<Self> {
        let sampler = physics::paper::DiscConeSampler::new(&beam.0, waist_distance, l);
        Ok(Self(sampler.or_raise()?))
    }

    /// Radius of the aperture disc, in metres.
    #[getter]
    fn aperture_radius(&self) -> f64 {
        self.0.aperture_radius()
    }

    /// Half-angle of the cone, in radians.
    #[getter]
    fn half_angle(&self) -> f64 {
        self.0.half_angle()
    }

    /// Return rays.
    ///
    /// Parameters
    /// ----------
    /// u : array_like, shape (..., 4)
    ///     Uniform variates in [0, 1).
    ///
    /// Returns
    /// -------
    /// DiscConeRay
    ///     The rays, in the shape of ``u[..., 0]``.
    fn sample<'py>(&self, py: Python<'py>, u: Numbers<'py>) -> PyResult<DiscConeRay> {
        let inner: [&[usize]; 4] = [&[3], &[3], &[], &[]];
        let [origin, direction, pdf_position, pdf_direction] =
            evaluate(py, uniforms::<4>(&u)?, inner, |columns, out| {
                let [origin, direction, pdf_position, pdf_direction] = out;
                for (i, (o, d)) in vectors(origin).zip(vectors(direction)).enumerate() {
                    let ray = self.0.sample(columns.map(|column| column[i]));
                    (*o, *d) = (ray.origin.to_array(), ray.direction.to_array());
                    (pdf_position[i], pdf_direction[i]) = (ray.pdf_position, ray.pdf_direction);
                }
            })?;
        Ok(DiscConeRay {
            origin: origin.unbind(),
            direction: direction.unbind(),
            pdf_position: pdf_position.unbind(),
            pdf_direction: pdf_direction.unbind(),
        })
    }
}
