//! Portable grey and pixel maps: the formats P2, P3, P5 and P6 of Netpbm.
//!
//! Their header is four numbers, of which the last, the largest grey value, gives the bits of the
//! camera; the readers of other crates drop it.

use std::io::{BufRead, Read};

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, StoredCurve, check_room, checked_area,
};

pub(super) fn read(mut reader: impl BufRead) -> Result<Samples, ImageError> {
    let mut magic = [0; 2];
    reader.read_exact(&mut magic)?;
    let (components, binary) = match &magic {
        b"P2" => (Components::Grey, false),
        b"P3" => (Components::Rgb, false),
        b"P5" => (Components::Grey, true),
        b"P6" => (Components::Rgb, true),
        _ => return Err(ImageError::Pnm("it begins with none of P2, P3, P5 and P6")),
    };
    let mut number = || number(&mut reader);
    let (width, height, largest) = (number()?, number()?, number()?);
    let area = checked_area(width.into(), height.into())?;
    let largest = u16::try_from(largest)
        .ok()
        .filter(|&largest| largest > 0)
        .ok_or(ImageError::Pnm(
            "its largest grey value is not from 1 to 65535",
        ))?;
    let length = area * components.names().len();
    check_room(area, 2 * components.names().len() + BYTES_PER_PIXEL)?;
    let values = if binary {
        binary_values(&mut reader, length, largest)?
    } else {
        let mut values = Vec::new();
        for _ in 0..length {
            values.push(u16::try_from(number()?).unwrap_or(u16::MAX));
        }
        values
    };
    if values.iter().any(|&value| value > largest) {
        return Err(ImageError::Pnm(
            "a grey value is above the largest it states",
        ));
    }
    Ok(Samples {
        width: width as usize,
        height: height as usize,
        components,
        values,
        bit_depth: u16::BITS - largest.leading_zeros(),
        curve: StoredCurve::Unknown,
        remark: ", as the file says",
        has_further_images: false,
    })
}

/// Reads values of one byte, or of two with the higher one first.
fn binary_values(
    reader: &mut impl Read,
    length: usize,
    largest: u16,
) -> Result<Vec<u16>, ImageError> {
    let width = if largest > u8::MAX.into() { 2 } else { 1 };
    // The memory grows with what the file holds, not with what it says.
    let mut data = Vec::new();
    reader
        .take((length * width) as u64)
        .read_to_end(&mut data)?;
    if data.len() != length * width {
        return Err(ImageError::Pnm("it ends before its last pixel"));
    }
    let value = |bytes: &[u8]| {
        bytes
            .iter()
            .fold(0, |sum, &byte| sum << 8 | u16::from(byte))
    };
    Ok(data.chunks_exact(width).map(value).collect())
}

/// Reads a decimal number and the character behind it; comments run from `#` to the end of the line.
fn number(reader: &mut impl BufRead) -> Result<u32, ImageError> {
    let mut digits = None;
    let mut comment = false;
    for byte in reader.bytes() {
        match byte? {
            b'\n' | b'\r' if comment => comment = false,
            _ if comment => (),
            b'#' if digits.is_none() => comment = true,
            byte @ b'0'..=b'9' => {
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
    digits.ok_or(ImageError::Pnm("it ends before its last pixel"))
}
