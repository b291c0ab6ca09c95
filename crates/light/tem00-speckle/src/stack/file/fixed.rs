//! The entries at the same place in every header.

use std::io::Read;

use super::{
    StackFileError,
    codes::{
        PupilKind, SourceKind, check_reserved, interpolation_of, out_of_range, path_of, period,
        pupil_of, source_of,
    },
    fields::Reader,
};
use crate::{
    Interpolation, PupilField, SlicePath,
    pupil::{Layout, too_large},
};

/// The version that this library writes, and the newest that it reads.
pub(super) const VERSION: u32 = 1;

pub(super) const MAGIC: &[u8; 8] = b"tem00stk";
/// The bytes of what every header holds.
pub(super) const FIXED: usize = 192;
/// The bytes of what it holds for each slice.
pub(super) const SLICE: usize = 96;
/// The coefficients begin at a multiple of this.
pub(super) const BLOCK: usize = 64;
/// The part of the header that no checksum covers: the magic, the version and the checksums.
pub(super) const PROLOGUE: usize = 32;

/// The entries at the same place in every header, as they are written.
#[derive(Clone, Debug)]
pub(super) struct Fixed {
    pub(super) bytes: [u8; FIXED],
    pub(super) checksum: u64,
    pub(super) data_checksum: u64,
    pub(super) data_offset: u64,
    pub(super) slices: u32,
    pub(super) interpolation: Interpolation,
    pub(super) layout: Layout,
    pub(super) period: [i64; 2],
    pub(super) path: SlicePath,
    pub(super) source: SourceKind,
    pub(super) samples: [u32; 2],
    pub(super) pupil: PupilKind,
    pub(super) transmission: [u32; 2],
    pub(super) origin: [i64; 2],
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
            let newest = VERSION;
            return Err(StackFileError::Newer { version, newest });
        }
        if version == 0 {
            return Err(out_of_range("version", version, "at least 1"));
        }
        check_reserved(entries.u32()?)?;
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
        let origin = [entries.i64()?, entries.i64()?];
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
            origin,
        })
    }

    fn check_lengths(&self) -> Result<(), StackFileError> {
        if let Some(side) = self.layout.size.iter().find(|&&s| s > PupilField::MAX_SIZE) {
            return Err(too_large(*side).into());
        }
        let slices = u64::from(self.slices);
        if slices != self.path.slice_count() as u64 {
            return Err(out_of_range("slices", slices, "those of the path"));
        }
        if self.data_offset != self.header_bytes() {
            let allowed = "the length of the header";
            return Err(out_of_range("data offset", self.data_offset, allowed));
        }
        Ok(())
    }

    fn header_bytes(&self) -> u64 {
        let samples = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
        let slices = u64::from(self.slices) * SLICE as u64;
        [samples(self.transmission), samples(self.samples)]
            .map(|samples| samples.saturating_mul(8))
            .iter()
            .fold(FIXED as u64 + slices, |sum, part| sum.saturating_add(*part))
            .checked_next_multiple_of(BLOCK as u64)
            .unwrap_or(u64::MAX)
    }

    /// The bytes of the whole file.
    pub(super) fn memory_bytes(&self) -> u64 {
        let slices = self.path.memory_bytes(self.layout.size);
        slices.saturating_add(self.data_offset)
    }
}
