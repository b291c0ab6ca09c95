use core::{error, fmt, ops::Range};
use std::sync::Mutex;

use num_complex::Complex;
use rustfft::FftPlanner;

use crate::{
    Grid,
    parallel::{self, lock},
    vectorised,
};

mod axis;
mod blocks;

use axis::Axis;
use blocks::{COLUMNS, PANEL, aligned, fill_columns, gather_rows, spread_columns, stride};

/// Two-dimensional Fourier transform of a small aperture in a larger array of zeros.
///
/// ```text
/// X(kx, ky) = Σ x(m, n) exp(−2πi (m kx / width + n ky / height))
/// ```
///
/// A transform is planned once, for one size, and reused for any number of arrays.
///
/// # Normalization
///
/// The transform is not normalised: the transform of a single 1 has the magnitude 1 everywhere, and
/// by Parseval the mean of `|X|²` is the sum of `|x|²`.
///
/// # Output order
///
/// The zero frequency is at `(0, 0)`, followed by increasing frequencies; negative frequencies are
/// in the second half. The aperture's `(0, 0)` is the array's `(0, 0)`; an aperture elsewhere
/// differs by a phase factor.
///
/// # Cost
///
/// Values that are zero by construction are not transformed: with an aperture of `w × h` in an
/// array of `W × H` there are `w` transforms of length H and `H` of length W, each made of short
/// transforms no longer than the aperture needs. Any size works; products of small primes are fast,
/// and powers of two are fastest. The array never exists as a whole: the memory is `8 w H` bytes
/// and a few dozen lines for each thread, plus the output. The aperture need not exist as a whole
/// either: [`forward_from`](Self::forward_from) takes it piece by piece, and reuses the memory.
///
/// # Threads
///
/// With the feature `parallel` the work is shared by the threads of the current rayon pool. The
/// result has the same bits for any number of threads, and without the feature. To run many
/// transforms in parallel, let each thread do its own: [`on_one_thread`](Self::on_one_thread).
///
/// # Examples
///
/// The far field of a slit, whose first zero lies at the frequency `width / 8`:
///
/// ```
/// use num_complex::Complex;
/// use tem00_numerics::{Fft2, Grid};
///
/// let slit = Grid::filled(8, 1, Complex::new(1.0, 0.0));
/// let transform = Fft2::with_aperture(64, 1, 8, 1)?;
/// let intensity = transform.forward(&slit, |_, _, value| value.norm_sqr());
///
/// assert!((intensity[(0, 0)] - 64.0).abs() < 1e-4);
/// assert!(intensity[(64 / 8, 0)] < 1e-4);
/// # Ok::<(), tem00_numerics::Fft2Error>(())
/// ```
#[derive(Clone)]
pub struct Fft2 {
    row: Axis,
    column: Axis,
    threads: bool,
}

/// Output rows finished together in the second pass, which reads this many consecutive cache lines.
const ROWS: usize = 16;

/// Working memory of a transform, kept between calls of [`Fft2::forward_from`].
///
/// It fits any transform and grows to the size of the largest.
#[derive(Clone, Debug, Default)]
pub struct Fft2Scratch {
    /// Spectra of the blocks of [`COLUMNS`] columns: `[block][ky][column]`.
    blocks: Vec<Complex<f32>>,
    /// Scratch memory for each thread that has transformed lines.
    workers: Vec<Worker>,
}

impl fmt::Debug for Fft2 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fft2")
            .field("width", &self.row.length())
            .field("height", &self.column.length())
            .field("aperture_width", &self.row.aperture())
            .field("aperture_height", &self.column.aperture())
            .finish_non_exhaustive()
    }
}

impl Fft2 {
    /// Plans the transform of a full `width` × `height` array.
    ///
    /// # Errors
    ///
    /// Returns an error if a size is zero.
    pub fn new(width: usize, height: usize) -> Result<Self, Fft2Error> {
        Self::with_aperture(width, height, width, height)
    }

    /// Plans the transform of an aperture at the corner of a `width` × `height` array of zeros.
    ///
    /// # Errors
    ///
    /// Returns an error if a size is zero or the aperture is larger than the array.
    pub fn with_aperture(
        width: usize,
        height: usize,
        aperture_width: usize,
        aperture_height: usize,
    ) -> Result<Self, Fft2Error> {
        if width == 0 || height == 0 || aperture_width == 0 || aperture_height == 0 {
            return Err(Fft2Error::Empty);
        }
        if aperture_width > width || aperture_height > height {
            return Err(Fft2Error::Aperture {
                aperture: (aperture_width, aperture_height),
                array: (width, height),
            });
        }
        let mut planner = FftPlanner::new();
        Ok(Self {
            row: Axis::new(width, aperture_width, &mut planner),
            column: Axis::new(height, aperture_height, &mut planner),
            threads: true,
        })
    }

    /// Returns the same transform, executed by the calling thread alone.
    ///
    /// With many transforms at once, each thread does its own: it needs one working memory, which
    /// stays in its cache.
    #[must_use]
    pub const fn on_one_thread(mut self) -> Self {
        self.threads = false;
        self
    }

    /// Transforms `aperture` and returns `finish(kx, ky, X(kx, ky))` for every frequency.
    ///
    /// # Panics
    ///
    /// Panics unless `aperture` has the planned size.
    pub fn forward<O>(
        &self,
        aperture: &Grid<Complex<f32>>,
        finish: impl Fn(usize, usize, Complex<f32>) -> O + Sync,
    ) -> Grid<O>
    where
        O: Clone + Default + Send,
    {
        assert!(
            aperture.width() == self.row.aperture() && aperture.height() == self.column.aperture(),
            "aperture and plan differ in size"
        );
        let copy = |columns: Range<usize>, y, values: &mut [_]| {
            values.copy_from_slice(&aperture.row(y)[columns]);
        };
        let mut output = Grid::filled(self.row.length(), self.column.length(), O::default());
        self.forward_from(copy, &mut output, &mut Fft2Scratch::default(), finish);
        output
    }

    /// Transforms like [`forward`](Self::forward), but into an existing array and with existing
    /// working memory, an aperture that is generated piece by piece and never exists as a whole.
    ///
    /// `fill(columns, y, values)` writes the values of these columns in row y. It covers each
    /// position of the aperture once, in any order and by any thread, in pieces of up to 64 values
    /// that begin at a multiple of 8.
    ///
    /// # Examples
    ///
    /// ```
    /// use num_complex::Complex;
    /// use tem00_numerics::{Fft2, Fft2Scratch, Grid};
    ///
    /// // Two slits of one column each, 4 apart, interfere with the period 64 / 4.
    /// let transform = Fft2::with_aperture(64, 8, 5, 8)?;
    /// let slits = |columns: core::ops::Range<usize>, _, values: &mut [_]| {
    ///     for (x, value) in columns.zip(values) {
    ///         *value = Complex::new(if x % 4 == 0 { 1.0 } else { 0.0 }, 0.0);
    ///     }
    /// };
    /// let mut intensity = Grid::filled(64, 8, 0.0);
    /// let mut scratch = Fft2Scratch::default();
    /// transform.forward_from(slits, &mut intensity, &mut scratch, |_, _, value| value.norm_sqr());
    ///
    /// assert!((intensity[(16, 0)] - 256.0).abs() < 1e-3);
    /// assert!(intensity[(8, 0)] < 1e-3);
    /// # Ok::<(), tem00_numerics::Fft2Error>(())
    /// ```
    ///
    /// # Panics
    ///
    /// Panics unless `output` has the size of the array.
    pub fn forward_from<O: Send>(
        &self,
        fill: impl Fn(Range<usize>, usize, &mut [Complex<f32>]) + Sync,
        output: &mut Grid<O>,
        scratch: &mut Fft2Scratch,
        finish: impl Fn(usize, usize, Complex<f32>) -> O + Sync,
    ) {
        assert!(
            output.width() == self.row.length() && output.height() == self.column.length(),
            "output and array differ in size"
        );
        let block = COLUMNS * self.column.length();
        let blocks = self.row.aperture().div_ceil(COLUMNS);
        let spectra = aligned(&mut scratch.blocks, blocks * block);
        let panel = self.panel_width();
        self.for_each_chunk(
            spectra,
            panel / COLUMNS * block,
            &mut scratch.workers,
            |worker, index, blocks| {
                let columns = index * panel..self.row.aperture().min((index + 1) * panel);
                vectorised(
                    #[inline(always)]
                    || self.transform_columns(columns, &fill, worker, blocks),
                );
            },
        );
        self.for_each_chunk(
            output.values_mut(),
            ROWS * self.row.length(),
            &mut scratch.workers,
            |worker, index, rows| {
                vectorised(
                    #[inline(always)]
                    || self.finish_rows(spectra, index, worker, rows, &finish),
                );
            },
        );
    }

    /// Calls `each(worker, index, chunk)` for every chunk, with a worker that no other call has.
    fn for_each_chunk<T: Send>(
        &self,
        values: &mut [T],
        length: usize,
        workers: &mut Vec<Worker>,
        each: impl Fn(&mut Worker, usize, &mut [T]) + Sync,
    ) {
        let workers = Mutex::new(workers);
        let each = |index, chunk: &mut [T]| {
            let mut worker = lock(&workers).pop().unwrap_or_default();
            each(&mut worker, index, chunk);
            lock(&workers).push(worker);
        };
        if self.threads {
            parallel::for_each_chunk(values, length, each);
        } else {
            let chunks = values.chunks_mut(length).enumerate();
            chunks.for_each(|(index, chunk)| each(index, chunk));
        }
    }

    /// Columns that one thread transforms together: few enough that all threads get some.
    fn panel_width(&self) -> usize {
        let threads = if self.threads {
            parallel::thread_count()
        } else {
            1
        };
        let share = self.row.aperture() / (2 * threads);
        share.clamp(1, PANEL).next_multiple_of(COLUMNS)
    }

    /// First pass: neighbouring columns, down the array.
    #[inline(always)]
    fn transform_columns(
        &self,
        columns: Range<usize>,
        fill: &impl Fn(Range<usize>, usize, &mut [Complex<f32>]),
        worker: &mut Worker,
        blocks: &mut [Complex<f32>],
    ) {
        let (height, length) = (self.column.aperture(), self.column.length());
        let lines = worker.lines(&self.column, columns.len(), COLUMNS);
        fill_columns(columns, height, fill, lines.inputs);
        let mut inputs = lines.inputs.chunks_exact_mut(stride(height));
        for block in blocks.chunks_exact_mut(COLUMNS * length) {
            let spectra = lines.spectra.chunks_exact_mut(stride(length));
            for (spectrum, input) in spectra.zip(inputs.by_ref()) {
                self.column
                    .transform(&mut input[..height], &mut spectrum[..length], lines.scratch);
            }
            let (block, _) = block.as_chunks_mut();
            spread_columns(lines.spectra, self.column.parts(), block);
        }
    }

    /// Second pass: a few whole rows and the caller's `finish`.
    #[inline(always)]
    fn finish_rows<O>(
        &self,
        spectra: &[Complex<f32>],
        index: usize,
        worker: &mut Worker,
        rows: &mut [O],
        finish: &impl Fn(usize, usize, Complex<f32>) -> O,
    ) {
        let (start, width) = (index * ROWS, self.row.aperture());
        let count = rows.len() / self.row.length();
        let height = self.column.length();
        let lines = worker.lines(&self.row, ROWS, 1);
        gather_rows(spectra, height, start..start + count, lines.inputs, width);
        let inputs = lines.inputs.chunks_exact_mut(stride(width));
        let outputs = rows.chunks_exact_mut(self.row.length());
        let spectrum = &mut lines.spectra[..self.row.length()];
        for (y, (input, output)) in (start..).zip(inputs.zip(outputs)) {
            self.row
                .transform(&mut input[..width], spectrum, lines.scratch);
            interleave(spectrum, self.row.parts(), output, |x, value| {
                finish(x, y, value)
            });
        }
    }
}

/// Writes `finish(x, X(x))` in order of x from a spectrum that is stored in `parts` parts.
#[inline(always)]
fn interleave<O>(
    spectrum: &[Complex<f32>],
    parts: usize,
    output: &mut [O],
    finish: impl Fn(usize, Complex<f32>) -> O,
) {
    let short = spectrum.len() / parts;
    // The common case in a form without bounds checks.
    if parts == 2 {
        let (even, odd) = spectrum.split_at(short);
        let (pairs, _) = output.as_chunks_mut::<2>();
        for (j, (pair, (even, odd))) in pairs.iter_mut().zip(even.iter().zip(odd)).enumerate() {
            *pair = [finish(2 * j, *even), finish(2 * j + 1, *odd)];
        }
        return;
    }
    for (j, group) in output.chunks_exact_mut(parts).enumerate() {
        for (s, value) in group.iter_mut().enumerate() {
            *value = finish(parts * j + s, spectrum[s * short + j]);
        }
    }
}

/// Scratch memory of one thread for the transform of lines.
#[derive(Clone, Debug, Default)]
struct Worker {
    inputs: Vec<Complex<f32>>,
    spectra: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
}

/// Working memory for lines of one axis.
struct Lines<'a> {
    /// Lines of the aperture, one [`stride`] apart.
    inputs: &'a mut [Complex<f32>],
    /// Spectra of the lines, one [`stride`] apart as well.
    spectra: &'a mut [Complex<f32>],
    scratch: &'a mut [Complex<f32>],
}

impl Worker {
    fn lines(&mut self, axis: &Axis, inputs: usize, spectra: usize) -> Lines<'_> {
        Lines {
            inputs: aligned(&mut self.inputs, inputs * stride(axis.aperture())),
            spectra: aligned(&mut self.spectra, spectra * stride(axis.length())),
            scratch: aligned(&mut self.scratch, axis.scratch_length()),
        }
    }
}

/// Reasons for which a Fourier transform cannot be planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fft2Error {
    /// A size is zero.
    Empty,
    /// The aperture is larger than the array.
    Aperture {
        /// Width and height of the aperture.
        aperture: (usize, usize),
        /// Width and height of the array.
        array: (usize, usize),
    },
}

impl fmt::Display for Fft2Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "a Fourier transform needs at least one sample per axis"),
            Self::Aperture { aperture, array } => write!(
                f,
                "an aperture of {} × {} does not fit an array of {} × {}",
                aperture.0, aperture.1, array.0, array.1
            ),
        }
    }
}

impl error::Error for Fft2Error {}

/// Returns whether transforms of a side are fast: whether it has no prime factor above 5.
///
/// There is such a number between any number and its double; 0 is none.
pub fn is_fast_side(mut side: usize) -> bool {
    for prime in [2, 3, 5] {
        while side > 0 && side.is_multiple_of(prime) {
            side /= prime;
        }
    }
    side == 1
}

#[cfg(test)]
mod tests;
