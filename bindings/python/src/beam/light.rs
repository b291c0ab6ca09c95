//! Lights in a scene, prepared for a renderer.

use numpy::PyArray2;
use pyo3::{exceptions::PyTypeError, prelude::*};
use tem00_beam::{
    self as physics, AstigmaticBeam, GaussianBeam, LaserLine, LineLight, LineProfile, SpotLight,
    TabulatedLineLight,
};
use tem00_numerics::cast::to_f32;

use super::{
    map::{LIMIT, check_uniforms, coordinate},
    placed::{Placed, densities, lit, named, spread},
};
use crate::arrays::{Array, Floats, Numbers, Values, Vectors, evaluate, named_class};

class! {
    /// A beam or a laser line in a scene, which a renderer can evaluate and sample.
    ///
    /// All points and vectors are in world coordinates, in metres, within ±1e30. The light shines
    /// from the aperture plane into the half-space that its axis points to; points behind that
    /// plane receive nothing.
    ///
    /// There are two ways to light a surface, which belong to different path spaces and must not be
    /// added up: ``next_event`` takes the mean direction of the energy flow, a delta light;
    /// ``next_event_sampled``, ``sample_ray``, ``ray_pdf`` and ``radiance`` share the phase-space
    /// density of the light and may be combined by multiple importance sampling.
    ///
    /// Light beyond the cut-off, 4 beam radii, is dropped by ``irradiance``, ``flux`` and both
    /// next-event forms. Rays are not cut off.
    "tem00.beam" Light(Placed)
}

methods! {
    impl Light as this: this.0;

    unmade "spot, elliptic or line";

    /// Return the fields of the light in the order of memory, as rows of four: what a kernel reads.
    ///
    /// Those of a beam are ``origin, power | ex, cutoff | ey, wavelength | ez, 0 | x: w0_sq,
    /// theta_sq, z0, 0 | y: likewise``, with ``w² = w0_sq + theta_sq (z − z0)²``. Those of a line
    /// are ``origin, power | ex, cutoff | ey, apex_offset | ez, source_radius | y: w0_sq, theta_sq,
    /// z0, 0 | flat, sigma, variable, mass | half_slope, focus_on_plane, wavelength, 0``: its
    /// thickness depends on the slant distance from the virtual apex, and the power along the fan
    /// is uniform on ±``flat`` in a variable, convolved with a normal density of the standard
    /// deviation ``sigma`` and divided by ``mass``. ``variable`` is 0 for ``tan θ``, 1 for ``θ``, 2
    /// for ``sin θ`` and 3 for a table.
    ///
    /// Returns
    /// -------
    /// float32 ndarray, shape (6, 4) or (7, 4)
    ///     6 rows for a beam, 7 for a line.
    call to_rows(py; ) -> Bound<'py, PyArray2<f32>> = {
        let rows = this.0.rows().into_iter();
        let rows: Vec<_> = rows.map(|row| Vec::from(row.map(to_f32))).collect();
        Ok(PyArray2::from_vec2(py, &rows)?)
    };

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
    call irradiance(py; x: Numbers<'py>, y: Numbers<'py>, z: Numbers<'py>) -> Values<'py> = {
        let points = columns!(LIMIT; x, y, z);
        let [irradiance] = evaluate(py, points, [&[]], |[x, y, z], [out]| {
            this.0.ask(|light| light.irradiance_batch(x, y, z, out));
        })?;
        Ok(irradiance)
    };

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
    call next_event(py; x: Numbers<'py>, y: Numbers<'py>, z: Numbers<'py>) -> Option<Array<'py>> = {
        lit(
            py,
            "NextEvent",
            this.0.events(py, columns!(LIMIT; x, y, z))?,
            3,
        )
    };

    /// Return the light at points as one direction each, drawn from the phase-space density there.
    ///
    /// The estimate of the reflected radiance is ``f·|n·wi|·V·value``: ``value`` has been divided
    /// by the density already. The mean over ``u`` is that of ``next_event``.
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
    ///     For numbers None outside the cut-off and behind the aperture. For arrays all members are
    ///     0 there.
    call next_event_sampled(py;
        x: Numbers<'py>, y: Numbers<'py>, z: Numbers<'py>, u: Vectors<'py>
    ) -> Option<Array<'py>> = {
        check_uniforms(&u)?;
        let inner: [&[usize]; 5] = [&[3], &[], &[3], &[], &[]];
        let events = spread(
            py,
            columns!(LIMIT; x, y, z, u: 2),
            inner,
            |[x, y, z, u @ ..]| {
                let event = this.0.ask(|light| light.next_event_sampled([x, y, z], u))?;
                let ([a, b, c], [d, e, f]) = (event.point, event.wi);
                Some([a, b, c, event.distance, d, e, f, event.value, event.pdf])
            },
        )?;
        lit(py, "SampledEvent", events, 3)
    };

    /// Return the light that rays from points meet, for directions that a material has drawn.
    ///
    /// It is the other technique beside ``next_event_sampled``: a direction of the density ``q``
    /// has the weight ``q / (q + pdf)`` of the balance heuristic. Only what is nearer than
    /// ``distance`` hides the light.
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
    call hit(py;
        x: Numbers<'py>, y: Numbers<'py>, z: Numbers<'py>, wi: Vectors<'py>
    ) -> Option<Array<'py>> = {
        let inner: [&[usize]; 4] = [&[3], &[], &[], &[]];
        let rays = columns!(LIMIT; x, y, z, wi: 3);
        let hits = spread(py, rays, inner, |[x, y, z, wi @ ..]| {
            let hit = this.0.ask(|light| light.hit([x, y, z], wi))?;
            let [a, b, c] = hit.point;
            Some([a, b, c, hit.distance, hit.radiance, hit.pdf])
        })?;
        lit(py, "ApertureHit", hits, 2)
    };

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
    call sample_ray(py; u: Vectors<'py>) -> Array<'py> = {
        let inner: [&[usize]; 8] = [&[3], &[], &[3], &[], &[], &[], &[], &[]];
        check_uniforms(&u)?;
        let u = columns!(LIMIT; u: 4);
        let [origin, flux, direction, cos, pdf @ ..] = spread(py, u, inner, |u| {
            let ray = this.0.ask(|light| light.sample_ray(u));
            let ([a, b, c], [d, e, f], [g, h, i, j]) =
                (ray.origin, ray.direction, densities(&ray.pdf));
            Some([a, b, c, ray.flux, d, e, f, ray.cos, g, h, i, j])
        })?;
        let pdf = named(py, "RayPdf", pdf)?;
        named(py, "RaySample", [origin, flux, direction, cos, pdf])
    };

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
    call ray_pdf(py;
        x: Numbers<'py>, y: Numbers<'py>, z: Numbers<'py>, d: Vectors<'py>
    ) -> Array<'py> = {
        let rays = columns!(LIMIT; x, y, z, d: 3);
        let pdf = spread(py, rays, [&[]; 4], |[x, y, z, d @ ..]| {
            Some(densities(&this.0.ask(|light| light.ray_pdf([x, y, z], d))))
        })?;
        named(py, "RayPdf", pdf)
    };

    /// Return bounds of the light from the aperture to a distance along its axis.
    ///
    /// The box holds all points within the cut-off. The cone holds the mean energy flow at all of
    /// them; a sampled ray is outside it with a probability of about exp(-2 cutoff²).
    ///
    /// Parameters
    /// ----------
    /// l : float
    ///     Distance along the axis, in metres, within ±1e30.
    ///
    /// Returns
    /// -------
    /// Bounds
    call bounds(py; l: f64) -> Array<'py> = {
        let l = coordinate("l", l)?;
        let bounds = this.0.ask(|light| light.bounds(l));
        let [min, max, axis] = [bounds.min, bounds.max, bounds.axis].map(Floats::from);
        named_class(py, "Bounds")?.call1((min, max, axis, bounds.half_angle))
    };

    /// Place a beam in a scene.
    ///
    /// Parameters
    /// ----------
    /// beam : GaussianBeam
    /// waist_distance : float
    ///     Signed distance from the aperture to the waist along the axis, in metres.
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    make spot(beam: GaussianBeam, waist_distance: f64, placement: physics::Placement, power: f64) =
        SpotLight::place(&beam, waist_distance, &placement, power).map(Placed::Spot);

    /// Place an elliptic beam in a scene, with its reference plane as the aperture.
    ///
    /// The local x axis is the first principal axis of the beam: the fan axis of the placement,
    /// turned by the rotation of the beam about the direction of travel.
    ///
    /// Parameters
    /// ----------
    /// beam : AstigmaticBeam
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    make elliptic(beam: AstigmaticBeam, placement: physics::Placement, power: f64) =
        SpotLight::place_astigmatic(&beam, &placement, power).map(Placed::Spot);

    /// Place a laser line in a scene, with the lens at the placement's origin.
    ///
    /// Parameters
    /// ----------
    /// line : LaserLine
    /// placement : Placement
    /// power : float
    ///     Power in watts, from 0 to 1e100.
    make line(line: LaserLine, placement: physics::Placement, power: f64) = match line.profile() {
        LineProfile::Tabulated(profile) => TabulatedLineLight::place(&line, &placement, power)
            .map(|light| Placed::Tabulated(light.line, profile.clone())),
        _ => LineLight::place(&line, &placement, power).map(Placed::Line),
    };

    /// Centre of the aperture (the lens of a laser line), in metres, shape (3,).
    get origin -> Floats = this.0.frame_vector(0);

    /// Unit vector of the local x axis, along which a fan opens, shape (3,).
    get ex -> Floats = this.0.frame_vector(1);

    /// Unit vector of the local y axis, the normal of the plane of a fan, shape (3,).
    get ey -> Floats = this.0.frame_vector(2);

    /// Unit vector along the direction of travel, shape (3,).
    get ez -> Floats = this.0.frame_vector(3);

    /// Power, in watts.
    get power -> f64 = this.0.ask(|light| light.power());

    /// Wavelength in the medium, in metres.
    get wavelength -> f64 = this.0.ask(|light| light.wavelength());

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
    over flux(x, y, z) -> [3] = |[x, y, z]| this.0.ask(|light| light.flux([x, y, z]));

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
    over next_event_pdf(x, y, z, wi: 3) -> [] =
        |[x, y, z, wi @ ..]| [this.0.ask(|light| light.next_event_pdf([x, y, z], wi))];

    /// Return the radiance, in W/(m² sr), of the rays through points.
    ///
    /// It is constant along a ray in free space, and 0 for a ray against the axis. Its integral
    /// over direction, weighted with the cosine to the axis, is the irradiance.
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
    over radiance(x, y, z, d: 3) -> [] =
        |[x, y, z, d @ ..]| [this.0.ask(|light| light.radiance([x, y, z], d))];

    /// Return bounds of the power, in watts, that reaches axis-aligned boxes.
    ///
    /// A hierarchy of lights visits none whose bound is 0: behind the aperture, beyond the cut-off,
    /// or for an empty box. The bound of a box within the beam is a small multiple of its power.
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
    over power_bound(min: 3, max: 3) -> [] =
        |[x, y, z, max @ ..]| [this.0.ask(|light| light.power_bound([x, y, z], max))];
}

#[pymethods]
impl Light {
    fn __repr__(&self) -> String {
        let [origin, axis] = [0, 3].map(|row| self.0.frame_vector(row));
        let kind = match self.0 {
            Placed::Spot(_) => "spot",
            _ => "line",
        };
        let power = self.power();
        format!(
            "<Light: {kind}, origin={:?}, axis={:?}, power={power:?}>",
            origin, axis
        )
    }

    fn __reduce__(&self) -> PyResult<()> {
        let message = "a placed light cannot be pickled: pickle its beam or line and its placement";
        Err(PyTypeError::new_err(message))
    }
}
