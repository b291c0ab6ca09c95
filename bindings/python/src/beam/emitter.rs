//! The queries that all placed lights answer.

use numpy::PyArray1;
use pyo3::{prelude::*, types::PyFloat};

use super::{
    arguments::{components, coordinate, coordinates, map_inner, uniforms},
    light::Light,
    records::{ApertureHit, Bounds, NextEvent, RayPdf, RaySample, SampledEvent},
    rows::{Precision, array_of},
};
use crate::arrays::{Array, Column, Numbers, Values, Vector, Vectors, evaluate};

/// A light that a renderer can evaluate and sample: what all placed lights have in common.
///
/// All points and vectors are in world coordinates, in metres. The light shines from the aperture
/// plane into the half-space that its axis points to; points behind that plane receive nothing.
///
/// There are two ways to light a surface, which belong to different path spaces and must not be
/// added up: ``next_event`` takes the mean direction of the energy flow, a delta light;
/// ``next_event_sampled``, ``sample_ray``, ``ray_pdf`` and ``radiance`` share the phase-space density
/// of the light and may be combined by multiple importance sampling.
///
/// Light beyond the cut-off, 4 beam radii by default, is dropped by ``irradiance``, ``flux`` and both
/// next-event forms. Rays are not cut off. Coordinates must be finite and within ±1e30.
#[pyclass(frozen, eq, subclass, module = "tem00.beam")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Emitter(pub(super) Light);

#[pymethods]
impl Emitter {
    /// Return the fields of the light in the order of memory, as rows of four.
    ///
    /// They are what a kernel or a shader reads; the class of each light says which field is where.
    ///
    /// Parameters
    /// ----------
    /// dtype : {"float64", "float32"}, optional
    ///     Precision of the rows.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (6, 4) or (7, 4)
    ///     6 rows for a ``SpotLight``, 7 for all others.
    #[pyo3(signature = (dtype = Precision::Double))]
    fn to_rows<'py>(&self, py: Python<'py>, dtype: Precision) -> PyResult<Array<'py>> {
        Ok(match dtype {
            Precision::Double => array_of(py, &self.0.rows())?.into_any(),
            Precision::Single => array_of(py, &self.0.single_rows())?.into_any(),
        })
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let class = slf.get_type().name()?;
        let rows = slf.get().0.rows();
        Ok(match &slf.get().0 {
            Light::Tabulated(_, profile) => {
                let count = profile.knots().len();
                format!("<{class}: a table of {count} angles, rows {rows:?}>")
            }
            _ => format!("{class}.from_rows({rows:?})"),
        })
    }

    /// Return the irradiance, in W/m², of a plane at right angles to the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Irradiance, in the common shape.
    fn irradiance<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Values<'py>> {
        let points = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [irradiance] = evaluate(py, points, [&[]], |[x, y, z], [out]| {
            self.0.ask(|light| light.irradiance_batch(x, y, z, out));
        })?;
        Ok(irradiance)
    }

    /// Return the energy-flow vector, in W/m².
    ///
    /// A surface whose normal ``n`` lies on the lit side receives the irradiance ``max(0, -F·n)``.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (..., 3)
    ///     Energy flow, with its components in the last axis.
    fn flux<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Array<'py>> {
        let points = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        map_inner(py, points, &[3], |p| self.0.ask(|light| light.flux(p)))
    }

    /// Return the light at points as one direction each: that of the mean energy flow.
    ///
    /// A surface of normal ``n`` receives the irradiance ``e_perp·|n·wi|``, and reflects
    /// ``f·|n·wi|·V·e_perp``.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together.
    ///
    /// Returns
    /// -------
    /// NextEvent or None
    ///     For numbers None outside the cut-off and behind the aperture, where no shadow ray is
    ///     needed. For arrays all members are 0 there.
    fn next_event<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
    ) -> PyResult<Option<NextEvent>> {
        let event = self.event_at(py, coordinates([("x", &x), ("y", &y), ("z", &z)])?)?;
        Ok((!is_dark_number(event.e_perp.bind(py))).then_some(event))
    }

    /// Return the light at points as one direction each, drawn from the phase-space density there.
    ///
    /// The estimate of the reflected radiance is ``f·|n·wi|·V·value``: ``value`` has been divided by
    /// the density already. The mean over ``u`` is that of ``next_event``.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together and with ``u[..., 0]``.
    /// u : array_like, shape (..., 2)
    ///     Uniform variates in [0, 1).
    ///
    /// Returns
    /// -------
    /// SampledEvent or None
    ///     For numbers None outside the cut-off and behind the aperture. For arrays all members are 0
    ///     there.
    fn next_event_sampled<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
        u: Vectors<'py>,
    ) -> PyResult<Option<SampledEvent>> {
        let [x, y, z] = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [u0, u1] = uniforms(&u)?;
        let inner: [&[usize]; 5] = [&[3], &[], &[3], &[], &[]];
        let [point, distance, wi, value, pdf] =
            evaluate(py, [x, y, z, u0, u1], inner, |columns, out| {
                self.0.sampled_events(columns, out);
            })?;
        let dark = is_dark_number(&value);
        let event = SampledEvent {
            point: point.unbind(),
            distance: distance.unbind(),
            wi: wi.unbind(),
            value: value.unbind(),
            pdf: pdf.unbind(),
        };
        Ok((!dark).then_some(event))
    }

    /// Return the density, per steradian, with which ``next_event_sampled`` draws a direction.
    ///
    /// It is 0 outside the cut-off, behind the aperture and for a ``wi`` along the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together and with ``wi[..., 0]``.
    /// wi : array_like, shape (..., 3)
    ///     Unit vectors towards the light.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Density per steradian, in the common shape.
    fn next_event_pdf<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
        wi: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        let [x, y, z] = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [wi_x, wi_y, wi_z] = components(("wi", &wi))?;
        let columns = [x, y, z, wi_x, wi_y, wi_z];
        map_inner(py, columns, &[], |[x, y, z, wi @ ..]| {
            [self.0.ask(|light| light.next_event_pdf([x, y, z], wi))]
        })
    }

    /// Return the light that rays from points meet, for directions that a material has drawn.
    ///
    /// It is the other technique beside ``next_event_sampled``: a direction of the density ``q`` has
    /// the weight ``q / (q + pdf)`` of the balance heuristic. Only what is nearer than ``distance``
    /// hides the light.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of the points, in metres; they broadcast together and with ``wi[..., 0]``.
    /// wi : array_like, shape (..., 3)
    ///     Unit vectors towards the light.
    ///
    /// Returns
    /// -------
    /// ApertureHit or None
    ///     For numbers None where the ray meets no light. For arrays all members are 0 there.
    fn hit<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
        wi: Vectors<'py>,
    ) -> PyResult<Option<ApertureHit>> {
        let [x, y, z] = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [wi_x, wi_y, wi_z] = components(("wi", &wi))?;
        let columns = [x, y, z, wi_x, wi_y, wi_z];
        let inner: [&[usize]; 4] = [&[3], &[], &[], &[]];
        let [point, distance, radiance, pdf] = evaluate(py, columns, inner, |columns, out| {
            self.0.hits(columns, out);
        })?;
        let dark = is_dark_number(&radiance);
        let hit = ApertureHit {
            point: point.unbind(),
            distance: distance.unbind(),
            radiance: radiance.unbind(),
            pdf: pdf.unbind(),
        };
        Ok((!dark).then_some(hit))
    }

    /// Return bounds of the power, in watts, that reaches axis-aligned boxes.
    ///
    /// A hierarchy of lights visits none whose bound is 0: behind the aperture, beyond the cut-off, or
    /// for an empty box. The bound of a box within the beam is a small multiple of its power.
    ///
    /// Parameters
    /// ----------
    /// min, max : array_like, shape (..., 3)
    ///     Corners of the boxes, in metres, within ±1e30; they broadcast together.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Bounds, in the common shape.
    fn power_bound<'py>(
        &self,
        py: Python<'py>,
        min: Vectors<'py>,
        max: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        let [a, b, c] = components(("min", &min))?;
        let [d, e, f] = components(("max", &max))?;
        map_inner(py, [a, b, c, d, e, f], &[], |[a, b, c, max @ ..]| {
            [self.0.ask(|light| light.power_bound([a, b, c], max))]
        })
    }

    /// Return rays that leave the aperture, drawn from the phase-space density of the light.
    ///
    /// Parameters
    /// ----------
    /// u : array_like, shape (..., 4)
    ///     Uniform variates in [0, 1).
    ///
    /// Returns
    /// -------
    /// RaySample
    ///     The rays, in the shape of ``u[..., 0]``.
    fn sample_ray<'py>(&self, py: Python<'py>, u: Vectors<'py>) -> PyResult<RaySample> {
        let columns = uniforms::<4>(&u)?;
        let inner: [&[usize]; 8] = [&[3], &[], &[3], &[], &[], &[], &[], &[]];
        let [origin, flux, direction, cos, pdf @ ..] =
            evaluate(py, columns, inner, |columns, out| self.0.rays(columns, out))?;
        Ok(RaySample {
            origin: origin.unbind(),
            flux: flux.unbind(),
            direction: direction.unbind(),
            cos: cos.unbind(),
            pdf: Py::new(py, RayPdf::of(pdf))?.into_any(),
        })
    }

    /// Return the densities with which ``sample_ray`` draws the rays through points.
    ///
    /// They are 0 for a ray against the axis.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of any point of each ray, in metres; they broadcast together and with
    ///     ``d[..., 0]``.
    /// d : array_like, shape (..., 3)
    ///     Unit vectors along the rays.
    ///
    /// Returns
    /// -------
    /// RayPdf
    ///     The densities, in the common shape.
    fn ray_pdf<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
        d: Vectors<'py>,
    ) -> PyResult<RayPdf> {
        let [x, y, z] = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [d_x, d_y, d_z] = components(("d", &d))?;
        let columns = [x, y, z, d_x, d_y, d_z];
        let pdf = evaluate(py, columns, [&[]; 4], |columns, out| {
            self.0.ray_pdfs(columns, out);
        })?;
        Ok(RayPdf::of(pdf))
    }

    /// Return the radiance, in W/(m² sr), of the rays through points.
    ///
    /// It is constant along a ray in free space, and 0 for a ray against the axis. Its integral over
    /// direction, weighted with the cosine to the axis, is the irradiance.
    ///
    /// Parameters
    /// ----------
    /// x, y, z : float or array_like
    ///     Coordinates of any point of each ray, in metres; they broadcast together and with
    ///     ``d[..., 0]``.
    /// d : array_like, shape (..., 3)
    ///     Unit vectors along the rays, in the direction of travel.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Radiance, in the common shape.
    fn radiance<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
        z: Numbers<'py>,
        d: Vectors<'py>,
    ) -> PyResult<Values<'py>> {
        let [x, y, z] = coordinates([("x", &x), ("y", &y), ("z", &z)])?;
        let [d_x, d_y, d_z] = components(("d", &d))?;
        map_inner(py, [x, y, z, d_x, d_y, d_z], &[], |[x, y, z, d @ ..]| {
            [self.0.ask(|light| light.radiance([x, y, z], d))]
        })
    }

    /// Return bounds of the light from the aperture to a distance along its axis.
    ///
    /// The box holds all points within the cut-off. The cone holds the mean energy flow at all of
    /// them; a sampled ray is outside it with a probability of about exp(-2 cutoff²).
    ///
    /// Parameters
    /// ----------
    /// l : float
    ///     Distance along the axis, in metres, within ±1e30.
    fn bounds(&self, py: Python<'_>, l: f64) -> PyResult<Bounds> {
        let l = coordinate("l", l)?;
        let bounds = self.0.ask(|light| light.bounds(l));
        let vector = |v: [f64; 3]| PyArray1::from_slice(py, &v).into_any().unbind();
        Ok(Bounds {
            min: vector(bounds.min),
            max: vector(bounds.max),
            axis: vector(bounds.axis),
            half_angle: PyFloat::new(py, bounds.half_angle).into_any().unbind(),
        })
    }
}

methods! {
    impl Emitter as this: this.0;

    unmade "SpotLight.place, LineLight.place or TabulatedLineLight.place";

    /// Centre of the aperture (the lens of a laser line), in metres, shape (3,).
    get origin -> Vector<3> = this.vector(0);

    /// Unit vector of the local x axis, along which a fan opens, shape (3,).
    get ex -> Vector<3> = this.vector(1);

    /// Unit vector of the local y axis, the normal of the plane of a fan, shape (3,).
    get ey -> Vector<3> = this.vector(2);

    /// Unit vector along the direction of travel, shape (3,).
    get ez -> Vector<3> = this.vector(3);

    /// Power, in watts.
    get power -> f64 = this.0.ask(|light| light.power());

    /// Wavelength in the medium, in metres.
    get wavelength -> f64 = this.0.ask(|light| light.wavelength());

    /// Distance from the axis, in beam radii, beyond which no light arrives; in a laser line that
    /// from the plane of the fan.
    get cutoff -> f64 = this.0.frame_rows()[1][3];
}

impl Emitter {
    fn vector(&self, row: usize) -> Vector<3> {
        let [x, y, z, _] = self.0.frame_rows()[row];
        [x, y, z].into()
    }
}

impl Emitter {
    /// Returns the light at points, all members 0 where there is none.
    pub(crate) fn event_at(&self, py: Python<'_>, points: [Column<'_>; 3]) -> PyResult<NextEvent> {
        let inner: [&[usize]; 4] = [&[3], &[], &[3], &[]];
        let [point, distance, wi, e_perp] = evaluate(py, points, inner, |points, out| {
            self.0.next_events(points, out);
        })?;
        Ok(NextEvent {
            point: point.unbind(),
            distance: distance.unbind(),
            wi: wi.unbind(),
            e_perp: e_perp.unbind(),
        })
    }
}

/// Returns true for the value 0 of one point.
pub(super) fn is_dark_number(irradiance: &Bound<'_, PyAny>) -> bool {
    irradiance
        .cast::<PyFloat>()
        .is_ok_and(|number| number.value() <= 0.0)
}
