use pyo3::prelude::*;
use tem00_decorrelation::{self as physics, DMat3, DVec3};

use crate::{
    arrays::Floats,
    error::{OrRaise, refused},
};

class! {
    /// The light that reaches a surface point: where it comes from and how its wavefront is curved.
    ///
    /// Curvatures 1/R are in 1/m, positive where the wave diverges. Directions are of any length.
    "tem00.decorrelation" Wavefront(physics::Wavefront): Copy
}

methods! {
    impl Wavefront as this: this.0;

    unmade "plane, spherical, astigmatic, from_tensor or from_differentials";

    /// Return a plane wave from the direction to its source.
    make plane(direction_to_source: DVec3);

    /// Return a spherical wave.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source.
    /// curvature : float
    ///     Curvature in 1/m.
    make spherical(direction_to_source: DVec3, curvature: f64);

    /// Return an astigmatic wave, such as the fan of a laser line.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source.
    /// axis : array_like, shape (3,)
    ///     Principal axis; only its part across the direction counts.
    /// curvature_along, curvature_across : float
    ///     Curvatures along and across that axis, in 1/m.
    make astigmatic(
        direction_to_source: DVec3, axis: DVec3, curvature_along: f64, curvature_across: f64
    ) = {
        check_finite("curvature_along", curvature_along)?;
        check_finite("curvature_across", curvature_across)?;
        physics::Wavefront::astigmatic(direction_to_source, axis, curvature_along, curvature_across)
            .or_raise()
    };

    /// Return the wave of a curvature tensor, as it comes from the second derivatives of a phase.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source.
    /// curvature : array_like, shape (3, 3)
    ///     Symmetric curvature tensor in 1/m; only its part across the direction counts.
    make from_tensor(direction_to_source: DVec3, curvature: DMat3);

    /// Return the wave whose direction turns along a surface as a renderer's ray differentials say.
    ///
    /// Parameters
    /// ----------
    /// direction_to_source : array_like, shape (3,)
    ///     Direction to the source.
    /// dp : array_like, shape (2, 3)
    ///     Differentials of the surface point by two parameters, in metres.
    /// dl : array_like, shape (2, 3)
    ///     Differentials of the unit vector to the source by the same parameters.
    make from_differentials(direction_to_source: DVec3, dp: [DVec3; 2], dl: [DVec3; 2]);

    /// Unit vector from the surface to the source, of shape (3,).
    get direction_to_source -> Floats;

    /// Symmetric curvature tensor in 1/m, of shape (3, 3).
    get curvature -> Floats;

    made_by from_tensor(direction_to_source, curvature);
}

fn check_finite(name: &'static str, value: f64) -> PyResult<()> {
    if value.is_finite() {
        return Ok(());
    }
    let message = format!("{name} must be finite, got {value} 1/m");
    Err(refused(name, message))
}

class! {
    /// A light source in the world: from where it lights each point.
    "tem00.decorrelation" Illumination(physics::Illumination): Copy
}

methods! {
    impl Illumination as this: this.0;

    unmade "collimated, point_source or near";

    /// Return collimated light from the direction to its source, of shape (3,) and any length.
    make collimated(direction_to_source: DVec3);

    /// Return the light of a point source at a position of shape (3,), in metres.
    make point_source(position: DVec3);

    /// Return light from its wavefront at a position of shape (3,), in metres.
    make near(position: DVec3, wavefront: physics::Wavefront);

    /// Return the unit vector of shape (3,) from a point, in metres, to the source.
    ///
    /// ``None`` in a focus or at the source itself.
    fn direction_from(point: DVec3) -> Option<Floats> =
        this.0.direction_from(point).map(Floats::from);
}

#[pymethods]
impl Illumination {
    fn __repr__(&self) -> String {
        match self.0.direction_from(DVec3::ZERO) {
            Some(seen) => format!("<Illumination: from {:?} as seen from 0>", seen.to_array()),
            None => "<Illumination: from the origin>".to_owned(),
        }
    }
}
