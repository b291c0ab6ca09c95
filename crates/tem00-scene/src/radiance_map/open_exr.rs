use std::io::Cursor;

use exr::prelude::{FlatSamples, MetaData, ReadChannels, ReadLayers};
use tem00_numerics::{Grid, check_memory};

use super::{
    content::{checked_size, luminance},
    error::RadianceMapError,
};

/// Reads the first part of an OpenEXR file.
pub(super) fn parse(content: &[u8]) -> Result<Grid<f32>, RadianceMapError> {
    // The header says how much will be allocated.
    let meta =
        MetaData::read_from_buffered(content, false).map_err(|error| format_error(&error))?;
    for header in &meta.headers {
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
        .from_buffered(Cursor::new(content))
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
    let (width, height) = (layer.size.width(), layer.size.height());
    let mut columns: Vec<_> = chosen
        .iter()
        .map(|samples| samples.values_as_f32())
        .collect();
    let values = (0..width * height).map(|_| {
        let pixel: Vec<f32> = columns.iter_mut().filter_map(Iterator::next).collect();
        luminance(&pixel)
    });
    Grid::from_vec(width, height, values.collect())
        .map_err(|error| RadianceMapError::Format(error.to_string()))
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
