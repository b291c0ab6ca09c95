use std::io::{Read, Seek, Write};

use tem00_numerics::Grid;
use tem00_triangulation::RawFrame;
use tiff::{
    ColorType,
    decoder::{Decoder, DecodingResult, Limits},
    encoder::{TiffEncoder, colortype},
    tags::Tag,
};

use super::{
    BIT_DEPTH, BYTES_PER_PIXEL, Components, ImageError, Samples, StoredCurve, check_room,
    checked_area, stated_bit_depth,
};

pub(super) fn read(reader: impl Read + Seek) -> Result<Samples, ImageError> {
    let mut decoder = Decoder::new(reader)?;
    let (width, height) = decoder.dimensions()?;
    let area = checked_area(width.into(), height.into())?;
    let (components, stored) = pixels(decoder.colortype()?)?;
    let length = area * components.names().len();
    // Grey values of 8 bits, then of 16, then the mean of the channels.
    check_room(area, 3 * components.names().len() + BYTES_PER_PIXEL)?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 2 * length;
    let mut decoder = decoder.with_limits(limits);

    let values = match decoder.read_image()? {
        DecodingResult::U8(values) => values.into_iter().map(u16::from).collect(),
        DecodingResult::U16(values) => values,
        _ => return Err(ImageError::Pixels("signed or fractional numbers".into())),
    };
    if values.len() != length {
        return Err(ImageError::Pixels("separate planes".into()));
    }
    let told = told_bit_depth(&mut decoder).filter(|&bits| bits <= stored);
    Ok(Samples {
        width: width as usize,
        height: height as usize,
        components,
        values,
        bit_depth: told.unwrap_or(stored),
        curve: StoredCurve::Unknown,
        remark: match (told, decoder.more_images()) {
            (_, true) => ", the first of several images in the file",
            (Some(_), _) => ", as the file says",
            _ => "",
        },
        has_further_images: decoder.more_images(),
    })
}

fn pixels(colour: ColorType) -> Result<(Components, u32), ImageError> {
    let components = match colour {
        ColorType::Gray(_) => Components::Grey,
        ColorType::GrayA(_) => Components::GreyAlpha,
        ColorType::RGB(_) => Components::Rgb,
        ColorType::RGBA(_) => Components::Rgba,
        _ => return Err(ImageError::Pixels(format!("the type {colour:?}"))),
    };
    match colour.bit_depth() {
        bits @ (8 | 16) => Ok((components, bits.into())),
        bits => Err(ImageError::Pixels(format!("{bits} bits"))),
    }
}

/// The bit depth that a line of the description states.
fn told_bit_depth(decoder: &mut Decoder<impl Read + Seek>) -> Option<u32> {
    let description = decoder.get_tag_ascii_string(Tag::ImageDescription).ok()?;
    let mut entries = description.lines().filter_map(|line| line.split_once('='));
    let (_, bits) = entries.find(|(keyword, _)| *keyword == BIT_DEPTH)?;
    stated_bit_depth(bits)
}

pub(super) fn write(
    writer: impl Write + Seek,
    frame: &RawFrame,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let mut encoder = TiffEncoder::new(writer)?;
    let description = description(frame.bit_depth, text);
    if frame.bit_depth == 8 {
        let values: Vec<u8> = bytes(&frame.values);
        write_image::<colortype::Gray8>(&mut encoder, &frame.values, &description, &values)
    } else {
        let values = frame.values.values();
        write_image::<colortype::Gray16>(&mut encoder, &frame.values, &description, values)
    }
}

fn bytes(values: &Grid<u16>) -> Vec<u8> {
    values
        .values()
        .iter()
        .map(|value| value.to_le_bytes()[0])
        .collect()
}

fn write_image<C: colortype::ColorType>(
    encoder: &mut TiffEncoder<impl Write + Seek>,
    shape: &Grid<u16>,
    description: &str,
    values: &[C::Inner],
) -> Result<(), ImageError>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let size = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
    let mut image = encoder.new_image::<C>(size(shape.width()), size(shape.height()))?;
    image
        .encoder()
        .write_tag(Tag::ImageDescription, description)?;
    Ok(image.write_data(values)?)
}

/// Puts the text entries into lines `keyword=content`. A description is ASCII: other characters are
/// written as in Rust, `\u{e9}`.
fn description(bit_depth: u32, text: &[(&str, String)]) -> String {
    let mut lines = format!("{BIT_DEPTH}={bit_depth}\n");
    for (keyword, content) in text {
        let entry = format!("{keyword}={content}");
        lines.push_str(&entry.escape_default().to_string().replace("\\\"", "\""));
        lines.push('\n');
    }
    lines
}
