//! What stands before the coefficients.

use std::{io::Read, sync::Arc};

use num_complex::Complex;
use tem00_numerics::Grid;

use super::{
    Checksum, StackFileError,
    fields::{Reader, Writer},
    word,
};
use crate::{
    Interpolation, Phasors, Pupil, PupilField, SlicePath, SpeckleError, SpeckleStack, Transmission,
    field::Layout,
    lattice::{Lattice, Seeded, Source},
};

/// The version that this library writes, and the newest that it reads.
pub(super) const VERSION: u32 = 1;

const MAGIC: &[u8; 8] = b"tem00stk";
/// The bytes of what every header holds.
const FIXED: usize = 192;
/// The bytes of what it holds for each slice.
const SLICE: usize = 96;
/// The coefficients begin at a multiple of this.
const BLOCK: usize = 64;
/// The part of the header that no checksum covers: the magic, the version and the checksums.
const PROLOGUE: usize = 32;

/// The entries at the same place in every header, as they are written.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    bytes: [u8; FIXED],
    checksum: u64,
    data_checksum: u64,
    data_offset: u64,
    slices: u32,
    interpolation: Interpolation,
    layout: Layout,
    period: [i64; 2],
    path: SlicePath,
    source: SourceKind,
    samples: [u32; 2],
    pupil: PupilKind,
    transmission: [u32; 2],
}

#[derive(Clone, Copy, Debug)]
enum SourceKind {
    Seeded(Seeded),
    Measured,
}

#[derive(Clone, Debug)]
enum PupilKind {
    Shape(Pupil),
    Sampled,
}

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
            source,
            period: fixed.period,
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

impl Fixed {
    pub(super) fn read(reader: &mut impl Read) -> Result<Self, StackFileError> {
        let mut bytes = [0; FIXED];
        reader.read_exact(&mut bytes[..MAGIC.len()])?;
        if !bytes.starts_with(MAGIC) {
            return Err(StackFileError::Foreign);
        }
        reader.read_exact(&mut bytes[MAGIC.len()..])?;
        let mut entries = Reader::new(&bytes[MAGIC.len()..]);
        let version = entries.u32()?;
        if version > VERSION {
            return Err(StackFileError::Newer { version });
        }
        zero("version", u32::from(version == 0))?;
        zero("reserved entry", entries.u32()?)?;
        let fixed = Self::parse(bytes, &mut entries)?;
        fixed.check_lengths()?;
        Ok(fixed)
    }

    fn parse(bytes: [u8; FIXED], entries: &mut Reader<'_>) -> Result<Self, StackFileError> {
        let (checksum, data_checksum) = (entries.u64()?, entries.u64()?);
        let data_offset = entries.u64()?;
        let size = [entries.u32()?, entries.u32()?];
        let slices = entries.u32()?;
        let interpolation = interpolation_of(entries.u32()?)?;
        let layout = Layout {
            size: size.map(|side| side as usize),
            speckle_size: entries.f64()?,
            diameter: [entries.f64()?, entries.f64()?],
        };
        let period = [period(entries.i64()?)?, period(entries.i64()?)?];
        let path = path_of(entries.u32()?, entries.u32()?, entries.u32()?)?;
        let source = source_of(entries.u32()?, entries.u64()?)?;
        let samples = [entries.u32()?, entries.u32()?];
        let pupil = pupil_of(entries.u32()?, entries.u32()?, entries.f64()?)?;
        let transmission = [entries.u32()?, entries.u32()?];
        Ok(Self {
            bytes,
            checksum,
            data_checksum,
            data_offset,
            slices,
            interpolation,
            layout,
            period,
            path,
            source,
            samples,
            pupil,
            transmission,
        })
    }

    fn check_lengths(&self) -> Result<(), StackFileError> {
        if let Some(side) = self.layout.size.iter().find(|&&s| s > PupilField::MAX_SIZE) {
            return Err(SpeckleError::Size(*side).into());
        }
        let slices = u64::from(self.slices);
        if slices != self.path.slice_count() as u64 {
            return Err(StackFileError::Entry {
                name: "number of slices",
                value: slices,
            });
        }
        if self.data_offset != self.header_bytes() {
            return Err(StackFileError::Entry {
                name: "data offset",
                value: self.data_offset,
            });
        }
        Ok(())
    }

    fn header_bytes(&self) -> u64 {
        let bytes = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height) * 8;
        let slices = u64::from(self.slices) * SLICE as u64;
        [slices, bytes(self.transmission), bytes(self.samples)]
            .iter()
            .fold(FIXED as u64, |sum, part| sum.saturating_add(*part))
            .checked_next_multiple_of(BLOCK as u64)
            .unwrap_or(u64::MAX)
    }

    /// The bytes of the whole file.
    pub(super) fn memory_bytes(&self) -> u64 {
        let slices = self.path.memory_bytes(self.layout.size);
        slices.saturating_add(self.data_offset)
    }
}

fn write_layout(body: &mut Writer, stack: &SpeckleStack) {
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

fn write_source(body: &mut Writer, field: &PupilField) {
    let kind = match field.phasors() {
        Some(Phasors::Unit) => 0,
        Some(Phasors::Gaussian) => 1,
        None => 2,
    };
    body.u32(kind).u64(field.seed().unwrap_or(0));
    let size = field.samples().map_or([0; 2], |s| [s.width(), s.height()]);
    body.u32(to_u32(size[0])).u32(to_u32(size[1]));
}

fn write_pupil(body: &mut Writer, pupil: &Pupil) {
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

/// What a look-up needs beside the coefficients of the slices.
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

fn zero(name: &'static str, value: u32) -> Result<(), StackFileError> {
    match value {
        0 => Ok(()),
        value => Err(unknown(name, value)),
    }
}

fn unknown(name: &'static str, value: u32) -> StackFileError {
    StackFileError::Entry {
        name,
        value: value.into(),
    }
}

fn interpolation_of(degree: u32) -> Result<Interpolation, StackFileError> {
    match degree {
        0 => Ok(Interpolation::Nearest),
        1 => Ok(Interpolation::Bilinear),
        3 => Ok(Interpolation::CubicSpline),
        _ => Err(unknown("interpolation", degree)),
    }
}

fn period(points: i64) -> Result<i64, StackFileError> {
    if (1..=Lattice::SIDE).contains(&points) {
        return Ok(points);
    }
    Err(StackFileError::Entry {
        name: "period of the lattice",
        value: points.cast_unsigned(),
    })
}

fn path_of(kind: u32, half_period: u32, length: u32) -> Result<SlicePath, StackFileError> {
    let (half_period, length) = (half_period as usize, length as usize);
    match kind {
        0 => Ok(SlicePath::Still),
        1 => Ok(SlicePath::Circle { half_period }),
        2 => Ok(SlicePath::Straight {
            half_period,
            length,
        }),
        _ => Err(unknown("path", kind)),
    }
}

fn source_of(kind: u32, seed: u64) -> Result<SourceKind, StackFileError> {
    let phasors = match kind {
        0 => Phasors::Unit,
        1 => Phasors::Gaussian,
        2 => return Ok(SourceKind::Measured),
        _ => return Err(unknown("source of the field", kind)),
    };
    Ok(SourceKind::Seeded(Seeded { seed, phasors }))
}

fn pupil_of(kind: u32, reserved: u32, parameter: f64) -> Result<PupilKind, StackFileError> {
    zero("reserved entry", reserved)?;
    Ok(PupilKind::Shape(match kind {
        0 => Pupil::Circle,
        1 => Pupil::Annulus { inner: parameter },
        2 => Pupil::Rectangle { height: parameter },
        3 => Pupil::Gaussian { radius: parameter },
        4 => return Ok(PupilKind::Sampled),
        _ => return Err(unknown("pupil", kind)),
    }))
}

/// Sizes and counts of a stack are below 2³².
fn to_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

const fn area([width, height]: [u32; 2]) -> usize {
    (width as usize).saturating_mul(height as usize)
}

fn grid(
    [width, height]: [u32; 2],
    values: &[Complex<f32>],
) -> Result<Grid<Complex<f32>>, StackFileError> {
    Grid::from_vec(width as usize, height as usize, values.to_vec())
        .map_err(|_| unknown("size of a grid", width.min(height)))
}
