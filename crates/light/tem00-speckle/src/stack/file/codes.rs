//! The numbers of a header and what they stand for, there and back.

use super::{StackFileError, fields::Writer};
use crate::{
    Interpolation, Phasors, Pupil, PupilField, SlicePath, SpeckleStack,
    pupil::lattice::{Lattice, Seeded},
};

#[derive(Clone, Copy, Debug)]
pub(super) enum SourceKind {
    Seeded(Seeded),
    Measured,
}

#[derive(Clone, Debug)]
pub(super) enum PupilKind {
    Shape(Pupil),
    Sampled,
}

pub(super) fn write_layout(body: &mut Writer, stack: &SpeckleStack) {
    let layout = stack.field.layout();
    let [period_x, period_y] = stack.field.lattice.period;
    let (path, half_period, length) = match stack.path() {
        SlicePath::Still => (0, 0, 0),
        SlicePath::Circle { half_period } => (1, half_period, 0),
        SlicePath::Straight {
            half_period,
            length,
        } => (2, half_period, length),
    };
    body.u32(to_u32(layout.size[0])).u32(to_u32(layout.size[1]));
    body.u32(to_u32(stack.slice_count()));
    body.u32(match stack.interpolation {
        Interpolation::Nearest => 0,
        Interpolation::Bilinear => 1,
        Interpolation::CubicSpline => 3,
    });
    body.f64(layout.speckle_size);
    body.f64(layout.diameter[0]).f64(layout.diameter[1]);
    body.i64(period_x).i64(period_y);
    body.u32(path).u32(to_u32(half_period)).u32(to_u32(length));
}

pub(super) fn write_source(body: &mut Writer, field: &PupilField) {
    let kind = match field.phasors() {
        Some(Phasors::Unit) => 0,
        Some(Phasors::Gaussian) => 1,
        None => 2,
    };
    body.u32(kind).u64(field.seed().unwrap_or(0));
    let size = field.samples().map_or([0; 2], |s| [s.width(), s.height()]);
    body.u32(to_u32(size[0])).u32(to_u32(size[1]));
}

pub(super) fn write_pupil(body: &mut Writer, pupil: &Pupil) {
    let (kind, parameter, size) = match pupil {
        Pupil::Circle => (0, 0.0, [0; 2]),
        Pupil::Annulus { inner } => (1, *inner, [0; 2]),
        Pupil::Rectangle { height } => (2, *height, [0; 2]),
        Pupil::Gaussian { radius } => (3, *radius, [0; 2]),
        Pupil::Sampled(t) => (4, 0.0, [t.values().width(), t.values().height()]),
    };
    body.u32(kind).u32(0).f64(parameter);
    body.u32(to_u32(size[0])).u32(to_u32(size[1]));
}

pub(super) fn check_reserved(value: u32) -> Result<(), StackFileError> {
    match value {
        0 => Ok(()),
        value => Err(out_of_range("reserved entry", value, "0")),
    }
}

pub(super) fn out_of_range(
    parameter: &'static str,
    value: impl Into<u64>,
    allowed: &'static str,
) -> StackFileError {
    StackFileError::OutOfRange {
        parameter,
        value: value.into(),
        allowed,
    }
}

pub(super) fn interpolation_of(degree: u32) -> Result<Interpolation, StackFileError> {
    match degree {
        0 => Ok(Interpolation::Nearest),
        1 => Ok(Interpolation::Bilinear),
        3 => Ok(Interpolation::CubicSpline),
        _ => Err(out_of_range("interpolation", degree, "0, 1 or 3")),
    }
}

pub(super) fn period(points: i64) -> Result<i64, StackFileError> {
    if (1..=Lattice::SIDE).contains(&points) {
        return Ok(points);
    }
    let allowed = "1 to 2³² lattice points";
    Err(out_of_range("period", points.cast_unsigned(), allowed))
}

pub(super) fn path_of(
    kind: u32,
    half_period: u32,
    length: u32,
) -> Result<SlicePath, StackFileError> {
    let (half_period, length) = (half_period as usize, length as usize);
    match kind {
        0 => Ok(SlicePath::Still),
        1 => Ok(SlicePath::Circle { half_period }),
        2 => Ok(SlicePath::Straight {
            half_period,
            length,
        }),
        _ => Err(out_of_range("path", kind, "0, 1 or 2")),
    }
}

pub(super) fn source_of(kind: u32, seed: u64) -> Result<SourceKind, StackFileError> {
    let phasors = match kind {
        0 => Phasors::Unit,
        1 => Phasors::Gaussian,
        2 => return Ok(SourceKind::Measured),
        _ => return Err(out_of_range("source", kind, "0, 1 or 2")),
    };
    Ok(SourceKind::Seeded(Seeded { seed, phasors }))
}

pub(super) fn pupil_of(
    kind: u32,
    reserved: u32,
    parameter: f64,
) -> Result<PupilKind, StackFileError> {
    check_reserved(reserved)?;
    Ok(PupilKind::Shape(match kind {
        0 => Pupil::Circle,
        1 => Pupil::Annulus { inner: parameter },
        2 => Pupil::Rectangle { height: parameter },
        3 => Pupil::Gaussian { radius: parameter },
        4 => return Ok(PupilKind::Sampled),
        _ => return Err(out_of_range("pupil", kind, "0 to 4")),
    }))
}

/// Sizes and counts of a stack are below 2³².
fn to_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
