use std::io::Cursor;

use exr::{
    meta::attribute::Chromaticities,
    prelude::{FlatSamples, ReadChannels, ReadLayers, Vec2},
};
use glam::DVec2;
use tem00_numerics::{Grid, cast::to_f32, check_memory};

use super::{
    content::{REC_709, checked_size, luminance},
    error::RadianceMapError,
};

/// Reads the first part of an OpenEXR file.
pub(super) fn parse(content: &[u8]) -> Result<Grid<f32>, RadianceMapError> {
    // The header says how much will be allocated.
    let chunks =
        exr::block::read(Cursor::new(content), false).map_err(|error| format_error(&error))?;
    for header in chunks.headers() {
        let (width, height) = checked_size(
            header.layer_size.width() as u64,
            header.layer_size.height() as u64,
        )?;
        let channels = header.channels.list.len() as u64 + 2;
        check_memory(((width * height) as u64).saturating_mul(4 * channels))
            .map_err(|error| RadianceMapError::Read(error.to_string()))?;
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_chunks(chunks)
        .map_err(|error| format_error(&error))?;
    let layer = image.layer_data;
    let window = image.attributes.display_window;
    if layer.attributes.layer_position != window.position || layer.size != window.size {
        let reason = "a radiance map must fill its display window".to_owned();
        return Err(RadianceMapError::Format(reason));
    }
    let channels: Vec<_> = layer
        .channel_data
        .list
        .iter()
        .map(|channel| (channel.name.to_string(), &channel.sample_data))
        .collect();
    let chosen = select(&channels)?;
    let parts = image.attributes.chromaticities.map_or(Ok(REC_709), parts)?;
    let (width, height) = (layer.size.width(), layer.size.height());
    let mut columns: Vec<_> = chosen
        .iter()
        .map(|samples| samples.values_as_f32())
        .collect();
    let values = (0..width * height).map(|_| {
        let pixel: Vec<f32> = columns.iter_mut().filter_map(Iterator::next).collect();
        luminance(&pixel, parts)
    });
    Grid::from_vec(width, height, values.collect())
        .map_err(|error| RadianceMapError::Format(error.to_string()))
}

/// The primaries and the white point of Rec. 709.
const OF_REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.3, 0.6),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.329),
};

/// Returns the fractions of red, green and blue in the luminance: the fractions of the primaries
/// that together make white, of luminance 1.
///
/// In the chromaticity diagram white is a mean of the primaries, with weights b. A primary of
/// chromaticity (x, y) contributes the luminance `b y / y_white` (CIE 15:2018; SMPTE RP 177).
fn parts(colours: Chromaticities) -> Result<[f32; 3], RadianceMapError> {
    if colours == OF_REC_709 {
        return Ok(REC_709);
    }
    let Chromaticities {
        red,
        green,
        blue,
        white,
    } = colours;
    let [r, g, b, w] = [red, green, blue, white].map(|Vec2(x, y)| DVec2::new(x.into(), y.into()));
    let area = (g - r).perp_dot(b - r);
    let weights = [
        (g - w).perp_dot(b - w) / area,
        (b - w).perp_dot(r - w) / area,
        (r - w).perp_dot(g - w) / area,
    ];
    let is_inside = |weight: &f64| *weight > 0.0 && weight.is_finite();
    if !(weights.iter().all(is_inside) && w.y > 0.0) {
        let [r, g, b, w] = [red, green, blue, white].map(|Vec2(x, y)| format!("({x}, {y})"));
        return Err(RadianceMapError::Format(format!(
            "its chromaticities must have white inside the triangle of red, green and blue, got \
             white {w}, red {r}, green {g} and blue {b}"
        )));
    }
    let [r, g, b] = [r, g, b].map(|primary| primary.y / w.y);
    Ok([weights[0] * r, weights[1] * g, weights[2] * b].map(to_f32))
}

/// Returns R, G and B, in this order, or the only channel.
fn select<'a>(
    channels: &[(String, &'a FlatSamples)],
) -> Result<Vec<&'a FlatSamples>, RadianceMapError> {
    if let [(_, only)] = channels {
        return Ok(vec![*only]);
    }
    let named = |wanted: &str| {
        let mut matching = channels.iter().filter(|(name, _)| name == wanted);
        matching.next().map(|(_, samples)| *samples)
    };
    ["R", "G", "B"]
        .into_iter()
        .map(named)
        .collect::<Option<_>>()
        .ok_or_else(|| {
            RadianceMapError::Channels(channels.iter().map(|(name, _)| name.clone()).collect())
        })
}

fn format_error(error: &exr::error::Error) -> RadianceMapError {
    RadianceMapError::Format(error.to_string())
}
