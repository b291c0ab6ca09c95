use core::{error, fmt};

use num_complex::Complex;
use rustfft::FftPlanner;

use crate::Grid;

mod axis;
mod chunks;

use axis::Axis;
use chunks::for_each_chunk;

/// A two-dimensional Fourier transform of a small aperture in a larger array of zeros.
///
/// ```text
/// X(kx, ky) = Σ x(m, n) exp(−2πi (m kx / width + n ky / height))
/// ```
///
/// Planned once, for one size, and reused for any number of arrays.
///
/// # Normalization
///
/// None: the transform of a single 1 has the magnitude 1 everywhere, and by Parseval the mean of
/// `|X|²` is the sum of `|x|²`.
///
/// # Output order
///
/// Zero frequency at `(0, 0)`, then increasing frequencies; negative ones in the second half. The
/// aperture's `(0, 0)` is the array's `(0, 0)`; an aperture elsewhere differs by a phase factor.
///
/// # Cost
///
/// Nothing that is zero by construction is transformed: with an aperture of `w × h` in an array of
/// `W × H` there are `w` transforms of length H and `H` of length W, each made of short ones no longer
/// than the aperture needs. Any size works; products of small primes are fastest, and powers of two
/// most of all. The array never exists as a whole: the memory is `8 w H` bytes, reused with
/// [`forward_into`](Self::forward_into), and the output.
///
/// # Threads
///
/// With the feature `parallel` the work is shared by the threads of the current rayon pool. The
/// result is the same bits for any number of them, and without the feature.
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
}

/// Columns transformed together in the first pass: 128 bytes, the width of a gather.
const COLUMNS: usize = 16;
/// Output rows finished together in the second pass.
const ROWS: usize = 8;
const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// Working memory of a transform, kept between calls of [`Fft2::forward_into`].
///
/// It fits any transform and grows to the largest.
#[derive(Clone, Debug, Default)]
pub struct Fft2Scratch {
    /// For each block of [`COLUMNS`] columns its spectrum: `[block][ky][column]`.
    blocks: Vec<Complex<f32>>,
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
        })
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
        let mut output = Grid::filled(self.row.length(), self.column.length(), O::default());
        self.forward_into(aperture, &mut output, &mut Fft2Scratch::default(), finish);
        output
    }

    /// Like [`forward`](Self::forward), into an array and with working memory that already exist.
    ///
    /// # Panics
    ///
    /// Panics unless `aperture` has the planned size and `output` the size of the array.
    pub fn forward_into<O: Send>(
        &self,
        aperture: &Grid<Complex<f32>>,
        output: &mut Grid<O>,
        scratch: &mut Fft2Scratch,
        finish: impl Fn(usize, usize, Complex<f32>) -> O + Sync,
    ) {
        assert!(
            aperture.width() == self.row.aperture() && aperture.height() == self.column.aperture(),
            "the aperture has not the planned size"
        );
        assert!(
            output.width() == self.row.length() && output.height() == self.column.length(),
            "the output has not the size of the array"
        );
        let block = COLUMNS * self.column.length();
        let blocks = self.row.aperture().div_ceil(COLUMNS);
        if scratch.blocks.len() < blocks * block {
            scratch.blocks.resize(blocks * block, ZERO);
        }
        let spectra = &mut scratch.blocks[..blocks * block];
        for_each_chunk(
            spectra,
            block,
            || Lines::new(&self.column, COLUMNS),
            |lines, index, block| self.transform_columns(aperture, index, lines, block),
        );
        for_each_chunk(
            output.values_mut(),
            ROWS * self.row.length(),
            || Lines::new(&self.row, ROWS),
            |lines, index, rows| self.finish_rows(spectra, index, lines, rows, &finish),
        );
    }

    /// First pass: the columns of one block, down the array.
    fn transform_columns(
        &self,
        aperture: &Grid<Complex<f32>>,
        index: usize,
        lines: &mut Lines,
        block: &mut [Complex<f32>],
    ) {
        let start = index * COLUMNS;
        let count = COLUMNS.min(aperture.width() - start);
        let height = self.column.aperture();
        for (y, row) in aperture.rows().enumerate() {
            for (column, value) in row[start..start + count].iter().enumerate() {
                lines.input[column * height + y] = *value;
            }
        }
        let parts = self.column.parts();
        let short = self.column.length() / parts;
        for (column, input) in lines.input.chunks_exact(height).take(count).enumerate() {
            self.column
                .transform(input, &mut lines.spectrum, &mut lines.scratch);
            for (s, part) in lines.spectrum.chunks_exact(short).enumerate() {
                let rows = block[s * COLUMNS..].chunks_mut(parts * COLUMNS);
                for (row, value) in rows.zip(part) {
                    row[column] = *value;
                }
            }
        }
    }

    /// Second pass: a few whole rows, and what the caller makes of them.
    fn finish_rows<O>(
        &self,
        spectra: &[Complex<f32>],
        index: usize,
        lines: &mut Lines,
        rows: &mut [O],
        finish: &impl Fn(usize, usize, Complex<f32>) -> O,
    ) {
        let (start, width) = (index * ROWS, self.row.aperture());
        let count = rows.len() / self.row.length();
        let blocks = spectra.chunks_exact(COLUMNS * self.column.length());
        for (block, column) in blocks.zip((0..width).step_by(COLUMNS)) {
            let used = COLUMNS.min(width - column);
            let gathered = &block[start * COLUMNS..(start + count) * COLUMNS];
            for (row, values) in gathered.chunks_exact(COLUMNS).enumerate() {
                let line = row * width + column;
                lines.input[line..line + used].copy_from_slice(&values[..used]);
            }
        }
        let inputs = lines.input.chunks_exact(width);
        let outputs = rows.chunks_exact_mut(self.row.length());
        for (y, (input, output)) in (start..).zip(inputs.zip(outputs)) {
            self.row
                .transform(input, &mut lines.spectrum, &mut lines.scratch);
            interleave(&lines.spectrum, self.row.parts(), output, |x, value| {
                finish(x, y, value)
            });
        }
    }
}

/// Writes `finish(x, X(x))` in order of x from a spectrum that lies in `parts` parts.
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

/// What one thread needs to transform lines of one axis.
struct Lines {
    /// Gathered lines of the aperture, one after the other.
    input: Vec<Complex<f32>>,
    spectrum: Vec<Complex<f32>>,
    scratch: Vec<Complex<f32>>,
}

impl Lines {
    fn new(axis: &Axis, count: usize) -> Self {
        Self {
            input: vec![ZERO; count * axis.aperture()],
            spectrum: vec![ZERO; axis.length()],
            scratch: vec![ZERO; axis.scratch_length()],
        }
    }
}

/// Why a Fourier transform could not be planned.
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

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    /// Values without structure: a multiplicative walk, in [−½, ½).
    fn aperture(width: usize, height: usize) -> Grid<Complex<f32>> {
        let walk = |i: usize| {
            let i = u32::try_from(i).unwrap();
            #[expect(clippy::cast_precision_loss, reason = "a 24-bit number")]
            let value = (i.wrapping_mul(2_654_435_769) >> 8) as f32 / 16_777_216.0;
            value - 0.5
        };
        Grid::from_fn(width, height, |x, y| {
            Complex::new(walk(2 * (y * width + x) + 1), walk(2 * (y * width + x) + 2))
        })
    }

    /// The definition, in `f64`.
    fn naive(width: usize, height: usize, aperture: &Grid<Complex<f32>>) -> Grid<Complex<f64>> {
        #[expect(clippy::cast_precision_loss, reason = "small integers")]
        let wave = |n: usize, length: usize| {
            Complex::from_polar(1.0, -2.0 * PI * (n % length) as f64 / length as f64)
        };
        Grid::from_fn(width, height, |kx, ky| {
            let mut sum = Complex::new(0.0, 0.0);
            for (n, row) in aperture.rows().enumerate() {
                for (m, x) in row.iter().enumerate() {
                    let x = Complex::new(f64::from(x.re), f64::from(x.im));
                    sum += x * wave(m * kx, width) * wave(n * ky, height);
                }
            }
            sum
        })
    }

    fn norm(values: impl Iterator<Item = f64>) -> f64 {
        values.sum::<f64>().sqrt()
    }

    #[test]
    fn transform_is_the_definition_for_any_size() {
        for (width, height, aperture_width, aperture_height) in [
            (1, 1, 1, 1),
            (2, 2, 1, 1),
            (2, 2, 2, 1),
            (8, 8, 4, 4),
            (8, 8, 5, 5),
            (16, 16, 9, 9),
            (32, 32, 17, 17),
            (64, 48, 33, 19),
            (48, 64, 17, 64),
            (12, 30, 4, 7),
            (7, 13, 3, 5),
            (31, 17, 31, 17),
            (36, 36, 10, 9),
            (100, 1, 20, 1),
            (1, 100, 1, 49),
            (45, 40, 16, 37),
        ] {
            let input = aperture(aperture_width, aperture_height);
            let expected = naive(width, height, &input);
            let transform =
                Fft2::with_aperture(width, height, aperture_width, aperture_height).unwrap();
            let got = transform.forward(&input, |_, _, value| value);
            let error =
                norm(got.values().iter().zip(expected.values()).map(|(g, e)| {
                    (f64::from(g.re) - e.re).powi(2) + (f64::from(g.im) - e.im).powi(2)
                }));
            let size = norm(expected.values().iter().map(Complex::norm_sqr));
            // Higham 2002, theorem 24.2: log₂ n · 7 u in norm for powers of two, with u = 2⁻²⁴;
            // other lengths take three transforms of up to four times the length.
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let levels = ((width * height) as f64).log2() + 4.0;
            let tolerance = 3.0 * levels * 7.0 * 2.0_f64.powi(-24);
            assert!(
                error <= tolerance * size,
                "{aperture_width} × {aperture_height} in {width} × {height}: {:e}",
                error / size
            );
        }
    }

    #[test]
    fn the_mean_square_of_the_transform_is_the_sum_of_the_squares() {
        for (size, aperture_size) in [(256, 129), (250, 100), (127, 50)] {
            let input = aperture(aperture_size, aperture_size);
            let transform = Fft2::with_aperture(size, size, aperture_size, aperture_size).unwrap();
            let squares = transform.forward(&input, |_, _, value| f64::from(value.norm_sqr()));
            let sum: f64 = input.values().iter().map(|x| f64::from(x.norm_sqr())).sum();
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let mean = squares.values().iter().sum::<f64>() / (size * size) as f64;
            // Rounding errors of 2⁻²⁴ times a few per level are random over 10⁴ values.
            assert!((mean / sum - 1.0).abs() < 1e-6, "{size}: {mean} for {sum}");
        }
    }

    #[test]
    fn finish_sees_every_frequency_once() {
        for (width, height, aperture) in [(24, 20, 12), (30, 21, 10), (11, 9, 8)] {
            let transform = Fft2::with_aperture(width, height, aperture, aperture).unwrap();
            let input = Grid::filled(aperture, aperture, ZERO);
            let places = transform.forward(&input, |x, y, _| (x, y));
            assert_eq!(places, Grid::from_fn(width, height, |x, y| (x, y)));
        }
    }

    #[test]
    fn scratch_carries_nothing_from_one_transform_to_the_next() {
        let mut scratch = Fft2Scratch::default();
        for (size, aperture_size) in [(40, 20), (64, 33), (12, 5), (40, 20)] {
            let input = aperture(aperture_size, aperture_size);
            let transform = Fft2::with_aperture(size, size, aperture_size, aperture_size).unwrap();
            let mut reused = Grid::filled(size, size, ZERO);
            transform.forward_into(&input, &mut reused, &mut scratch, |_, _, value| value);
            let fresh = transform.forward(&input, |_, _, value| value);
            assert_eq!(reused, fresh, "{aperture_size} in {size}");
        }
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn the_result_is_the_same_bits_for_any_number_of_threads() {
        let input = aperture(61, 45);
        let transform = Fft2::with_aperture(120, 90, 61, 45).unwrap();
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap()
                .install(|| transform.forward(&input, |_, _, value| value))
        };
        assert_eq!(with_threads(1), with_threads(3));
    }

    /// The serial loop and the threads cut the work into the same pieces, and each piece is computed
    /// alone: what is compared here is one piece with all the others and without.
    #[test]
    fn a_column_is_the_same_bits_alone() {
        let input = aperture(40, 24);
        let wide = Fft2::with_aperture(80, 48, 40, 24).unwrap();
        let mut other = input.clone();
        for y in 0..24 {
            for x in 0..16 {
                other[(x, y)] = ZERO;
            }
        }
        let mut first = Fft2Scratch::default();
        let mut second = Fft2Scratch::default();
        let mut output = Grid::filled(80, 48, ZERO);
        wide.forward_into(&input, &mut output, &mut first, |_, _, value| value);
        wide.forward_into(&other, &mut output, &mut second, |_, _, value| value);
        assert_eq!(first.blocks[48 * 16..], second.blocks[48 * 16..]);
    }

    #[test]
    fn sizes_without_a_transform_are_refused() {
        assert!(matches!(Fft2::new(0, 4), Err(Fft2Error::Empty)), "width 0");
        assert!(
            matches!(Fft2::with_aperture(4, 4, 1, 0), Err(Fft2Error::Empty)),
            "aperture height 0"
        );
        assert!(
            matches!(
                Fft2::with_aperture(8, 8, 9, 4),
                Err(Fft2Error::Aperture { .. })
            ),
            "an aperture wider than the array"
        );
    }

    #[test]
    #[should_panic(expected = "the aperture has not the planned size")]
    fn an_aperture_of_another_size_panics() {
        let transform = Fft2::with_aperture(8, 8, 4, 4).unwrap();
        let _ = transform.forward(&aperture(4, 5), |_, _, value| value);
    }
}
