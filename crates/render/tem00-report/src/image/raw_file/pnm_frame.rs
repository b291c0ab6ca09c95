//! Portable grey and pixel maps: the formats P2, P3, P5 and P6 of Netpbm.

use std::io::{BufRead, Seek};

use image::{
    ColorType, ImageDecoder,
    codecs::pnm::{PnmDecoder, PnmSubtype, SampleEncoding},
};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

pub(super) fn read(mut reader: impl BufRead + Seek) -> Result<Samples, ImageError> {
    let mut file = Vec::new();
    reader.read_to_end(&mut file)?;
    end_header_in_one_character(&mut file)?;
    let mut rest = &file[..];
    let decoder = PnmDecoder::new(&mut rest)?;
    let (PnmSubtype::Graymap(encoding) | PnmSubtype::Pixmap(encoding)) = decoder.subtype() else {
        return Err(ImageError::Pnm("it begins with none of P2, P3, P5 and P6"));
    };
    let is_binary = encoding == SampleEncoding::Binary;
    let (width, height) = decoder.dimensions();
    let area = checked_area(width.into(), height.into())?;
    check_length([width, height].map(u64::from), file.len() as u64, 1)?;
    let colour = decoder.color_type();
    let components = if colour.has_color() {
        Components::Rgb
    } else {
        Components::Grey
    };
    check_room(area, 6 * components.names().len() + BYTES_PER_PIXEL)?;
    let largest = decoder.header().maximal_sample();
    let mut bytes = vec![0; area * usize::from(colour.bytes_per_pixel())];
    decoder.read_image(&mut bytes)?;
    let word = |pair: &[u8]| u16::from_ne_bytes([pair[0], pair[1]]).into();
    let (scaled, full): (Vec<u32>, _) = match colour {
        ColorType::L8 | ColorType::Rgb8 => (bytes.into_iter().map(u32::from).collect(), 0xff),
        _ => (bytes.chunks_exact(2).map(word).collect(), 0xffff),
    };
    // The decoder has scaled the values up, each to the nearest.
    let stored = |value: u32| ((value * largest + full / 2) / full) as f32;
    let behind = if is_binary { rest } else { rest.trim_ascii() };
    let has_further_images = behind.starts_with(b"P");
    if !behind.is_empty() && !has_further_images && (is_binary || !behind.starts_with(b"#")) {
        return Err(ImageError::Pnm("it goes on behind its last pixel"));
    }
    Ok(Samples {
        remark: ", as the file says".into(),
        has_further_images,
        ..Samples::new(
            [width as usize, height as usize],
            components,
            scaled.into_iter().map(stored).collect(),
            Some(u32::BITS - largest.leading_zeros()),
        )
    })
}

/// Takes the first of two characters away with which a header ends on Windows, before pixels in
/// bytes: its other lines tell, and if it has none the length.
fn end_header_in_one_character(file: &mut Vec<u8>) -> Result<(), ImageError> {
    let mut rest = &file[..];
    let decoder = PnmDecoder::new(&mut rest)?;
    let needed = decoder.total_bytes();
    let is_binary = decoder.subtype().sample_encoding() == SampleEncoding::Binary;
    let end = file.len() - rest.len();
    let is_windows =
        file[..end].windows(2).any(|pair| pair == b"\r\n") || rest.len() as u64 == needed + 1;
    if is_binary && is_windows && file[..end].ends_with(b"\r") && rest.starts_with(b"\n") {
        file.remove(end - 1);
    }
    Ok(())
}
