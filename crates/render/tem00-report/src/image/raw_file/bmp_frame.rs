//! Windows bitmaps as cameras write them: not compressed.

use std::io::{BufRead, Seek, SeekFrom};

use image::{ColorType, ImageDecoder, codecs::bmp::BmpDecoder};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

/// The bytes of the headers up to the method of compression.
const HEADERS: usize = 34;

pub(super) fn read(mut reader: impl BufRead + Seek) -> Result<Samples, ImageError> {
    let length = reader.seek(SeekFrom::End(0))?;
    reader.rewind()?;
    let mut headers = [0; HEADERS];
    reader.read_exact(&mut headers)?;
    reader.rewind()?;
    let [bits, method] = [headers[28], headers[30]];
    // The decoder shows what a compressed file lacks as black.
    if matches!(method, 1 | 2) {
        let what = format!("pixels of {bits} bits, compressed by the method {method},");
        return Err(ImageError::Pixels(what));
    }
    let decoder = BmpDecoder::new(reader)?;
    let (width, height) = decoder.dimensions();
    let area = checked_area(width.into(), height.into())?;
    check_length([width, height].map(u64::from), length, 8)?;
    let mut components = match decoder.color_type() {
        ColorType::Rgba8 => Components::Rgba,
        _ => Components::Rgb,
    };
    let count = components.names().len();
    check_room(area, 5 * count + BYTES_PER_PIXEL)?;
    let mut bytes = vec![0; count * area];
    decoder.read_image(&mut bytes)?;
    let is_grey = |pixel: &[u8]| pixel[0] == pixel[1] && pixel[1] == pixel[2];
    if bits <= 8 && bytes.chunks_exact(count).all(is_grey) {
        components = Components::Grey;
        bytes = bytes.into_iter().step_by(count).collect();
    }
    let values = bytes.into_iter().map(f32::from).collect();
    let size = [width as usize, height as usize];
    Ok(Samples::new(size, components, values, Some(8)))
}
