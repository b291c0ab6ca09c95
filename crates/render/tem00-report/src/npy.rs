//! Grids as NumPy files.

use std::io::{self, Read, Write};

use num_complex::Complex;
use tem00_numerics::Grid;

mod element;
mod error;
mod header;

use element::{Element, ElementType};
pub use error::NpyError;
use header::Header;

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 16;

/// A NumPy file (NPY) whose header has been read and whose values follow.
///
/// Versions 1 to 3 of the format are understood, both orders of the values (C and Fortran) and both
/// byte orders. Real values are `float16`, `float32`, `float64`, `bool` or integers of 8 to 64
/// bits, complex ones `complex64` or `complex128`; all are kept in single precision. An array of
/// the shape (height, width) becomes a grid of height rows; further axes may have the length 1.
///
/// Memory is allocated only as the file fills it, regardless of the claims of its header.
///
/// # Examples
///
/// A field in the pupil that was measured or computed elsewhere takes the place of a random one:
///
/// ```
/// use tem00_numerics::Grid;
/// use tem00_report::npy::{NpyReader, write_npy};
/// use tem00_speckle::{Complex, PupilField};
///
/// // What `np.save` writes for an array of 40 × 40 complex numbers.
/// let lens = Grid::from_fn(40, 40, |x, y| {
///     let (x, y) = (x as f32 - 20.0, y as f32 - 20.0);
///     Complex::from_polar(1.0, 0.2 * (x * x + y * y))
/// });
/// let mut file = Vec::new();
/// write_npy(&lens, &mut file)?;
///
/// let array = NpyReader::new(file.as_slice())?;
/// assert_eq!(array.shape(), [40, 40]);
/// let samples = array.into_complex(1 << 20)?;
/// assert_eq!(samples, lens);
/// let field = PupilField::from_samples(samples, [160, 160], 4.0)?;
/// assert_eq!(field.diameter(), [40.0, 40.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
///
/// - NumPy Enhancement Proposal 1, *A simple file format for NumPy arrays*, 2007.
#[derive(Debug)]
pub struct NpyReader<R> {
    reader: R,
    header: Header,
}

impl<R: Read> NpyReader<R> {
    /// Reads the header of a file.
    ///
    /// # Errors
    ///
    /// Returns an error if the reader does, or if the file is not a NumPy file, of an unknown
    /// version or truncated.
    pub fn new(mut reader: R) -> Result<Self, NpyError> {
        let header = Header::read(&mut reader)?;
        Ok(Self { reader, header })
    }

    /// Returns the shape of the array, outermost first: (height, width) for a grid.
    pub fn shape(&self) -> &[u64] {
        &self.header.shape
    }

    /// Returns height and width if the array has two dimensions, apart from axes of the length 1.
    pub fn grid_shape(&self) -> Option<[u64; 2]> {
        let mut shape = self.header.shape.clone();
        while shape.len() > 2 {
            let one = shape.iter().rposition(|&side| side == 1)?;
            shape.remove(one);
        }
        shape.try_into().ok()
    }

    /// Returns the type of the values as the file names it, such as `<c8` for `complex64`.
    pub fn element_type(&self) -> String {
        self.header.element_type()
    }

    /// Returns whether the values are complex.
    pub fn is_complex(&self) -> bool {
        ElementType::from_name(&self.element_type()).is_some_and(|found| found.numbers == 2)
    }

    /// Reads a two-dimensional array of real values that takes no more than `memory_limit` bytes.
    ///
    /// # Errors
    ///
    /// Returns an error if the reader does, if the array does not have two dimensions or is empty,
    /// if the values are not real, if the file ends too early or if the memory exceeds the limit or
    /// cannot be allocated.
    pub fn into_real(self, memory_limit: u64) -> Result<Grid<f32>, NpyError> {
        self.into_grid(memory_limit)
    }

    /// Reads a two-dimensional array of complex numbers that takes no more than `memory_limit`
    /// bytes.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`into_real`](Self::into_real), here for values that are not complex,
    /// and an error if a value is not finite or beyond single precision.
    pub fn into_complex(self, memory_limit: u64) -> Result<Grid<Complex<f32>>, NpyError> {
        let grid = self.into_grid(memory_limit)?;
        check_finite(&grid)?;
        Ok(grid)
    }

    fn into_grid<T: Element>(mut self, memory_limit: u64) -> Result<Grid<T>, NpyError> {
        let Some([height, width]) = self.grid_shape() else {
            return Err(NpyError::Shape(self.header.shape));
        };
        let name = self.element_type();
        let element_type = ElementType::from_name(&name)
            .filter(|found| found.numbers == T::NUMBERS)
            .ok_or(NpyError::ElementType {
                found: name,
                allowed: T::READABLE,
            })?;
        let count = self.count_within::<T>(memory_limit)?;
        let (width, height) = (to_usize(width), to_usize(height));
        let values = self.values(count, element_type)?;
        if self.header.columns_first {
            let columns = grid(height, width, values)?;
            return Ok(Grid::from_fn(width, height, |x, y| columns[(y, x)]));
        }
        grid(width, height, values)
    }

    /// The number of values, if they take no more than `limit` bytes while they are read.
    fn count_within<T>(&self, limit: u64) -> Result<usize, NpyError> {
        let shape = &self.header.shape;
        if shape.contains(&0) {
            return Err(NpyError::Shape(shape.clone()));
        }
        let count = shape
            .iter()
            .try_fold(1, |n: u64, side| n.checked_mul(*side));
        // A transposed copy is made before the first copy is freed.
        let bytes_each = (1 + u64::from(self.header.columns_first)) * size_of::<T>() as u64;
        let needed = count.map_or(u64::MAX, |count| count.saturating_mul(bytes_each));
        if needed > limit {
            return Err(NpyError::MemoryLimit { needed, limit });
        }
        let count = count.and_then(|count| usize::try_from(count).ok());
        count.ok_or(NpyError::Memory(needed))
    }

    /// The `count` values in the order of the file.
    fn values<T: Element>(&mut self, count: usize, of: ElementType) -> Result<Vec<T>, NpyError> {
        let (mut values, mut buffer) = (Vec::new(), vec![0; CHUNK]);
        while values.len() < count {
            let more = (count - values.len()).min(buffer.len() / of.bytes());
            let bytes = &mut buffer[..more * of.bytes()];
            self.reader.read_exact(bytes)?;
            reserve(&mut values, more, count)?;
            let each = bytes.chunks_exact(of.bytes());
            values.extend(each.map(|bytes| of.decode::<T>(bytes)));
        }
        Ok(values)
    }
}

/// Writes complex numbers as a NumPy file (NPY) of `complex64`, of the shape (height, width).
///
/// The file is what `np.save` writes for the same array; [`NpyReader`] reads it back.
///
/// # Errors
///
/// Returns an error if the writer does.
pub fn write_npy(grid: &Grid<Complex<f32>>, writer: impl Write) -> io::Result<()> {
    write_grid(grid, writer)
}

/// Writes real numbers as a NumPy file (NPY) of `float32`, of the shape (height, width).
///
/// # Errors
///
/// Returns an error if the writer does.
pub fn write_real_npy(grid: &Grid<f32>, writer: impl Write) -> io::Result<()> {
    write_grid(grid, writer)
}

fn write_grid<T: Element>(grid: &Grid<T>, mut writer: impl Write) -> io::Result<()> {
    let shape = [grid.height(), grid.width()];
    writer.write_all(&Header::bytes_of(T::WRITTEN, &shape))?;
    let mut bytes = Vec::with_capacity(CHUNK);
    for values in grid.values().chunks(CHUNK / size_of::<T>()) {
        bytes.clear();
        values.iter().for_each(|value| value.encode(&mut bytes));
        writer.write_all(&bytes)?;
    }
    writer.flush()
}

/// Makes room for `more` values, doubling the memory, but never for more than `count`.
fn reserve<T>(values: &mut Vec<T>, more: usize, count: usize) -> Result<(), NpyError> {
    let needed = values.len() + more;
    if values.capacity() >= needed {
        return Ok(());
    }
    let wanted = (2 * values.len()).clamp(needed, count);
    let bytes = (wanted as u64).saturating_mul(size_of::<T>() as u64);
    let refused = |_| NpyError::Memory(bytes);
    values
        .try_reserve_exact(wanted - values.len())
        .map_err(refused)
}

fn grid<T>(width: usize, height: usize, values: Vec<T>) -> Result<Grid<T>, NpyError> {
    Grid::from_vec(width, height, values)
        .map_err(|_| NpyError::Shape(vec![height as u64, width as u64]))
}

fn check_finite(grid: &Grid<Complex<f32>>) -> Result<(), NpyError> {
    let finite = |z: &Complex<f32>| z.re.is_finite() && z.im.is_finite();
    match grid.values().iter().position(|z| !finite(z)) {
        None => Ok(()),
        Some(bad) => {
            let index = [bad / grid.width(), bad % grid.width()];
            Err(NpyError::NotFinite(index))
        }
    }
}

/// A number of values that fits the memory.
fn to_usize(n: u64) -> usize {
    usize::try_from(n).unwrap_or(usize::MAX)
}

#[cfg(test)]
pub(crate) mod tests;
