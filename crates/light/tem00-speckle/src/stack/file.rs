//! Stacks as files: written once, read back with the same bits, or mapped into memory.

use std::{
    fs::{self, File},
    io::{self, BufWriter, Read, Write},
    path::{Path, PathBuf},
    process,
};

use num_complex::Complex;
use tem00_numerics::Grid;

use crate::{PupilField, SpeckleError, SpeckleStack, stack::check_limit};

mod checksum;
mod codes;
mod error;
mod fields;
mod fixed;
mod header;

use checksum::Checksum;
pub use error::StackFileError;
use fields::{from_bytes, to_bytes};
use fixed::Fixed;
use header::Header;

/// Bytes that are read or written at a time.
const CHUNK: usize = 1 << 16;

impl SpeckleStack {
    /// Writes the stack as a file, little-endian, in the layout of `docs/stack_file.md`.
    ///
    /// After a header come the coefficients of all slices, row by row, from a multiple of 64 bytes on: a
    /// renderer may map the file into its memory and look up there.
    ///
    /// # Errors
    ///
    /// Returns an error if the writer does.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
    ///
    /// let field = PupilField::new(64, 16, 7)?;
    /// let stack = SpeckleStack::generate(&field, SlicePath::Circle { half_period: 2 })?;
    ///
    /// let mut file = Vec::new();
    /// stack.write_to(&mut file)?;
    ///
    /// let same = SpeckleStack::read_from(file.as_slice(), 1 << 20)?;
    /// assert_eq!(same, stack);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write_to(&self, mut writer: impl Write) -> io::Result<()> {
        writer.write_all(&Header::bytes_of(self))?;
        let mut bytes = Vec::with_capacity(CHUNK);
        for slice in &self.slices {
            for values in slice.coefficients.values().chunks(CHUNK / 8) {
                bytes.clear();
                bytes.extend(values.iter().flat_map(to_bytes));
                writer.write_all(&bytes)?;
            }
        }
        writer.flush()
    }

    /// Writes the stack as [`write_to`](Self::write_to) does, as a file that appears whole or not at all: what has the
    /// name before keeps it until then. What is no regular file, such as a pipe, is written as it is.
    ///
    /// # Errors
    ///
    /// Returns the error of the file system.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            return self.write_to(BufWriter::new(File::create(path)?));
        }
        let (part, file) = new_part(path)?;
        let written = self
            .write_to(BufWriter::new(&file))
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&part, path));
        written.inspect_err(|_| {
            // The first error tells more than that of a file which cannot be removed.
            let _ = fs::remove_file(&part);
        })
    }

    /// Reads a stack that [`write_to`](Self::write_to) has written and that takes no more than
    /// `memory_limit` bytes.
    ///
    /// Memory is only asked for as the file fills it, whatever its header claims. Reading ends with
    /// the last coefficient; what follows is left to the caller.
    ///
    /// # Errors
    ///
    /// Returns an error if the reader does, if the file is something else, of a newer version,
    /// damaged or cut short, or if the memory is over the limit or refused.
    pub fn read_from(mut reader: impl Read, memory_limit: u64) -> Result<Self, StackFileError> {
        let fixed = Fixed::read(&mut reader)?;
        check_limit(fixed.memory_bytes(), memory_limit)?;
        let header = Header::read(fixed, &mut reader)?;
        let field = header.field()?;
        let path = header.path();
        let mut checksum = Checksum::default();
        let slices: Result<Vec<_>, _> = (0..path.slice_count())
            .map(|_| read_grid(&mut reader, &field, &mut checksum))
            .collect();
        let slices = slices?;
        if checksum.value() != header.data_checksum() {
            return Err(StackFileError::Damaged);
        }
        Ok(Self::assemble(field, path, header.interpolation(), slices))
    }
}

/// Creates a file beside `path` that no other writer of it has, in this process or another.
fn new_part(path: &Path) -> io::Result<(PathBuf, File)> {
    for number in 0_u64.. {
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{}-{number}.part", process::id()));
        let part = path.with_file_name(name);
        match File::create_new(&part) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            created => return created.map(|file| (part, file)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Reads one slice; its memory grows with what has been read.
fn read_grid(
    reader: &mut impl Read,
    field: &PupilField,
    checksum: &mut Checksum,
) -> Result<Grid<Complex<f32>>, StackFileError> {
    let [width, height] = field.size();
    let samples = width * height;
    let mut values: Vec<Complex<f32>> = Vec::new();
    let mut bytes = [0; CHUNK];
    while values.len() < samples {
        let count = (samples - values.len()).min(CHUNK / 8);
        let bytes = &mut bytes[..8 * count];
        reader.read_exact(bytes)?;
        if values.capacity() < values.len() + count {
            let wanted = (2 * values.len()).clamp(values.len() + count, samples);
            let more = values.try_reserve_exact(wanted - values.len());
            more.map_err(|_| SpeckleError::Memory {
                bytes: 8 * wanted as u64,
            })?;
        }
        let (words, _) = bytes.as_chunks();
        values.extend(words.iter().map(|word| {
            checksum.add(u64::from_le_bytes(*word));
            from_bytes(*word)
        }));
    }
    Grid::from_vec(width, height, values).map_err(|_| StackFileError::Damaged)
}

#[cfg(test)]
mod tests;
