//! Portable grey and pixel maps: the formats P2, P3, P5 and P6 of Netpbm.

use super::{
    BYTES_PER_PIXEL, Components, ImageError, Samples, check_length, check_room, checked_area,
};

pub(super) fn read(file: Vec<u8>) -> Result<Samples, ImageError> {
    let (components, is_binary) = match file.get(..2) {
        Some(b"P2") => (Components::Grey, false),
        Some(b"P3") => (Components::Rgb, false),
        Some(b"P5") => (Components::Grey, true),
        Some(b"P6") => (Components::Rgb, true),
        _ => return Err(ImageError::Pnm("it begins with none of P2, P3, P5 and P6")),
    };
    let mut rest = &file[2..];
    let wrong = ImageError::Pnm("its header must hold width, height and the largest value");
    let (Some(width), Some(height), Some(largest @ 1..=0xffff)) =
        (number(&mut rest), number(&mut rest), number(&mut rest))
    else {
        return Err(wrong);
    };
    let area = checked_area(width.into(), height.into())?;
    check_length([width, height].map(u64::from), file.len() as u64, 1)?;
    check_room(area, 6 * components.names().len() + BYTES_PER_PIXEL)?;
    let count = area * components.names().len();
    let (values, behind) = if is_binary {
        binary(&file, rest, largest, count)?
    } else {
        let values = (0..count).map_while(|_| number(&mut rest)).collect();
        (values, rest.trim_ascii())
    };
    if values.len() < count || values.iter().any(|&value| value > largest) {
        return Err(ImageError::Pnm(
            "it has fewer values, or larger ones, than its header says",
        ));
    }
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
            values.into_iter().map(|value| value as f32).collect(),
            Some(u32::BITS - largest.leading_zeros()),
        )
    })
}

/// Takes the next number of a header or a text, behind white space and comments.
fn number(rest: &mut &[u8]) -> Option<u32> {
    *rest = rest.trim_ascii_start();
    while rest.starts_with(b"#") {
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        *rest = rest[end?..].trim_ascii_start();
    }
    let end = rest.iter().position(|byte| !byte.is_ascii_digit());
    let (digits, behind) = rest.split_at(end.unwrap_or(rest.len()));
    *rest = behind;
    str::from_utf8(digits).ok()?.parse().ok()
}

/// Returns the values of one or two bytes, and the content behind them.
///
/// One white space ends the header. On Windows it may be two characters, as the other lines of the
/// header show or, if it has only one line, the length of the file.
fn binary<'a>(
    file: &[u8],
    rest: &'a [u8],
    largest: u32,
    count: usize,
) -> Result<(Vec<u32>, &'a [u8]), ImageError> {
    let needed = count * if largest > 0xff { 2 } else { 1 };
    let header = &file[..file.len() - rest.len()];
    let is_windows = header.windows(2).any(|pair| pair == b"\r\n") || rest.len() == needed + 2;
    let end = if is_windows && rest.starts_with(b"\r\n") {
        2
    } else {
        1
    };
    if !rest.first().is_some_and(u8::is_ascii_whitespace) || rest.len() < end + needed {
        return Err(ImageError::Pnm("its header or its last pixels are cut off"));
    }
    let (pixels, behind) = rest[end..].split_at(needed);
    let values = if largest > 0xff {
        let (pairs, _) = pixels.as_chunks::<2>();
        pairs
            .iter()
            .map(|&pair| u16::from_be_bytes(pair).into())
            .collect()
    } else {
        pixels.iter().map(|&byte| byte.into()).collect()
    };
    Ok((values, behind))
}
