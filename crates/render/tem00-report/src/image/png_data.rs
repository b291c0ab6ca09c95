//! The image data of PNG files (ISO/IEC 15948, § 9 and 10), compressed by all threads.

use std::io;

use flate2::{Compress, Compression, FlushCompress};
use simd_adler32::Adler32;
use tem00_numerics::parallel;

/// The number of bytes of pixels in a piece. A piece refers to nothing before it, which makes a file
/// longer by 0.01 %.
const PIECE: usize = 1 << 20;

/// Passes the image data of whole rows of `row` bytes to `write`, in pieces that follow each other;
/// `pixel` is the number of bytes of a pixel.
///
/// The bytes do not depend on the number of threads.
pub(super) fn compress<E: From<io::Error>>(
    data: &[u8],
    row: usize,
    pixel: usize,
    mut write: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    let count = PIECE.div_ceil(row);
    let pieces: Vec<_> = data.chunks(count * row).enumerate().collect();
    let mut check = Adler32::new();
    // The header of zlib: a window of 32 KiB, the usual effort.
    let mut start = vec![0x78, 0x9c];
    // In batches, which keep all threads busy and need little memory.
    for together in pieces.chunks(4 * parallel::thread_count()) {
        let compressed = parallel::map(together.len(), |piece| {
            let (index, rows) = together[piece];
            let start = index * count * row;
            let above = start.checked_sub(row).map(|above| &data[above..start]);
            let filtered = filtered(rows, above, row, pixel);
            deflated(&filtered, index + 1 == pieces.len()).map(|bytes| (filtered, bytes))
        });
        for piece in compressed {
            let (filtered, bytes) = piece?;
            check.write(&filtered);
            start.extend(bytes);
            write(&start)?;
            start.clear();
        }
    }
    write(&check.finish().to_be_bytes())
}

/// Returns a piece of a stream that ends at a whole byte, or the end of the stream.
fn deflated(bytes: &[u8], is_last: bool) -> io::Result<Vec<u8>> {
    let flush = if is_last {
        FlushCompress::Finish
    } else {
        FlushCompress::Sync
    };
    let mut packed = Compress::new(Compression::default(), false);
    // Bytes that cannot be compressed are stored, with 5 bytes for each block of thousands.
    let mut result = Vec::with_capacity(bytes.len() + bytes.len() / 100 + 1000);
    packed.compress_vec(bytes, &mut result, flush)?;
    if result.len() == result.capacity() || packed.total_in() < bytes.len() as u64 {
        return Err(io::Error::other(
            "compressed data longer than data that is stored",
        ));
    }
    Ok(result)
}

/// The number of the filter by Paeth's prediction. Choosing a filter for each row, as the standard
/// advises, makes patterns and renders, which are noise, no shorter by half a percent.
const PAETH: u8 = 4;

/// Returns rows, each behind the number of its filter, less what their neighbours predict.
fn filtered(rows: &[u8], above: Option<&[u8]>, row: usize, pixel: usize) -> Vec<u8> {
    let black = vec![0; row];
    let mut above = above.unwrap_or(&black);
    let mut result = Vec::with_capacity(rows.len() + rows.len() / row);
    for current in rows.chunks(row) {
        result.push(PAETH);
        let [first, first_above] = [current, above].map(|row| &row[..pixel]);
        let first = first.iter().zip(first_above);
        result.extend(first.map(|(byte, up)| byte.wrapping_sub(*up)));
        let neighbours = current.iter().zip(above).zip(&above[pixel..]);
        let bytes = current[pixel..].iter().zip(neighbours);
        result.extend(
            bytes.map(|(byte, ((&left, &up_left), &up))| {
                byte.wrapping_sub(paeth(left, up, up_left))
            }),
        );
        above = current;
    }
    result
}

/// Of left, up and up-left, the nearest to `left + up − up_left` (§ 9.4).
fn paeth(left: u8, up: u8, up_left: u8) -> u8 {
    let (a, b, c) = (i16::from(left), i16::from(up), i16::from(up_left));
    let (to_a, to_b, to_c) = ((b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs());
    if to_a <= to_b && to_a <= to_c {
        left
    } else if to_b <= to_c {
        up
    } else {
        up_left
    }
}
