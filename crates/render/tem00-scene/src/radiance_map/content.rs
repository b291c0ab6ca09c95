use tem00_camera::MAXIMUM_PIXELS;

use super::error::RadianceMapError;

/// The fractions of red, green and blue in the luminance, for the primaries of Rec. 709.
pub(super) const REC_709: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Returns the width and the height of a map, if it may be read.
pub(super) fn checked_size(width: u64, height: u64) -> Result<(usize, usize), RadianceMapError> {
    let pixels = width.checked_mul(height);
    let counts = (usize::try_from(width), usize::try_from(height));
    match (pixels, counts) {
        (Some(pixels @ 1..), (Ok(columns), Ok(rows))) if pixels <= MAXIMUM_PIXELS as u64 => {
            Ok((columns, rows))
        }
        _ => Err(RadianceMapError::Size { width, height }),
    }
}

/// Returns the luminance of a pixel from one value or three, by the fractions of red, green and
/// blue in it.
pub(super) fn luminance(channels: &[f32], parts: [f32; 3]) -> f32 {
    match channels {
        [red, green, blue] => parts[0] * red + parts[1] * green + parts[2] * blue,
        [grey, ..] => *grey,
        [] => 0.0,
    }
}
