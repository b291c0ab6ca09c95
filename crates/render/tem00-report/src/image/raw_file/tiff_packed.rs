//! TIFF files whose grey values are not whole bytes, or are indices of a palette.
//!
//! The library for TIFF does not read them. Both kinds consist of rows of bytes: the tags are
//! changed so that the library reads these rows, and the values are unpacked here.

use std::io::Cursor;

use tiff::{
    decoder::DecodingResult,
    tags::{ByteOrder, Tag},
};

use super::{
    Components, ImageError,
    tiff_pixels::{FileDecoder, Pixels, number, read_all},
};

/// The layout of packed values.
pub(super) struct Packing {
    size: [usize; 2],
    tile_width: Option<usize>,
    samples: usize,
    bits: usize,
    is_inverted: bool,
    /// Red, green and blue of each index, one after the other.
    palette: Option<Vec<u16>>,
    directory: usize,
    byte_order: ByteOrder,
}

impl Packing {
    /// Returns the layout of a file that holds packed values or indices.
    pub(super) fn of(decoder: &mut FileDecoder<'_>) -> Result<Option<Self>, ImageError> {
        const WHITE_IS_ZERO: usize = 0;
        const PALETTE: usize = 3;
        let mut tag = |tag, otherwise| number::<usize>(decoder, tag).unwrap_or(otherwise);
        let [kind, samples] = [
            tag(Tag::PhotometricInterpretation, 1),
            tag(Tag::SamplesPerPixel, 1),
        ];
        let [planes, order, format, predictor] = [
            Tag::PlanarConfiguration,
            Tag::FillOrder,
            Tag::SampleFormat,
            Tag::Predictor,
        ]
        .map(|name| tag(name, 1));
        let depths = decoder.find_tag_unsigned_vec::<usize>(Tag::BitsPerSample);
        let bits = depths.ok().flatten().map_or(1, |depths| depths[0]);
        if kind != PALETTE && matches!(bits, 8 | 16 | 32 | 64) && order == 1 {
            return Ok(None);
        }
        let is_plain = [planes, order, format].iter().all(|value| *value == 1)
            && (predictor == 1 || bits == 8)
            && matches!((kind, samples), (0 | 1, 1) | (2, 3) | (PALETTE, 1))
            && (1..=16).contains(&bits);
        if !is_plain {
            return Err(ImageError::Pixels(format!(
                "pixels of {samples} × {bits} bits of this kind"
            )));
        }
        let palette = match kind {
            PALETTE => Some(decoder.get_tag_u16_vec(Tag::ColorMap)?),
            _ => None,
        };
        if palette
            .as_ref()
            .is_some_and(|colours| colours.len() != 3 << bits)
        {
            return Err(ImageError::Pixels("palettes of another length".into()));
        }
        let (width, height) = decoder.dimensions()?;
        let pointer = decoder.ifd_pointer().map_or(0, |pointer| pointer.0);
        Ok(Some(Self {
            size: [width as usize, height as usize],
            tile_width: number(decoder, Tag::TileWidth),
            samples,
            bits,
            is_inverted: kind == WHITE_IS_ZERO,
            palette,
            directory: usize::try_from(pointer).unwrap_or(usize::MAX),
            byte_order: decoder.byte_order(),
        }))
    }

    /// Changes the tags so that each row is a row of bytes.
    fn relabel(&self, file: &mut [u8]) {
        let bytes = |pixels: usize| (pixels * self.samples * self.bits).div_ceil(8);
        let new = [
            (Tag::ImageWidth, bytes(self.size[0])),
            (Tag::BitsPerSample, 8),
            (Tag::PhotometricInterpretation, 1),
            (Tag::SamplesPerPixel, 1),
            (Tag::SampleFormat, 1),
            (Tag::TileWidth, self.tile_width.map_or(0, bytes)),
        ];
        for (tag, value) in new {
            self.set(file, tag, value);
        }
    }

    /// Sets the number of an existing tag.
    fn set(&self, file: &mut [u8], tag: Tag, value: usize) -> Option<()> {
        const LONG: u64 = 4;
        let is_big = matches!(file.get(2..4)?, [43, 0] | [0, 43]);
        // The bytes of the number of entries, of an entry and of its fields: tag, type, count,
        // value.
        let (head, length, field) = if is_big { (8, 20, 8) } else { (2, 12, 4) };
        let entries = self.number(file, self.directory, head)?;
        let mut places = (0..usize::try_from(entries).ok()?)
            .map_while(|i| self.directory.checked_add(head + length * i));
        let at = places.find(|&at| self.number(file, at, 2) == Some(tag.to_u16().into()))?;
        self.write(file, (at + 2, 2), LONG)?;
        self.write(file, (at + 4, field), 1)?;
        self.write(file, (at + 4 + field, 4), value as u64)
    }

    fn number(&self, file: &[u8], at: usize, length: usize) -> Option<u64> {
        let bytes = file.get(at..at.checked_add(length)?)?.iter();
        let joined = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(match self.byte_order {
            ByteOrder::LittleEndian => bytes.rev().fold(0, joined),
            ByteOrder::BigEndian => bytes.fold(0, joined),
        })
    }

    fn write(&self, file: &mut [u8], (at, length): (usize, usize), value: u64) -> Option<()> {
        let place = file.get_mut(at..at + length)?;
        match self.byte_order {
            ByteOrder::LittleEndian => place.copy_from_slice(&value.to_le_bytes()[..length]),
            ByteOrder::BigEndian => place.copy_from_slice(&value.to_be_bytes()[8 - length..]),
        }
        Some(())
    }

    /// Returns the numbers of a row, whose highest bits come first.
    fn unpacked<'a>(&'a self, row: &'a [u8]) -> impl Iterator<Item = usize> + 'a {
        let mask = (1 << self.bits) - 1;
        let number = move |index: usize| {
            let (start, end) = (index * self.bits, (index + 1) * self.bits);
            let bytes = row[start / 8..end.div_ceil(8)].iter();
            let joined = bytes.fold(0, |sum: usize, byte| sum << 8 | usize::from(*byte));
            let number = joined >> (end.next_multiple_of(8) - end) & mask;
            if self.is_inverted {
                mask - number
            } else {
                number
            }
        };
        (0..self.size[0] * self.samples).map(number)
    }
}

/// Reads packed values.
pub(super) fn read(mut file: Vec<u8>, packing: &Packing) -> Result<Pixels, ImageError> {
    packing.relabel(&mut file);
    let mut decoder = FileDecoder::new(Cursor::new(&file))?;
    let (row, height) = decoder.dimensions()?;
    let (row, height) = (row as usize, height as usize);
    let (bytes, _) = read_all(decoder, row * height)?;
    let rows = match &bytes {
        DecodingResult::U8(bytes) if bytes.len() == row * height => bytes.chunks_exact(row),
        _ => return Err(ImageError::Pixels("packed rows of this kind".into())),
    };
    let numbers = rows.flat_map(|row| packing.unpacked(row));
    let Some(palette) = &packing.palette else {
        return Ok(Pixels {
            components: if packing.samples == 3 {
                Components::Rgb
            } else {
                Components::Grey
            },
            values: numbers.map(|number| number as f32).collect(),
            bit_depth: u32::try_from(packing.bits).ok(),
            remark: String::new(),
        });
    };
    Ok(coloured(numbers, palette))
}

/// Returns the colours of a palette: as grey where all of them are grey, and with 8 bits where 16
/// bits add nothing.
fn coloured(numbers: impl Iterator<Item = usize>, palette: &[u16]) -> Pixels {
    let count = palette.len() / 3;
    let colour = |index: usize| [0, 1, 2].map(|part| palette[part * count + index]);
    let is_grey = (0..count).map(colour).all(|[r, g, b]| r == g && g == b);
    // Writers put 8 bits into the upper half of 16, and into the lower half the same or nothing.
    let is_doubled = palette.iter().all(|value| value >> 8 == value & 255);
    let is_shifted = palette.iter().all(|value| value & 255 == 0);
    let (shift, bits) = if is_doubled || is_shifted {
        (8, 8)
    } else {
        (0, 16)
    };
    let parts = if is_grey { 1 } else { 3 };
    let of = |index| colour(index).into_iter().take(parts);
    Pixels {
        components: if is_grey {
            Components::Grey
        } else {
            Components::Rgb
        },
        values: numbers
            .flat_map(of)
            .map(|value| f32::from(value >> shift))
            .collect(),
        bit_depth: Some(bits),
        remark: ", by the palette of the file".into(),
    }
}
