use std::io::Read;

use zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
use zune_jpeg::JpegDecoder;

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, StoredCurve, check_room, checked_area,
};

/// The most pixels along a side: what the format can say.
const LONGEST_SIDE: usize = 65_535;

/// The markers of the start of a scan and of the end of the image.
const START_OF_SCAN: [u8; 2] = [0xff, 0xda];
const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];

pub(super) fn read(mut reader: impl Read) -> Result<Samples, ImageError> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    // The decoder fills what is missing with grey.
    let last = |marker| file.windows(2).rposition(|bytes| bytes == marker);
    if last(END_OF_IMAGE) <= last(START_OF_SCAN) {
        return Err(ImageError::Pixels("a file that was cut".into()));
    }
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(LONGEST_SIDE)
        .set_max_height(LONGEST_SIDE);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(file), options);
    decoder.decode_headers()?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let area = checked_area(width as u64, height as u64)?;
    let (components, colours) = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => (Components::Grey, ColorSpace::Luma),
        Some(ColorSpace::YCbCr | ColorSpace::RGB) => (Components::Rgb, ColorSpace::RGB),
        other => return Err(ImageError::Pixels(format!("the type {other:?}"))),
    };
    check_room(area, 3 * components.names().len() + BYTES_PER_PIXEL)?;
    decoder.set_options(options.jpeg_set_out_colorspace(colours));
    let values: Vec<_> = decoder.decode()?.into_iter().map(u16::from).collect();
    if values.len() != area * components.names().len() {
        return Err(ImageError::Pixels("another number than it says".into()));
    }
    Ok(Samples {
        width,
        height,
        components,
        values,
        bit_depth: 8,
        curve: StoredCurve::Unknown,
        remark: ", compressed with losses",
        has_further_images: false,
    })
}
