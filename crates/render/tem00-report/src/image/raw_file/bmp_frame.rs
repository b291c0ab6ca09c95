//! Windows bitmaps as cameras write them: not compressed, 8 bits with a palette, 24 or 32 bits.
//!
//! Readers of other crates fill a file that was cut with black; here it is an error.

use std::io::{BufRead, Read, Seek, SeekFrom};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

/// The bytes before the header that describes the pixels.
const FILE_HEADER: u32 = 14;
/// The bytes of the shortest header that describes the pixels.
const SHORTEST_HEADER: u32 = 40;
/// The most bytes between the start of the file and its pixels.
const LARGEST_OFFSET: u32 = 1 << 16;

/// The contents of the headers.
struct Header {
    width: u32,
    height: u32,
    /// `true` if the first row of the file is the lowest of the image.
    upside_down: bool,
    bits: u16,
    /// The position of the palette and of the pixels in the file.
    palette: u32,
    pixels: u32,
}

pub(super) fn read(mut reader: impl BufRead + Seek) -> Result<Samples, ImageError> {
    let length = reader.seek(SeekFrom::End(0))?;
    reader.rewind()?;
    let header = Header::read(&mut reader)?;
    let area = checked_area(header.width.into(), header.height.into())?;
    check_length([header.width, header.height].map(u64::from), length, 1)?;
    // Up to three components of 32 bits.
    check_room(area, 12 + BYTES_PER_PIXEL)?;
    let (width, height) = (header.width as usize, header.height as usize);
    let colours = header.colours(&mut reader)?;
    let bytes = usize::from(header.bits / 8);
    let components = match &colours {
        Some(colours) if colours.iter().all(|[r, g, b]| r == g && g == b) => Components::Grey,
        _ => Components::Rgb,
    };
    let of_pixel = |pixel: &[u8], row: &mut Vec<f32>| {
        let colour = match &colours {
            Some(colours) => colours[usize::from(pixel[0])],
            None => [pixel[2], pixel[1], pixel[0]],
        };
        let taken = &colour[..components.names().len()];
        row.extend(taken.iter().map(|&value| f32::from(value)));
    };
    // Rows take a multiple of four bytes.
    let mut line = vec![0; (width * bytes).next_multiple_of(4)];
    let mut rows = Vec::new();
    for _ in 0..height {
        read_exact(&mut reader, &mut line)?;
        let mut row = Vec::with_capacity(width * components.names().len());
        for pixel in line[..width * bytes].chunks_exact(bytes) {
            of_pixel(pixel, &mut row);
        }
        rows.push(row);
    }
    if header.upside_down {
        rows.reverse();
    }
    Ok(Samples::new(
        [width, height],
        components,
        rows.concat(),
        Some(8),
    ))
}

impl Header {
    /// Reads the headers, as far as they are of use.
    fn read(reader: &mut impl Read) -> Result<Self, ImageError> {
        let mut bytes = [0; (FILE_HEADER + SHORTEST_HEADER) as usize];
        read_exact(reader, &mut bytes)?;
        let two = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let four = |at: usize| u32::from(two(at)) | u32::from(two(at + 2)) << 16;
        if !bytes.starts_with(b"BM") {
            return Err(ImageError::Bmp("it does not begin with BM"));
        }
        let (length, height) = (four(14), four(22).cast_signed());
        let header = Self {
            width: four(18),
            height: height.unsigned_abs(),
            upside_down: height > 0,
            bits: two(28),
            palette: FILE_HEADER.saturating_add(length),
            pixels: four(10),
        };
        let in_order = length >= SHORTEST_HEADER
            && header.palette <= header.pixels
            && header.pixels <= LARGEST_OFFSET;
        if !in_order {
            return Err(ImageError::Bmp("its headers have lengths that cannot be"));
        }
        if four(30) != 0 || !matches!(header.bits, 8 | 24 | 32) {
            return Err(ImageError::Pixels(format!(
                "pixels of {} bits, compressed by the method {},",
                header.bits,
                four(30)
            )));
        }
        Ok(header)
    }

    /// Reads up to the pixels, and returns the red, green and blue of the palette, if there is one.
    fn colours(&self, reader: &mut impl Read) -> Result<Option<Vec<[u8; 3]>>, ImageError> {
        let mut bytes = vec![0; (self.pixels - FILE_HEADER - SHORTEST_HEADER) as usize];
        read_exact(reader, &mut bytes)?;
        if self.bits != 8 {
            return Ok(None);
        }
        let palette = &bytes[(self.palette - FILE_HEADER - SHORTEST_HEADER) as usize..];
        let entries = palette
            .chunks_exact(4)
            .map(|entry| [entry[2], entry[1], entry[0]]);
        let mut colours: Vec<_> = entries.take(256).collect();
        if colours.is_empty() {
            return Err(ImageError::Bmp("its palette is missing"));
        }
        // Values without an entry are black.
        colours.resize(256, [0; 3]);
        Ok(Some(colours))
    }
}

fn read_exact(reader: &mut impl Read, bytes: &mut [u8]) -> Result<(), ImageError> {
    let cut = |_| ImageError::Bmp("it ends before its last pixel");
    reader.read_exact(bytes).map_err(cut)
}
