//! Placements, a light as the beam crate holds it, and the records of what it is asked.

use pyo3::{
    prelude::*,
    types::{PyFloat, PyTuple},
};
use tem00_beam::{
    self as physics, AngularProfile, DVec3, Emitter, LineLight, LineProfile, NextEventSlices,
    SpotLight, TabulatedLineLight,
};
use tem00_shading::{BeamShape, Laser, PlacedLight};

use crate::arrays::{Array, Column, Floats, Values, evaluate, named_class};

class! {
    /// Position and directions of a light, in world coordinates.
    ///
    /// The values are checked where a light is placed.
    ///
    /// Parameters
    /// ----------
    /// origin : array_like, shape (3,)
    ///     Centre of the aperture (the lens of a laser line), in metres.
    /// direction : array_like, shape (3,)
    ///     Direction of travel, of any length.
    /// fan_axis : array_like, shape (3,)
    ///     Any vector that is not parallel to ``direction``. Its part at right angles to
    ///     ``direction`` is the x axis of the light, along which a fan opens.
    "tem00.beam" Placement(physics::Placement): Copy
}

methods! {
    impl Placement as this: this.0;

    make new(origin: DVec3, direction: DVec3, fan_axis: DVec3) =
        PyResult::Ok(physics::Placement { origin, direction, fan_axis });

    /// Centre of the aperture, in metres, shape (3,).
    field origin -> Floats;

    /// Direction of travel, of any length, shape (3,).
    field direction -> Floats;

    /// A vector in the plane of the fan, shape (3,).
    field fan_axis -> Floats;

    made_by new(origin, direction, fan_axis);
}

/// A light as the beam crate holds it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Placed {
    Spot(SpotLight),
    Line(LineLight),
    Tabulated(LineLight, AngularProfile),
}

impl Placed {
    /// The light of a laser.
    pub(crate) fn of(laser: &Laser) -> Self {
        match (laser.placed(), &laser.description().shape) {
            (PlacedLight::Spot(light), _) => Self::Spot(light),
            (
                PlacedLight::Line(line),
                BeamShape::Line {
                    profile: LineProfile::Tabulated(table),
                    ..
                },
            ) => Self::Tabulated(line, table.clone()),
            (PlacedLight::Line(line), _) => Self::Line(line),
        }
    }

    /// The members of the next events at points, all 0 where there is no light.
    ///
    /// The point follows from the batch form, which leaves it out: `p + distance · wi`.
    pub(crate) fn events<'py>(
        &self,
        py: Python<'py>,
        points: [Column<'_>; 3],
    ) -> PyResult<[Values<'py>; 4]> {
        evaluate(py, points, [&[3], &[], &[3], &[]], |points, out| {
            let [x, y, z] = points;
            let [point, distance, wi, e_perp] = out;
            let mut towards = [x, y, z].map(|x| vec![0.0; x.len()]);
            let slices = NextEventSlices {
                wi: towards.each_mut().map(Vec::as_mut_slice),
                distance,
                e_perp,
            };
            self.ask(|light| light.next_event_batch(x, y, z, slices));
            for i in 0..x.len() {
                for (k, (p, towards)) in points.iter().zip(&towards).enumerate() {
                    wi[3 * i + k] = towards[i];
                    if e_perp[i] > 0.0 {
                        point[3 * i + k] = p[i] + distance[i] * towards[i];
                    }
                }
            }
        })
    }

    /// The fields in the order of memory.
    pub(super) fn rows(&self) -> Vec<[f64; 4]> {
        match self {
            Self::Spot(light) => light.to_rows().to_vec(),
            Self::Line(light) | Self::Tabulated(light, _) => light.to_rows().to_vec(),
        }
    }

    pub(super) fn frame_vector(&self, row: usize) -> [f64; 3] {
        let [x, y, z, _] = self.rows()[row];
        [x, y, z]
    }

    /// Asks the light, whichever it is.
    pub(super) fn ask<R>(&self, query: impl FnOnce(&dyn Emitter) -> R) -> R {
        match self {
            Self::Spot(light) => query(light),
            Self::Line(light) => query(light),
            Self::Tabulated(line, profile) => query(&TabulatedLineLight {
                line: *line,
                knots: profile.knots(),
            }),
        }
    }
}

/// Applies `f` to columns, and spreads its values, one after the other, over arrays of the shapes
/// `inner`, all 0 where there are none.
pub(super) fn spread<'py, const N: usize, const M: usize, const S: usize>(
    py: Python<'py>,
    columns: [Column<'_>; N],
    inner: [&[usize]; M],
    f: impl Fn([f64; N]) -> Option<[f64; S]> + Send + Sync,
) -> PyResult<[Values<'py>; M]> {
    let sizes = inner.map(|inner| inner.iter().product::<usize>());
    evaluate(py, columns, inner, |columns, mut out| {
        for i in 0..columns[0].len() {
            let values = f(columns.map(|column| column[i])).unwrap_or([0.0; S]);
            let mut rest = values.as_slice();
            for (out, size) in out.iter_mut().zip(sizes) {
                let (own, after) = rest.split_at(size);
                out[i * size..][..size].copy_from_slice(own);
                rest = after;
            }
        }
    })
}

pub(super) fn densities(pdf: &physics::RayPdf) -> [f64; 4] {
    let given = [pdf.direction_given_position, pdf.position_given_direction];
    [pdf.position, given[0], pdf.direction, given[1]]
}

/// The named tuple of members.
pub(crate) fn named<'py, const M: usize>(
    py: Python<'py>,
    name: &str,
    members: [Values<'py>; M],
) -> PyResult<Array<'py>> {
    named_class(py, name)?.call1(PyTuple::new(py, members)?)
}

/// The named tuple of members, unless the one at `place` is the number 0, of a point in the dark.
pub(super) fn lit<'py, const M: usize>(
    py: Python<'py>,
    name: &str,
    members: [Values<'py>; M],
    place: usize,
) -> PyResult<Option<Array<'py>>> {
    let number = members[place].cast::<PyFloat>();
    if number.is_ok_and(|number| number.value() <= 0.0) {
        return Ok(None);
    }
    named(py, name, members).map(Some)
}
