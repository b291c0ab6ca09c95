use tem00_numerics::Grid;

use super::{
    content::{REC_709, checked_size, luminance},
    error::RadianceMapError,
};

/// Reads a portable float map: a text header of four words, then the rows from the lowest up.
pub(super) fn parse(content: &[u8]) -> Result<Grid<f32>, RadianceMapError> {
    let mut rest = content;
    let channels = match word(&mut rest) {
        b"PF" => 3,
        b"Pf" => 1,
        _ => return Err(format_error("it does not begin with PF or Pf")),
    };
    let width = number::<u64>(&mut rest, "the width")?;
    let height = number::<u64>(&mut rest, "the height")?;
    let (width, height) = checked_size(width, height)?;
    let little_endian = number::<f64>(&mut rest, "the byte order")? < 0.0;
    let needed = width * height * channels * size_of::<f32>();
    // One character of white space ends the header, or the two that end a line on Windows: its
    // other lines tell, or the length if it has no other lines.
    let header = &content[..content.len() - rest.len()];
    let is_windows = header.windows(2).any(|pair| pair == b"\r\n") || rest.len() == needed + 2;
    let end = 1 + usize::from(rest.starts_with(b"\r\n") && is_windows);
    let data = rest.get(end..).unwrap_or_default();
    if data.len() != needed {
        let got = data.len();
        let message = format!("its header announces {needed} bytes of pixels, but it has {got}");
        return Err(format_error(message));
    }
    let value = match little_endian {
        true => f32::from_le_bytes,
        false => f32::from_be_bytes,
    };
    let (data, _) = data.as_chunks();
    let values: Vec<f32> = data.iter().map(|bytes| value(*bytes)).collect();
    let pixel = |x: usize, y: usize| {
        let start = ((height - 1 - y) * width + x) * channels;
        luminance(&values[start..start + channels], REC_709)
    };
    Ok(Grid::from_fn(width, height, pixel))
}

/// Takes the next word, which may be empty at the end.
fn word<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let trimmed = rest.trim_ascii_start();
    let end = trimmed.iter().position(u8::is_ascii_whitespace);
    let (word, behind) = trimmed.split_at(end.unwrap_or(trimmed.len()));
    *rest = behind;
    word
}

fn number<T: core::str::FromStr>(rest: &mut &[u8], what: &str) -> Result<T, RadianceMapError> {
    core::str::from_utf8(word(rest))
        .ok()
        .and_then(|word| word.parse().ok())
        .ok_or_else(|| format_error(format!("{what} must be a number")))
}

fn format_error(message: impl Into<String>) -> RadianceMapError {
    RadianceMapError::Format(message.into())
}
