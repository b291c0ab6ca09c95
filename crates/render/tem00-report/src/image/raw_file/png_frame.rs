use std::io::{BufRead, Seek, SeekFrom, Write};

use png::{BitDepth, ColorType, Decoder, Reader, Transformations};

use super::super::png_file::write_png;
use super::{
    BIT_DEPTH, BYTES_PER_PIXEL, Components, GreyFrame, ImageError, MAX_DEFLATION, Samples,
    StoredCurve, check_length, check_room, checked_area, orientation::of_exif, stated_bit_depth,
};

pub(super) fn read(reader: impl BufRead + Seek) -> Result<Samples, ImageError> {
    let (mut reader, area) = decoder(reader, [size_of::<f32>(), BYTES_PER_PIXEL])?;
    let (width, height) = (reader.info().width, reader.info().height);
    let (colour, depth) = reader.output_color_type();
    let components = Components::from(colour);
    let stored = if depth == BitDepth::Sixteen { 16 } else { 8 };

    let mut values = Vec::with_capacity(area * components.names().len());
    let mut line = vec![0; reader.output_line_size(width).unwrap_or(0)];
    if reader.info().interlaced {
        line.resize(reader.output_buffer_size().unwrap_or(0), 0);
        reader.next_frame(&mut line)?;
        extend(&mut values, &line, stored);
    } else {
        while reader.read_row(&mut line)?.is_some() {
            extend(&mut values, &line, stored);
        }
    }
    // The text may stand behind the image.
    reader.finish()?;
    let bits = Bits::of(reader.info(), stored);
    if bits.shift > 0 {
        let scale = (1_u32 << bits.shift) as f32;
        values
            .iter_mut()
            .for_each(|value| *value = (*value / scale).floor());
    }
    let size = [width as usize, height as usize];
    let exif = reader.info().exif_metadata.as_deref();
    Ok(Samples {
        curve: curve(reader.info()),
        orientation: exif.and_then(of_exif).unwrap_or(1),
        remark: bits.remark.into(),
        ..Samples::new(size, components, values, Some(bits.depth))
    })
}

/// Returns the reader of a PNG file of any colour type and depth, and its number of pixels, once it
/// is known that the file can hold as many pixels and that memory is available: for the reader, and
/// for the given bytes of each component and of each pixel.
fn decoder<R: BufRead + Seek>(
    mut source: R,
    [per_component, per_pixel]: [usize; 2],
) -> Result<(Reader<R>, usize), ImageError> {
    let bytes = source.seek(SeekFrom::End(0))?;
    source.rewind()?;
    let mut decoder = Decoder::new(source);
    decoder.set_transformations(Transformations::EXPAND);
    let reader = decoder.read_info()?;
    let info = reader.info();
    let (width, height) = (u64::from(info.width), u64::from(info.height));
    let area = checked_area(width, height)?;
    let bits = info.color_type.samples() as u64 * u64::from(info.bit_depth as u8);
    check_length([width, height], bytes, 8 * MAX_DEFLATION / bits)?;
    let (colour, depth) = reader.output_color_type();
    // Interlaced rows come in no order: all of them are held.
    let held = if info.interlaced {
        (depth as usize).div_ceil(8)
    } else {
        0
    };
    check_room(area, (held + per_component) * colour.samples() + per_pixel)?;
    Ok((reader, area))
}

fn extend(values: &mut Vec<f32>, data: &[u8], stored: u32) {
    if stored == 16 {
        let pairs = data.chunks_exact(2);
        values.extend(pairs.map(|pair| f32::from(u16::from_be_bytes([pair[0], pair[1]]))));
    } else {
        values.extend(data.iter().map(|&value| f32::from(value)));
    }
}

/// The curve by the chunk that goes before the others (PNG, third edition, 4.3): cICP, iCCP, sRGB,
/// gAMA.
fn curve(info: &png::Info<'_>) -> StoredCurve {
    let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
    if let Some(points) = info.coding_independent_code_points {
        StoredCurve::of_code(points.transfer_function)
    } else if info.srgb.is_some() {
        StoredCurve::Srgb
    } else if let Some(gamma) = gamma.filter(|gamma| *gamma > 0) {
        // Next to a profile, it serves readers that do not read the profile.
        StoredCurve::Gamma(f64::from(gamma) / 1e5)
    } else if info.icc_profile.is_some() {
        StoredCurve::Profile
    } else {
        StoredCurve::Unknown
    }
}

/// The encoding of grey values in the file.
struct Bits {
    depth: u32,
    shift: u32,
    remark: &'static str,
}

impl Bits {
    fn of(info: &png::Info<'_>, stored: u32) -> Self {
        let entry = info.utf8_text.iter().find(|text| text.keyword == BIT_DEPTH);
        let told = entry.and_then(|text| stated_bit_depth(&text.get_text().ok()?));
        let significant = info.sbit.as_deref().and_then(<[u8]>::first);
        match (told, significant) {
            (Some(depth), _) if depth <= stored => Self {
                depth,
                shift: 0,
                remark: ", as the file says",
            },
            (_, Some(&bits)) if (8..stored).contains(&u32::from(bits)) => Self {
                depth: bits.into(),
                shift: stored - u32::from(bits),
                remark: ", scaled up in the file",
            },
            _ => Self {
                depth: stored,
                shift: 0,
                remark: "",
            },
        }
    }
}

pub(super) fn write(
    writer: impl Write,
    frame: GreyFrame<'_>,
    text: &[(&str, String)],
) -> Result<(), ImageError> {
    let values = frame.values.values().iter();
    let (depth, data): (_, Vec<u8>) = if frame.bit_depth == 8 {
        let low = values.map(|value| value.to_be_bytes()[1]);
        (BitDepth::Eight, low.collect())
    } else {
        let both = values.flat_map(|value| value.to_be_bytes());
        (BitDepth::Sixteen, both.collect())
    };
    let text = [&[(BIT_DEPTH, frame.bit_depth.to_string())][..], text].concat();
    let size = [frame.values.width(), frame.values.height()];
    let kind = (ColorType::Grayscale, depth);
    write_png(writer, size, kind, &text, &data, |_| {})
}
