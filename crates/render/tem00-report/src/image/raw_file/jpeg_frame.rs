use zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
use zune_jpeg::{JpegDecoder, errors::DecodeErrors};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, StoredCurve, check_length, check_room,
    checked_area, orientation::of_exif,
};

/// The maximum number of pixels along a side that the format allows.
const LONGEST_SIDE: usize = 65_535;

/// The maximum number of pixels per byte of coded data: a block of 64 has at least one bit.
const PIXELS_PER_BYTE: u64 = 64 * 8;

/// Coded ones, which no complete image reads: no Huffman code consists of ones (ITU-T T.81, annex
/// C).
const ONES: [u8; 64] = {
    let mut ones = [0xff; 64];
    let mut index = 1;
    while index < ones.len() {
        ones[index] = 0;
        index += 2;
    }
    ones
};

pub(super) fn read(mut file: Vec<u8>) -> Result<Samples, ImageError> {
    let end = end_of_image(&file).ok_or(ImageError::CutJpeg)?;
    let bytes = file.len() as u64;
    // The decoder fills missing data with grey: here it meets data that cannot be.
    file.splice(end..end, ONES);
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(LONGEST_SIDE)
        .set_max_height(LONGEST_SIDE);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(file), options);
    decoder.decode_headers()?;
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let area = checked_area(width as u64, height as u64)?;
    check_length([width as u64, height as u64], bytes, PIXELS_PER_BYTE)?;
    let (components, colours) = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => (Components::Grey, ColorSpace::Luma),
        Some(ColorSpace::YCbCr | ColorSpace::RGB) => (Components::Rgb, ColorSpace::RGB),
        Some(other) => return Err(ImageError::Pixels(format!("pixels of the type {other:?}"))),
        None => return Err(ImageError::Pixels("pixels of an unknown type".into())),
    };
    check_room(area, 5 * components.names().len() + BYTES_PER_PIXEL)?;
    decoder.set_options(options.jpeg_set_out_colorspace(colours));
    let values = decoder.decode().map_err(without_the_end)?;
    let values: Vec<_> = values.into_iter().map(f32::from).collect();
    if values.len() != area * components.names().len() {
        return Err(ImageError::CutJpeg);
    }
    let curve = match decoder.icc_profile() {
        Some(_) => StoredCurve::Profile,
        None => StoredCurve::Unknown,
    };
    Ok(Samples {
        curve,
        orientation: decoder.exif().and_then(|exif| of_exif(exif)).unwrap_or(1),
        remark: ", compressed with losses".into(),
        ..Samples::new([width, height], components, values, Some(8))
    })
}

/// Returns the error of a file whose coded data end too early as such.
fn without_the_end(error: DecodeErrors) -> ImageError {
    let words = error.to_string();
    let ends = [
        "Huffman",
        "bits left",
        "bytes left",
        "Premature",
        "xhausted",
    ];
    if ends.iter().any(|end| words.contains(end)) {
        return ImageError::CutJpeg;
    }
    error.into()
}

/// Returns the position of the marker at the end of the first image; `None` if it is missing, or if
/// restarts or scans before it are missing.
fn end_of_image(file: &[u8]) -> Option<usize> {
    const END: u8 = 0xd9;
    let byte = |at: usize| file.get(at).copied().map(usize::from);
    let two = |at: usize| Some(byte(at)? << 8 | byte(at + 1)?);
    let is_restart = |pair: &&[u8]| pair[0] == 0xff && matches!(pair[1], 0xd0..=0xd7);
    // Coded data may stand before a marker; in them 0xff is followed by 0 or a restart.
    let is_marker = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7 | 0xff);
    let (mut at, mut interval, mut due) = (2, 0, 0);
    let (mut units, mut components, mut scans) = (0, 0, Scans::default());
    loop {
        let coded = file.get(at..)?;
        let length = coded.windows(2).position(is_marker)?;
        if coded[..length].windows(2).filter(is_restart).count() < due {
            return None;
        }
        at += length;
        due = 0;
        match file[at + 1] {
            END => return scans.are_complete().then_some(at),
            0xdd => interval = two(at + 4)?,
            kind @ 0xc0..=0xc2 => {
                components = byte(at + 9)?;
                let frame = file.get(at + 5..at + 10 + 3 * components)?;
                units = coded_units(frame);
                scans.start(kind == 0xc2, &frame[5..]);
            }
            0xda => {
                let here = byte(at + 4)?;
                scans.add(file.get(at + 5..at + 8 + 2 * here)?);
                // Each of several scans has its own units.
                if interval > 0 && here == components {
                    due = usize::div_ceil(units, interval).saturating_sub(1);
                }
            }
            _ => (),
        }
        at += 2 + two(at + 2)?;
    }
}

/// The coefficients of a progressive image that its scans have brought to their last bit, by
/// component.
#[derive(Default)]
struct Scans {
    /// The name of each component, and a bit for each coefficient.
    done: Vec<(u8, u64)>,
}

impl Scans {
    fn start(&mut self, is_progressive: bool, components: &[u8]) {
        let names = components
            .chunks_exact(3)
            .map(|component| (component[0], 0));
        self.done = names.filter(|_| is_progressive).collect();
    }

    /// Adds a scan: two bytes of each of its components, the first and the last coefficient, and
    /// the bits that are left in the lower half of a byte.
    fn add(&mut self, scan: &[u8]) {
        let [components @ .., first, last, bits] = scan else {
            return;
        };
        if bits & 15 > 0 || first > last || *last > 63 {
            return;
        }
        let brought = (u64::MAX >> (63 - last)) & (u64::MAX << first);
        for (name, done) in &mut self.done {
            if components
                .chunks_exact(2)
                .any(|component| component[0] == *name)
            {
                *done |= brought;
            }
        }
    }

    fn are_complete(&self) -> bool {
        self.done.iter().all(|&(_, done)| done == u64::MAX)
    }
}

/// Returns the number of coded units of a frame, whose header begins with its height.
fn coded_units(frame: &[u8]) -> usize {
    let side = |at: usize| usize::from(u16::from_be_bytes([frame[at], frame[at + 1]]));
    let sampling = frame[5..].chunks_exact(3).map(|component| component[1]);
    let [across, down] = match sampling.len() {
        1 => [1, 1],
        _ => [
            sampling.clone().map(|factors| factors >> 4).max(),
            sampling.map(|factors| factors & 15).max(),
        ]
        .map(|max| usize::from(max.unwrap_or(1)).max(1)),
    };
    side(2).div_ceil(8 * across) * side(0).div_ceil(8 * down)
}
