mod content;
mod error;
mod open_exr;
mod pfm;

use std::path::Path;

use tem00_config::{MAX_ASSET_BYTES, read_input};
use tem00_numerics::{Grid, cast::to_f32};

pub use error::RadianceMapError;

/// Reads a radiance map, for an [`Environment`](tem00_tracer::Environment), from an OpenEXR or PFM
/// file.
///
/// The extension of the file name, in upper or lower case, determines the format. Colours are
/// converted to luminance: the channels R, G and B by the chromaticities that an OpenEXR file
/// states, or else by the chromaticities of Rec. 709; or the only channel there is. In an OpenEXR
/// file with several parts, the first part is read. The values are multiplied by `scale`, the
/// radiance of the file's unit in W/(m² sr).
///
/// # Errors
///
/// Returns an error that names the file if the scale is not positive and finite, the extension is
/// neither of the two, the file cannot be read or breaks its format, or has channels of another
/// kind or more than 2²⁸ pixels. Whether all values are possible radiances is checked by
/// [`Environment::from_radiance`](tem00_tracer::Environment::from_radiance).
///
/// # Examples
///
/// ```
/// use std::path::Path;
/// use tem00_scene::read_radiance_map;
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

fn read(path: &Path, scale: f64) -> Result<Grid<f32>, RadianceMapError> {
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(RadianceMapError::Scale(scale));
    }
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let parse = match extension.to_lowercase().as_str() {
        "exr" => open_exr::parse,
        "pfm" => pfm::parse,
        "" => return Err(RadianceMapError::Extension(String::new())),
        other => return Err(RadianceMapError::Extension(format!(".{other}"))),
    };
    let content = read_input(path, MAX_ASSET_BYTES)
        .map_err(|error| RadianceMapError::Read(error.to_string()))?;
    Ok(parse(&content)?.map(|value| to_f32(f64::from(*value) * scale)))
}

#[cfg(test)]
mod tests;
