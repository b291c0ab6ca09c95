use std::io::{Cursor, Seek, Write};

use tem00_numerics::{Grid, cast::to_f32};
use tiff::{
    ColorType,
    decoder::DecodingResult,
    encoder::{TiffEncoder, colortype},
    tags::Tag,
};

use super::{
    BIT_DEPTH, BYTES_PER_PIXEL, Components, GreyFrame, ImageError, Samples, StoredCurve,
    check_length, check_room, checked_area, stated_bit_depth,
    tiff_packed::{self, Packing},
    tiff_pixels::{FileDecoder, Pixels, number, read_all},
};

/// The maximum number of bytes that a byte of coded data stands for: LZW grows its words by a byte
/// each, to 4096.
const MAX_EXPANSION: u64 = 4096;

pub(super) fn read(file: Vec<u8>) -> Result<Samples, ImageError> {
    let mut decoder = FileDecoder::new(Cursor::new(&file))?;
    let (width, height) = decoder.dimensions()?;
    let size = [width, height].map(u64::from);
    let area = checked_area(size[0], size[1])?;
    check_length(size, file.len() as u64, MAX_EXPANSION)?;
    let told = told_bit_depth(&mut decoder);
    let has_further_images = decoder.more_images();
    let orientation = number(&mut decoder, Tag::Orientation).unwrap_or(1);
    let has_profile = decoder.find_tag(Tag::IccProfile)?.is_some();
    let packing = Packing::of(&mut decoder)?;
    let channels = match &packing {
        Some(_) => 3,
        None => components(&mut decoder)?.names().len(),
    };
    // Numbers of 64 bits at most, then of 32, then the mean of the channels.
    check_room(area, 12 * channels + BYTES_PER_PIXEL)?;
    let pixels = match packing {
        Some(packing) => tiff_packed::read(file, &packing)?,
        None => whole(decoder, area)?,
    };
    let stored = pixels.bit_depth;
    let told = told.filter(|told| stored.is_some_and(|stored| *told <= stored));
    Ok(Samples {
        curve: if has_profile {
            StoredCurve::Profile
        } else {
            StoredCurve::Unknown
        },
        orientation,
        remark: match (told, has_further_images) {
            (_, true) => format!("{}, the first of several images in the file", pixels.remark),
            (Some(_), _) => format!("{}, as the file says", pixels.remark),
            _ => pixels.remark,
        },
        has_further_images,
        ..Samples::new(
            [width as usize, height as usize],
            pixels.components,
            pixels.values,
            told.or(stored),
        )
    })
}

/// Reads numbers of whole bytes, pixel by pixel or in planes.
fn whole(mut decoder: FileDecoder<'_>, area: usize) -> Result<Pixels, ImageError> {
    let components = components(&mut decoder)?;
    let channels = components.names().len();
    let (read, planes) = read_all(decoder, 8 * channels * area)?;
    let (values, bit_depth, remark) = numbers(read);
    if values.len() != area * channels {
        return Err(ImageError::Pixels(format!(
            "{channels} channels of this kind"
        )));
    }
    let values = if planes > 1 {
        let at = |i: usize| values[(i % channels) * area + i / channels];
        (0..values.len()).map(at).collect()
    } else {
        values
    };
    Ok(Pixels {
        components,
        values,
        bit_depth,
        remark: remark.to_owned(),
    })
}

/// Returns numbers in single precision, their bits where they have a largest value, and their
/// description.
fn numbers(read: DecodingResult) -> (Vec<f32>, Option<u32>, &'static str) {
    const SIGNED: &str = ", signed numbers";
    const FRACTIONS: &str = ", floating-point numbers";
    match read {
        DecodingResult::U8(values) => (of(values, f32::from), Some(8), ""),
        DecodingResult::U16(values) => (of(values, f32::from), Some(16), ""),
        DecodingResult::U32(values) => (of(values, |v| v as f32), None, ", numbers of 32 bits"),
        DecodingResult::U64(values) => (of(values, |v| v as f32), None, ", numbers of 64 bits"),
        DecodingResult::I8(values) => (of(values, f32::from), None, SIGNED),
        DecodingResult::I16(values) => (of(values, f32::from), None, SIGNED),
        DecodingResult::I32(values) => (of(values, |v| v as f32), None, SIGNED),
        DecodingResult::I64(values) => (of(values, |v| v as f32), None, SIGNED),
        DecodingResult::F16(values) => (of(values, |v| v.to_f32()), None, FRACTIONS),
        DecodingResult::F32(values) => (values, None, FRACTIONS),
        DecodingResult::F64(values) => (of(values, to_f32), None, FRACTIONS),
    }
}

fn of<T>(values: Vec<T>, number: impl Fn(T) -> f32) -> Vec<f32> {
    values.into_iter().map(number).collect()
}

fn components(decoder: &mut FileDecoder<'_>) -> Result<Components, ImageError> {
    /// The values of the tag of extra samples that mean opacity.
    const ALPHA: [u64; 2] = [1, 2];
    let extra = decoder.find_tag_unsigned_vec::<u64>(Tag::ExtraSamples)?;
    let is_alpha = extra.is_some_and(|extra| extra.first().is_some_and(|e| ALPHA.contains(e)));
    match decoder.colortype()? {
        ColorType::Gray(_) => Ok(Components::Grey),
        ColorType::GrayA(_) => Ok(Components::GreyAlpha),
        ColorType::RGB(_) => Ok(Components::Rgb),
        ColorType::RGBA(_) => Ok(Components::Rgba),
        ColorType::Multiband { num_samples: 2, .. } if is_alpha => Ok(Components::GreyAlpha),
        ColorType::Multiband {
            num_samples: count @ ..=16,
            ..
        } => Ok(Components::Bands(count)),
        colour => Err(ImageError::Pixels(format!("pixels of the type {colour:?}"))),
    }
}

/// The bit depth that a line of the description states.
fn told_bit_depth(decoder: &mut FileDecoder<'_>) -> Option<u32> {
    let description = decoder.get_tag_ascii_string(Tag::ImageDescription).ok()?;
    let mut entries = description.lines().filter_map(|line| line.split_once('='));
    let (_, bits) = entries.find(|(keyword, _)| *keyword == BIT_DEPTH)?;
    stated_bit_depth(bits)
}

pub(super) fn write(
    writer: impl Write + Seek,
    frame: GreyFrame<'_>,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let mut encoder = TiffEncoder::new(writer)?;
    let description = description(frame.bit_depth, text);
    if frame.bit_depth == 8 {
        let values: Vec<u8> = bytes(frame.values);
        write_image::<colortype::Gray8>(&mut encoder, frame.values, &description, &values)
    } else {
        let values = frame.values.values();
        write_image::<colortype::Gray16>(&mut encoder, frame.values, &description, values)
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
