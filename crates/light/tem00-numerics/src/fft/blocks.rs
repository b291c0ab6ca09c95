//! Moves of values between rows and columns, in blocks as wide as a cache line.
//!
//! Between the two passes the spectra of [`COLUMNS`] neighbouring columns lie together,
//! `[block][ky][column]`, so that both passes read and write whole cache lines.

use core::{array, ops::Range};

use num_complex::Complex;

/// Columns in a block: 64 bytes, a cache line.
pub(super) const COLUMNS: usize = 8;

/// The largest number of columns that are filled together.
pub(super) const PANEL: usize = 64;

/// The number of rows of each part of a spectrum that are spread together.
const TILE: usize = 32;

/// Distance from one line of `length` values to the next, in whole cache lines.
///
/// Lines at a multiple of 4 KiB would share one set of the first-level cache.
pub(super) const fn stride(length: usize) -> usize {
    length.next_multiple_of(COLUMNS) + COLUMNS
}

/// Returns `length` values that begin at a cache line. Their contents are arbitrary.
pub(super) fn aligned(values: &mut Vec<Complex<f32>>, length: usize) -> &mut [Complex<f32>] {
    let needed = length + COLUMNS;
    if values.len() < needed {
        *values = zeros(needed);
    }
    // Without this alignment everything works as well, only slower.
    let skipped = values.as_ptr().align_offset(64).min(COLUMNS);
    &mut values[skipped..skipped + length]
}

/// Zeros; many are written by all threads, since the system clears memory where it is first
/// written.
fn zeros(length: usize) -> Vec<Complex<f32>> {
    #[cfg(feature = "parallel")]
    if length > 1 << 20 {
        use rayon::prelude::*;
        return rayon::iter::repeat_n(Complex::default(), length).collect();
    }
    vec![Complex::default(); length]
}

/// Writes columns of an aperture into lines one [`stride`] apart; `fill(columns, y, values)`
/// generates their values in row y.
#[inline(always)]
pub(super) fn fill_columns(
    columns: Range<usize>,
    height: usize,
    fill: &impl Fn(Range<usize>, usize, &mut [Complex<f32>]),
    lines: &mut [Complex<f32>],
) {
    // A few rows at a time stay in the first-level cache, and leave it as whole cache lines.
    let mut rows = [[Complex::new(0.0, 0.0); PANEL]; COLUMNS];
    for y in (0..height).step_by(rows.len()) {
        for (y, row) in (y..height).zip(&mut rows) {
            fill(columns.clone(), y, &mut row[..columns.len()]);
        }
        for (x, line) in lines.chunks_exact_mut(stride(height)).enumerate() {
            let line = &mut line[y..height];
            // A copy of known length compiles without a loop.
            if let Some(whole) = line.first_chunk_mut() {
                *whole = rows.each_ref().map(|row| row[x]);
            } else {
                let values = rows.iter().map(|row| row[x]);
                line.iter_mut().zip(values).for_each(|(to, x)| *to = x);
            }
        }
    }
}

/// Writes the spectra of a block's columns, one [`stride`] apart and each in `parts` parts, into
/// the rows of the block.
#[inline(always)]
pub(super) fn spread_columns(
    spectra: &[Complex<f32>],
    parts: usize,
    block: &mut [[Complex<f32>; COLUMNS]],
) {
    let (length, short) = (block.len(), block.len() / parts);
    // A few rows at a time stay in the first-level cache until all parts are written.
    for (start, rows) in (0..).step_by(TILE).zip(block.chunks_mut(TILE * parts)) {
        for s in 0..parts {
            let piece = |column: usize| &spectra[column * stride(length) + s * short + start..];
            let pieces = array::from_fn(|column| &piece(column)[..rows.len() / parts]);
            spread_part(pieces, rows, s, parts);
        }
    }
}

/// Writes one part of the columns' spectra into every `parts`-th row, from `first` on.
#[inline(always)]
fn spread_part(
    spectra: [&[Complex<f32>]; COLUMNS],
    block: &mut [[Complex<f32>; COLUMNS]],
    first: usize,
    parts: usize,
) {
    let short = spectra[0].len();
    let spectra = spectra.map(|spectrum| spectrum[..short].as_chunks::<2>());
    let mut rows = block.chunks_exact_mut(2 * parts);
    for (j, rows) in rows.by_ref().enumerate() {
        let pairs: [_; COLUMNS] = array::from_fn(|column| spectra[column].0[j]);
        rows[first] = pairs.map(|[upper, _]| upper);
        rows[parts + first] = pairs.map(|[_, lower]| lower);
    }
    if let Some(row) = rows.into_remainder().get_mut(first) {
        for (value, (_, last)) in row.iter_mut().zip(spectra) {
            if let [last] = last {
                *value = *last;
            }
        }
    }
}

/// Copies the rows `rows` of all blocks of `height` rows into one line of `lines` each, one
/// [`stride`] apart.
#[inline(always)]
pub(super) fn gather_rows(
    blocks: &[Complex<f32>],
    height: usize,
    rows: Range<usize>,
    lines: &mut [Complex<f32>],
    width: usize,
) {
    let blocks = blocks.chunks_exact(COLUMNS * height);
    for (block, start) in blocks.zip((0..width).step_by(COLUMNS)) {
        let (block, _) = block.as_chunks::<COLUMNS>();
        let lines = lines.chunks_exact_mut(stride(width));
        for (values, line) in block[rows.clone()].iter().zip(lines) {
            let line = &mut line[start..];
            // A copy of known length compiles without a call.
            if let Some(whole) = line.first_chunk_mut::<COLUMNS>() {
                *whole = *values;
            } else {
                line.copy_from_slice(&values[..width - start]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

    fn place(x: usize, y: usize) -> Complex<f32> {
        Complex::new(x as f32, y as f32)
    }

    #[test]
    fn every_value_goes_into_its_column() {
        for (columns, height) in [(0..1, 1), (0..64, 17), (64..69, 16), (8..16, 5)] {
            let mut lines = vec![ZERO; columns.len() * stride(height)];
            let fill = |columns: Range<usize>, y, values: &mut [_]| {
                assert_eq!(columns.len(), values.len(), "a value for each column");
                for (value, x) in values.iter_mut().zip(columns) {
                    *value = place(x, y);
                }
            };
            fill_columns(columns.clone(), height, &fill, &mut lines);
            for (x, line) in columns.zip(lines.chunks_exact(stride(height))) {
                for (y, value) in line[..height].iter().enumerate() {
                    assert_eq!(*value, place(x, y), "column {x} of {height} rows");
                }
            }
        }
    }

    #[test]
    fn every_value_goes_into_a_block_and_comes_back_in_its_row() {
        for (width, short, parts) in [
            (1, 1, 1),
            (8, 5, 1),
            (8, 6, 2),
            (17, 7, 2),
            (23, 4, 3),
            (9, 1, 4),
            // More rows than are spread together.
            (9, 2 * TILE + 3, 2),
        ] {
            let height = parts * short;
            let mut blocks = Vec::new();
            for start in (0..width).step_by(COLUMNS) {
                let mut lines = vec![ZERO; COLUMNS * stride(height)];
                for (x, line) in (start..).zip(lines.chunks_exact_mut(stride(height))) {
                    for (y, value) in line[..height].iter_mut().enumerate() {
                        *value = place(x, y);
                    }
                }
                let mut block = vec![[ZERO; COLUMNS]; height];
                spread_columns(&lines, parts, &mut block);
                blocks.extend(block.into_iter().flatten());
            }
            let mut lines = vec![ZERO; height * stride(width)];
            gather_rows(&blocks, height, 0..height, &mut lines, width);
            for (y, line) in lines.chunks_exact(stride(width)).enumerate() {
                for (x, value) in line[..width].iter().enumerate() {
                    // Row `parts · j + s` holds the values j of part s.
                    let expected = place(x, y % parts * short + y / parts);
                    assert_eq!(*value, expected, "{width} × {height} in {parts} parts");
                }
            }
        }
    }

    #[test]
    fn values_begin_with_a_line_of_the_cache() {
        let mut values = Vec::new();
        for length in [1, 1_000, 10] {
            let aligned = aligned(&mut values, length);
            assert_eq!(aligned.len(), length);
            assert_eq!(aligned.as_ptr().align_offset(64), 0, "{length} values");
        }
    }
}
