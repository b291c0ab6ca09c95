use tem00_camera::MAXIMUM_PIXELS;

use super::error::RadianceMapError;

/// The parts of red, green and blue in the luminance, for the primaries of Rec. 709.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

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

/// Returns the luminance of each pixel from one or three values of it.
pub(super) fn luminance(channels: &[f32]) -> f32 {
    match channels {
        [red, green, blue] => LUMINANCE[0] * red + LUMINANCE[1] * green + LUMINANCE[2] * blue,
        [grey, ..] => *grey,
        [] => 0.0,
    }
}
