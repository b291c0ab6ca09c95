//! Portable grey and pixel maps: the formats P2, P3, P5 and P6 of Netpbm.
//!
//! Their header is four numbers, of which the last, the largest grey value, gives the bits of the
//! camera; the readers of other crates drop it.

use std::io::{BufRead, Read, Seek, SeekFrom};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

const TOO_SHORT: ImageError = ImageError::Pnm("it ends before its last pixel");
const TOO_LONG: ImageError = ImageError::Pnm("it goes on behind its last pixel");

pub(super) fn read(mut reader: impl BufRead + Seek) -> Result<Samples, ImageError> {
    let bytes = reader.seek(SeekFrom::End(0))?;
    reader.rewind()?;
    let mut magic = [0; 2];
    reader.read_exact(&mut magic)?;
    let (components, binary) = match &magic {
        b"P2" => (Components::Grey, false),
        b"P3" => (Components::Rgb, false),
        b"P5" => (Components::Grey, true),
        b"P6" => (Components::Rgb, true),
        _ => return Err(ImageError::Pnm("it begins with none of P2, P3, P5 and P6")),
    };
    let mut header = Numbers {
        reader,
        last: 0,
        is_windows: false,
    };
    let (width, height, largest) = (header.number()?, header.number()?, header.number()?);
    let area = checked_area(width.into(), height.into())?;
    let largest = u16::try_from(largest)
        .ok()
        .filter(|&largest| largest > 0)
        .ok_or(ImageError::Pnm(
            "its largest grey value is not from 1 to 65535",
        ))?;
    let length = area * components.names().len();
    check_length([width, height].map(u64::from), bytes, 1)?;
    check_room(area, 6 * components.names().len() + BYTES_PER_PIXEL)?;
    let (values, has_further_images) = if binary {
        header.binary_values(length, largest)?
    } else {
        let mut values = Vec::new();
        for _ in 0..length {
            values.push(u16::try_from(header.number()?).unwrap_or(u16::MAX));
        }
        let mut behind = header.reader.bytes().filter_map(Result::ok);
        match behind.find(|byte| !byte.is_ascii_whitespace()) {
            None | Some(b'#') => (values, false),
            Some(_) => return Err(TOO_LONG),
        }
    };
    if values.iter().any(|&value| value > largest) {
        return Err(ImageError::Pnm(
            "a grey value is above the largest it states",
        ));
    }
    let size = [width as usize, height as usize];
    let values = values.into_iter().map(f32::from).collect();
    let bits = u16::BITS - largest.leading_zeros();
    Ok(Samples {
        remark: ", as the file says".into(),
        has_further_images,
        ..Samples::new(size, components, values, Some(bits))
    })
}

/// The numbers of a header, or of a text.
struct Numbers<R> {
    reader: R,
    /// The last character that was read.
    last: u8,
    /// Whether a line ended with a carriage return and a line feed.
    is_windows: bool,
}

impl<R: BufRead> Numbers<R> {
    /// Reads a decimal number and the character behind it; comments run from `#` to the end of the
    /// line.
    fn number(&mut self) -> Result<u32, ImageError> {
        let mut digits = None;
        let mut comment = false;
        for byte in self.reader.by_ref().bytes() {
            let byte = byte?;
            self.is_windows |= [self.last, byte] == *b"\r\n";
            self.last = byte;
            match byte {
                b'\n' | b'\r' if comment => comment = false,
                _ if comment => (),
                b'#' if digits.is_none() => comment = true,
                b'0'..=b'9' => {
                    let next = |sum: u32| sum.checked_mul(10)?.checked_add(u32::from(byte - b'0'));
                    let too_large = ImageError::Pnm("it has a number that is too large");
                    digits = Some(next(digits.unwrap_or(0)).ok_or(too_large)?);
                }
                byte if byte.is_ascii_whitespace() => {
                    if let Some(number) = digits {
                        return Ok(number);
                    }
                }
                _ => {
                    return Err(ImageError::Pnm(
                        "it has something else where a number should be",
                    ));
                }
            }
        }
        // The last number of a text may be the end of the file.
        digits.ok_or(TOO_SHORT)
    }

    /// Reads values of one byte, or of two with the higher one first, and returns whether another
    /// map follows.
    ///
    /// One character of white space ends the header, or the two that end a line on Windows: its
    /// other lines tell, and if it has none the length.
    fn binary_values(
        &mut self,
        length: usize,
        largest: u16,
    ) -> Result<(Vec<u16>, bool), ImageError> {
        let width = if largest > u8::MAX.into() { 2 } else { 1 };
        let needed = length * width;
        // The memory grows with what the file holds, not with what it says.
        let mut data = Vec::new();
        let mut rest = self.reader.by_ref().take(needed as u64 + 2);
        rest.read_to_end(&mut data)?;
        let is_windows = self.is_windows || data.len() == needed + 1;
        if self.last == b'\r' && data.first() == Some(&b'\n') && is_windows {
            data.remove(0);
        }
        if data.len() < needed {
            return Err(TOO_SHORT);
        }
        let behind = data.split_off(needed);
        if !behind.is_empty() && !behind.starts_with(b"P") {
            return Err(TOO_LONG);
        }
        let value = |bytes: &[u8]| {
            bytes
                .iter()
                .fold(0, |sum, &byte| sum << 8 | u16::from(byte))
        };
        let values = data.chunks_exact(width).map(value).collect();
        Ok((values, !behind.is_empty()))
    }
}
