//! How values move between rows and columns: in blocks as wide as a line of the cache.
//!
//! Between the two passes the spectra of [`COLUMNS`] neighbouring columns lie together,
//! `[block][ky][column]`, so that both passes read and write whole cache lines.

use core::{array, ops::Range};

use num_complex::Complex;

use crate::Grid;

/// Columns in a block: 64 bytes, a line of the cache.
pub(super) const COLUMNS: usize = 8;

/// What a line of the spectrum is longer than its values.
///
/// Lines a multiple of 4 KiB apart would share one set of the nearest cache.
pub(super) const PADDING: usize = COLUMNS;

/// Copies a block's columns, from `start` on, into one line of `lines` each.
pub(super) fn gather_columns(
    aperture: &Grid<Complex<f32>>,
    start: usize,
    lines: &mut [Complex<f32>],
) {
    let (width, height) = (aperture.width(), aperture.height());
    if width - start < COLUMNS {
        for (line, x) in lines.chunks_exact_mut(height).zip(start..width) {
            for (to, row) in line.iter_mut().zip(aperture.rows()) {
                *to = row[x];
            }
        }
        return;
    }
    let mut lines = lines.chunks_exact_mut(height);
    let mut lines: [_; COLUMNS] =
        array::from_fn(|_| lines.next().unwrap_or_default().as_chunks_mut::<2>());
    let mut rows = aperture.values().chunks_exact(2 * width);
    // Two rows at a time, so that the values move in pairs.
    for (y, pair) in rows.by_ref().enumerate() {
        let (upper, lower) = pair.split_at(width);
        let values = upper[start..].iter().zip(&lower[start..]);
        for ((line, _), (upper, lower)) in lines.iter_mut().zip(values) {
            line[y] = [*upper, *lower];
        }
    }
    if !rows.remainder().is_empty() {
        let last = &rows.remainder()[start..];
        for ((_, line), value) in lines.into_iter().zip(last) {
            line.fill(*value);
        }
    }
}

/// Writes one part of the columns' spectra into every `parts`-th row of a block, from `first` on.
pub(super) fn spread_columns(
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

/// Copies the rows `rows` of all blocks of `height` rows into one line of `lines` each.
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
        let lines = lines.chunks_exact_mut(width);
        for (values, line) in block[rows.clone()].iter().zip(lines) {
            let line = &mut line[start..];
            // A copy of known length is no call.
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

    #[test]
    fn every_value_goes_into_a_block_and_comes_back_in_its_row() {
        for (width, short, parts) in [
            (1, 1, 1),
            (8, 5, 1),
            (8, 6, 2),
            (17, 7, 2),
            (23, 4, 3),
            (9, 1, 4),
        ] {
            let height = parts * short;
            #[expect(clippy::cast_precision_loss, reason = "small integers")]
            let aperture = Grid::from_fn(width, height, |x, y| Complex::new(x as f32, y as f32));
            let mut blocks = Vec::new();
            for start in (0..width).step_by(COLUMNS) {
                let mut lines = vec![ZERO; COLUMNS * height];
                gather_columns(&aperture, start, &mut lines);
                let mut block = vec![[ZERO; COLUMNS]; height];
                for s in 0..parts {
                    let part = |column: usize| &lines[column * height + s * short..][..short];
                    spread_columns(array::from_fn(part), &mut block, s, parts);
                }
                blocks.extend(block.into_iter().flatten());
            }
            let mut lines = vec![ZERO; width * height];
            gather_rows(&blocks, height, 0..height, &mut lines, width);
            // Row `parts · j + s` holds the values j of part s.
            let expected = Grid::from_fn(width, height, |x, y| {
                aperture[(x, y % parts * short + y / parts)]
            });
            assert_eq!(
                lines,
                expected.values(),
                "{width} × {height} in {parts} parts"
            );
        }
    }
}
