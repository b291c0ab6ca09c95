//! Windows bitmaps as cameras write them: not compressed.

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

/// The length of the smallest header of Windows, `BITMAPINFOHEADER`, and of the header before it.
const HEADER: u32 = 40;
const FILE_HEADER: usize = 14;

/// The masks of red, green and blue where the file has none of its own.
const MASKS_OF_16_BITS: [u32; 3] = [0x7c00, 0x03e0, 0x001f];
const MASKS_OF_BYTES: [u32; 3] = [0x00ff_0000, 0xff00, 0xff];

pub(super) fn read(file: Vec<u8>) -> Result<Samples, ImageError> {
    let word = |at: usize| {
        let bytes = file.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
        bytes.map(u32::from_le_bytes).ok_or(ImageError::Bmp)
    };
    let header = word(FILE_HEADER)?;
    if !file.starts_with(b"BM") || header < HEADER {
        return Err(ImageError::Bmp);
    }
    let (width, height) = (word(18)?, word(22)?.cast_signed());
    let is_top_down = height < 0;
    let (bits, method) = (word(28)? & 0xffff, word(30)?);
    let masks = match (bits, method) {
        (1 | 4 | 8 | 24 | 32, 0) => MASKS_OF_BYTES,
        (16, 0) => MASKS_OF_16_BITS,
        // Bit fields, without and with one for alpha.
        (16 | 32, 3 | 6) => [word(54)?, word(58)?, word(62)?],
        _ => {
            let what = format!("pixels of {bits} bits, compressed by the method {method},");
            return Err(ImageError::Pixels(what));
        }
    };
    let area = checked_area(width.into(), height.unsigned_abs().into())?;
    let size = [width, height.unsigned_abs()];
    check_length(size.map(u64::from), file.len() as u64, 8)?;
    check_room(area, 3 * size_of::<f32>() + BYTES_PER_PIXEL)?;

    let [width, height] = size.map(|side| side as usize);
    let stride = (width * bits as usize).div_ceil(32) * 4;
    let start = word(10)? as usize;
    let rows = file
        .get(start..)
        .and_then(|rows| rows.get(..stride * height));
    let rows = rows.ok_or(ImageError::Bmp)?.chunks_exact(stride);
    let palette = file.get(FILE_HEADER + header as usize..start);
    let (palette, _) = palette.unwrap_or_default().as_chunks::<4>();
    let pixel = |row: &[u8], x: usize| {
        let bit = x * bits as usize;
        if bits <= 8 {
            let index = row[bit / 8] >> (8 - bits as usize - bit % 8) & (0xff >> (8 - bits));
            let [blue, green, red, _] = *palette.get(usize::from(index))?;
            return Some([red, green, blue]);
        }
        let bytes = row[bit / 8..].iter().take(bits as usize / 8).rev();
        let value = bytes.fold(0, |value, &byte| value << 8 | u32::from(byte));
        Some(masks.map(|mask| in_eight_bits(value, mask)))
    };
    // A negative height says that the rows run from the top down.
    let rows: Vec<_> = if is_top_down {
        rows.collect()
    } else {
        rows.rev().collect()
    };
    let pixels = rows.into_iter().flat_map(|row| {
        (0..width).map({
            let pixel = &pixel;
            move |x| pixel(row, x)
        })
    });
    let pixels: Vec<[u8; 3]> = pixels.collect::<Option<_>>().ok_or(ImageError::Bmp)?;
    let is_grey = |[red, green, blue]: &[u8; 3]| red == green && green == blue;
    let (components, values): (_, Vec<u8>) = if bits <= 8 && pixels.iter().all(is_grey) {
        (
            Components::Grey,
            pixels.iter().map(|pixel| pixel[0]).collect(),
        )
    } else {
        (Components::Rgb, pixels.into_flattened())
    };
    let values = values.into_iter().map(f32::from).collect();
    Ok(Samples::new([width, height], components, values, Some(8)))
}

/// Returns the component under a mask as a number of 0 to 255, rounded.
fn in_eight_bits(value: u32, mask: u32) -> u8 {
    let shift = mask.trailing_zeros().min(31);
    let [part, full] = [value & mask, mask].map(|bits| u64::from(bits >> shift));
    u8::try_from((part * 255 + full / 2) / full.max(1)).unwrap_or(u8::MAX)
}
