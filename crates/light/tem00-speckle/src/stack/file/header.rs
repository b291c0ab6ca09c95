//! The header before the coefficients.

use std::{io::Read, sync::Arc};

use num_complex::Complex;
use tem00_numerics::Grid;

use super::{
    Checksum, StackFileError,
    codes::{PupilKind, SourceKind, out_of_range, write_layout, write_pupil, write_source},
    fields::{Reader, Writer, word},
    fixed::{BLOCK, FIXED, Fixed, MAGIC, PROLOGUE, SLICE, VERSION},
};
use crate::{
    Interpolation, Pupil, PupilField, SlicePath, SpeckleStack, Transmission,
    pupil::lattice::{Lattice, Source},
};

/// A header whose checksum is right.
#[derive(Clone, Debug)]
pub(super) struct Header {
    fixed: Fixed,
    transmission: Vec<Complex<f32>>,
    samples: Vec<Complex<f32>>,
}

impl Header {
    /// The bytes of a stack's file before its coefficients.
    pub(super) fn bytes_of(stack: &SpeckleStack) -> Vec<u8> {
        let mut body = Writer::default();
        write_layout(&mut body, stack);
        write_source(&mut body, &stack.field);
        write_pupil(&mut body, stack.field.pupil());
        let [x, y] = stack.field.origin();
        body.i64(x).i64(y);
        body.bytes.resize(FIXED - PROLOGUE - 8, 0);
        write_slices(&mut body, stack);
        if let Pupil::Sampled(transmission) = stack.field.pupil() {
            body.complex(transmission.values().values());
        }
        if let Some(samples) = stack.field.samples() {
            body.complex(samples.values());
        }
        let offset = (PROLOGUE + 8 + body.bytes.len()).next_multiple_of(BLOCK);
        let mut covered = Writer::default();
        covered.u64(offset as u64);
        covered.bytes.extend(body.bytes);
        covered.bytes.resize(offset - PROLOGUE, 0);
        let mut file = Writer::default();
        file.bytes.extend(MAGIC);
        file.u32(VERSION).u32(0);
        file.u64(checksum_of(&covered.bytes));
        file.u64(data_checksum(stack));
        file.bytes.extend(covered.bytes);
        file.bytes
    }

    /// Reads what follows the fixed entries.
    pub(super) fn read(fixed: Fixed, reader: &mut impl Read) -> Result<Self, StackFileError> {
        let length = fixed.data_offset - FIXED as u64;
        let mut rest = Vec::new();
        reader.take(length).read_to_end(&mut rest)?;
        if (rest.len() as u64) < length {
            return Err(StackFileError::Truncated);
        }
        let mut checksum = Checksum::default();
        checksum.add_bytes(&fixed.bytes[PROLOGUE..]);
        checksum.add_bytes(&rest);
        if checksum.value() != fixed.checksum {
            return Err(StackFileError::Damaged);
        }
        let mut entries = Reader::new(&rest);
        entries.skip(SLICE * fixed.slices as usize)?;
        Ok(Self {
            transmission: entries.complex(area(fixed.transmission))?,
            samples: entries.complex(area(fixed.samples))?,
            fixed,
        })
    }

    /// The field of the stack.
    pub(super) fn field(&self) -> Result<PupilField, StackFileError> {
        let fixed = &self.fixed;
        let source = match fixed.source {
            SourceKind::Seeded(seeded) => Source::Seeded(seeded),
            SourceKind::Measured => Source::Measured(Arc::new(grid(fixed.samples, &self.samples)?)),
        };
        let pupil = match &fixed.pupil {
            PupilKind::Shape(pupil) => pupil.clone(),
            PupilKind::Sampled => {
                let values = grid(fixed.transmission, &self.transmission)?;
                Pupil::Sampled(Transmission::from_complex(values)?)
            }
        };
        fixed.path.check()?;
        let lattice = Lattice {
            period: fixed.period,
            ..Lattice::endless(source).displaced(fixed.origin)
        };
        let field = PupilField::restore(lattice, fixed.layout, pupil)?;
        Ok(fixed.path.close(&field))
    }

    pub(super) const fn path(&self) -> SlicePath {
        self.fixed.path
    }

    pub(super) const fn interpolation(&self) -> Interpolation {
        self.fixed.interpolation
    }

    pub(super) const fn data_checksum(&self) -> u64 {
        self.fixed.data_checksum
    }
}

/// Writes the entries of the slices for a look-up.
fn write_slices(body: &mut Writer, stack: &SpeckleStack) {
    for (index, slice) in stack.slices.iter().enumerate() {
        let [x, y] = slice.join.step;
        body.f64(x).f64(y).f64(slice.join.overlap).u64(0);
        let variance = stack.variances.get(index).unwrap_or(&stack.variances[0]);
        for value in variance.table.as_flattened() {
            body.f32(*value);
        }
    }
}

fn checksum_of(bytes: &[u8]) -> u64 {
    let mut checksum = Checksum::default();
    checksum.add_bytes(bytes);
    checksum.value()
}

fn data_checksum(stack: &SpeckleStack) -> u64 {
    let mut checksum = Checksum::default();
    for slice in &stack.slices {
        for value in slice.coefficients.values() {
            checksum.add(word(value));
        }
    }
    checksum.value()
}

const fn area([width, height]: [u32; 2]) -> usize {
    (width as usize).saturating_mul(height as usize)
}

fn grid(
    [width, height]: [u32; 2],
    values: &[Complex<f32>],
) -> Result<Grid<Complex<f32>>, StackFileError> {
    Grid::from_vec(width as usize, height as usize, values.to_vec())
        .map_err(|_| out_of_range("side of a grid", width.min(height), "at least 1"))
}
