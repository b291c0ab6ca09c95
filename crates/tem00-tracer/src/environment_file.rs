mod open_exr;
mod pfm;

use core::{error, fmt};
use std::path::{Path, PathBuf};

use tem00_camera::MAXIMUM_PIXELS;
use tem00_numerics::Grid;

use crate::input_file::{MAX_ASSET_BYTES, read_input};

/// The parts of red, green and blue in the luminance, for the primaries of Rec. 709.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Reads a map of radiance, for an [`Environment`](crate::Environment), from an OpenEXR or PFM file.
///
/// The extension of the file name, in any case, says which. Of colours the luminance is taken: the
/// channels R, G and B by the weights of Rec. 709, or the only channel there is. Of an OpenEXR file
/// with several parts the first is read. The values are multiplied by `scale`, the radiance of the
/// file's unit in W/(m² sr).
///
/// # Errors
///
/// Returns an error that names the file if the scale is not positive and finite, the extension is
/// none of the two, the file cannot be read or breaks its format, or has channels of another kind
/// or more than 2²⁸ pixels. Whether all values are possible radiances is checked by
/// [`Environment::from_radiance`](crate::Environment::from_radiance).
///
/// # Examples
///
/// ```
/// use std::path::Path;
/// use tem00_tracer::read_radiance_map;
///
/// let error = read_radiance_map(Path::new("skies/noon.jpg"), 1.0).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     r#"skies/noon.jpg: format of a radiance map must be .exr or .pfm, got ".jpg""#
/// );
/// ```
pub fn read_radiance_map(path: &Path, scale: f64) -> Result<Grid<f32>, RadianceMapError> {
    read(path, scale).map_err(|source| RadianceMapError::File {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "maps are stored in single precision"
)]
fn read(path: &Path, scale: f64) -> Result<Grid<f32>, RadianceMapError> {
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(RadianceMapError::Scale(scale));
    }
    let extension = path
        .extension()
        .map(|extension| extension.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    let parse = match extension.as_str() {
        "exr" => open_exr::parse,
        "pfm" => pfm::parse,
        "" => return Err(RadianceMapError::Extension(String::new())),
        other => return Err(RadianceMapError::Extension(format!(".{other}"))),
    };
    let content = read_input(path, MAX_ASSET_BYTES)
        .map_err(|error| RadianceMapError::Read(error.to_string()))?;
    Ok(parse(&content)?.map(|value| (f64::from(*value) * scale) as f32))
}

/// Why a map of radiance could not be read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RadianceMapError {
    /// The file at this path has the error below.
    File {
        /// The path of the file.
        path: PathBuf,
        /// What is wrong.
        source: Box<Self>,
    },
    /// The scale is not positive and finite.
    Scale(f64),
    /// The extension of the file name, with its dot, is of no known format.
    Extension(String),
    /// The file cannot be read, for the reason given by the operating system.
    Read(String),
    /// The content breaks the rules of its format.
    Format(String),
    /// The map has no pixels or more than 2²⁸.
    Size {
        /// The number of columns.
        width: u64,
        /// The number of rows.
        height: u64,
    },
    /// The channels, with these names, are neither R, G and B nor a single one.
    Channels(Vec<String>),
}

impl fmt::Display for RadianceMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, source } => write!(f, "{}: {source}", path.display()),
            Self::Scale(scale) => {
                write!(
                    f,
                    "scale of a radiance map must be positive and finite, got {scale}"
                )
            }
            Self::Extension(extension) => write!(
                f,
                "format of a radiance map must be .exr or .pfm, got {extension:?}"
            ),
            Self::Read(reason) => write!(f, "cannot be read: {reason}"),
            Self::Format(reason) => write!(f, "not a valid file: {reason}"),
            Self::Size { width, height } => write!(
                f,
                "a radiance map must have at least 1 × 1 and at most {MAXIMUM_PIXELS} pixels in \
                 all, got {width} × {height}"
            ),
            Self::Channels(names) => write!(
                f,
                "a radiance map must have the channels R, G and B or a single one, got {}",
                names.join(", ")
            ),
        }
    }
}

impl error::Error for RadianceMapError {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::File { source, .. } => Some(source),
            _ => None,
        }
    }
}

/// Returns the width and the height of a map, if it may be read.
fn checked_size(width: u64, height: u64) -> Result<(usize, usize), RadianceMapError> {
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
fn luminance(channels: &[f32]) -> f32 {
    match channels {
        [red, green, blue] => LUMINANCE[0] * red + LUMINANCE[1] * green + LUMINANCE[2] * blue,
        [grey, ..] => *grey,
        [] => 0.0,
    }
}

#[cfg(test)]
mod tests;
