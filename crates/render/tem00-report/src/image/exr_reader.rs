use std::io::{BufRead, Seek, SeekFrom};

use exr::{
    compression::Compression,
    meta::header::Header,
    prelude::{AnyChannel, AnyChannels, FlatSamples, ReadChannels, ReadLayers},
};

use super::{
    common::{ImageError, MAX_DEFLATION, check_length, check_room, checked_area},
    raw_file::{BYTES_PER_PIXEL, Samples},
    selection::Components,
};

/// Words in the names of channels and layers that show no light: opacity, distance, identifiers,
/// geometry.
const NO_LIGHT: &str = "a alpha ra ga ba ar ag ab opacity \
    z zback depth id objectid materialid normal normals position motion uv";

/// Reads one channel, or the mean of R, G and B.
///
/// `channel` is `channel` or `layer.channel`. Without it the channels of light are looked for: Y,
/// or else R, G and B, or else the only channel that may be light; in the first part without its
/// layers, or else in the only layer that has any.
pub(super) fn read(
    mut reader: impl BufRead + Seek,
    channel: Option<&str>,
) -> Result<Samples, ImageError> {
    let length = reader.seek(SeekFrom::End(0))?;
    reader.rewind()?;
    let (mut pixels, mut bytes) = (0_usize, 0_usize);
    let chunks = exr::block::read(reader, false)?;
    for header in chunks.headers() {
        let (area, of_pixel) = checked_size(header, length)?;
        pixels = pixels.max(area);
        bytes = bytes.saturating_add(area.saturating_mul(of_pixel));
    }
    // All channels of all layers are read, and three of them are put together.
    let chosen = 3 * size_of::<f32>() + BYTES_PER_PIXEL;
    check_room(bytes, 1).and_then(|()| check_room(pixels, chosen))?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_chunks(chunks)?;
    let layers = image.layer_data.iter().enumerate();
    let channels: Vec<_> = layers.flat_map(channels_of).collect();
    Ok(samples(&select(&channels, channel)?))
}

/// Returns the number of pixels of a part and the bytes of one, if the file is long enough for
/// them.
fn checked_size(header: &Header, length: u64) -> Result<(usize, usize), ImageError> {
    let [width, height] = [header.layer_size.width(), header.layer_size.height()];
    let size = [width as u64, height as u64];
    let area = checked_area(size[0], size[1])?;
    let channels = header.channels.list.iter();
    let of_pixel: usize = channels.map(|c| c.sample_type.bytes_per_sample()).sum();
    // The other compressions may put whole blocks of one value into a few bytes.
    let expansion = match header.compression {
        Compression::Uncompressed => 1,
        Compression::RLE | Compression::ZIP1 | Compression::ZIP16 => MAX_DEFLATION,
        _ => u64::MAX,
    };
    check_length(size, length, expansion / (of_pixel as u64).max(1))?;
    Ok((area, of_pixel))
}

/// Returns the chosen channels as samples, pixel by pixel.
fn samples(Chosen { channels, name }: &Chosen<'_, '_>) -> Samples {
    let (width, height) = channels[0].size;
    let components = if channels.len() == 3 {
        Components::Rgb
    } else {
        Components::Grey
    };
    let mut values = vec![0.0; width * height * channels.len()];
    for (index, channel) in channels.iter().enumerate() {
        let places = values.iter_mut().skip(index).step_by(channels.len());
        for (place, value) in places.zip(channel.samples.values_as_f32()) {
            *place = value;
        }
    }
    Samples::of_light([width, height], components, values, name.clone())
}

/// The channels that are read, and their description.
struct Chosen<'a, 'b> {
    channels: Vec<&'b NamedChannel<'a>>,
    name: String,
}

/// A channel of a file that was read.
struct NamedChannel<'a> {
    /// The index and the name of the part of the file.
    part: (usize, String),
    /// The name in the part, with the names of its layers.
    name: String,
    size: (usize, usize),
    is_identifier: bool,
    samples: &'a FlatSamples,
}

impl NamedChannel<'_> {
    fn full_name(&self) -> String {
        let part = &self.part.1;
        if part.is_empty() {
            self.name.clone()
        } else {
            format!("{part}.{}", self.name)
        }
    }

    /// The part of the file and the names of the layers in it.
    fn layer(&self) -> (usize, &str) {
        let layer = self.name.rsplit_once('.');
        (self.part.0, layer.map_or("", |(layer, _)| layer))
    }

    /// The last name, in lower case.
    fn base(&self) -> String {
        let base = self.name.rsplit('.').next().unwrap_or_default();
        base.to_lowercase()
    }

    fn may_be_light(&self) -> bool {
        let full = self.full_name().to_lowercase();
        let mut words = full.split('.');
        let is_known = |word: &str| NO_LIGHT.split(' ').any(|known| known == word);
        let no_light = |word: &str| is_known(word) || word.starts_with("crypto");
        !self.is_identifier && !words.any(no_light)
    }
}

fn channels_of(
    (index, layer): (usize, &exr::prelude::Layer<AnyChannels<FlatSamples>>),
) -> Vec<NamedChannel<'_>> {
    let name = layer.attributes.layer_name.as_ref();
    let name = name.map_or_else(String::new, ToString::to_string);
    let named = |channel| {
        let channel: &AnyChannel<FlatSamples> = channel;
        NamedChannel {
            part: (index, name.clone()),
            name: channel.name.to_string(),
            size: (layer.size.width(), layer.size.height()),
            is_identifier: matches!(channel.sample_data, FlatSamples::U32(_)),
            samples: &channel.sample_data,
        }
    };
    layer.channel_data.list.iter().map(named).collect()
}

fn select<'a, 'b>(
    channels: &'b [NamedChannel<'a>],
    wanted: Option<&str>,
) -> Result<Chosen<'a, 'b>, ImageError> {
    let available = || channels.iter().map(NamedChannel::full_name).collect();
    if let Some(wanted) = wanted {
        let matches = |channel: &&NamedChannel<'_>| channel.full_name() == wanted;
        let by_full_name = channels.iter().find(matches);
        return by_full_name
            .or_else(|| channels.iter().find(|channel| channel.name == wanted))
            .map(one)
            .ok_or_else(|| ImageError::Channel {
                wanted: wanted.to_owned(),
                available: available(),
            });
    }
    let mut layers: Vec<_> = channels.iter().map(NamedChannel::layer).collect();
    layers.dedup();
    layers.sort_unstable();
    layers.dedup();
    let mut found: Vec<_> = layers
        .iter()
        .filter_map(|&layer| Some((layer, light_of(channels, layer)?)))
        .collect();
    // Readers of one part read the first, and its channels without a layer.
    let shown = found.iter().position(|&(layer, _)| layer == (0, ""));
    match (shown, found.len()) {
        (Some(index), _) => Ok(found.swap_remove(index).1),
        (None, 1) => Ok(found.swap_remove(0).1),
        _ => Err(ImageError::NoChannel(available())),
    }
}

fn one<'a, 'b>(channel: &'b NamedChannel<'a>) -> Chosen<'a, 'b> {
    Chosen {
        channels: vec![channel],
        name: format!("channel {}", channel.full_name()),
    }
}

/// Returns the light of a layer, if it is clear which of its channels hold light.
fn light_of<'a, 'b>(
    channels: &'b [NamedChannel<'a>],
    layer: (usize, &str),
) -> Option<Chosen<'a, 'b>> {
    let all = || channels.iter().filter(|channel| channel.layer() == layer);
    let light = || all().filter(|channel| channel.may_be_light());
    let named = |names: [&str; 2]| light().find(|channel| names.contains(&&*channel.base()));
    // X, Y and Z are a direction, a position or colours.
    let is_vector = all().any(|channel| channel.base() == "x");
    if let Some(grey) = named(["y", "luminance"]).filter(|_| !is_vector) {
        return Some(one(grey));
    }
    let [red, green, blue] = [["r", "red"], ["g", "green"], ["b", "blue"]].map(named);
    if let (Some(red), Some(green), Some(blue)) = (red, green, blue) {
        let full = red.full_name();
        let of = full
            .rsplit_once('.')
            .map_or_else(String::new, |(layer, _)| format!(" of {layer}"));
        return Some(Chosen {
            channels: vec![red, green, blue],
            name: format!("mean of R, G and B{of}"),
        });
    }
    let mut light = light().filter(|_| !is_vector);
    let only = light.next()?;
    light.next().is_none().then(|| one(only))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::prelude::{
        Encoding, Image, ImageAttributes, IntegerBounds, LayerAttributes, WritableImage,
    };
    use tem00_testkit::rows;

    use super::*;
    use crate::image::{
        LoadedImage, Reading,
        exr_file::tests::{example, written},
    };

    fn read_light(file: &[u8], channel: Option<&str>) -> Result<LoadedImage, ImageError> {
        let samples = read(Cursor::new(file), channel)?;
        samples.judged(None)?.light(&Reading::default())
    }

    /// A file of parts, with `/` between them, with channels of two pixels behind their names and
    /// colons; identifiers have `#` before their names.
    fn parts(text: &str) -> Vec<u8> {
        let channel = |(index, name): (usize, &str)| match name.strip_prefix('#') {
            Some(name) => AnyChannel::new(name, FlatSamples::U32(vec![7, 8])),
            None => AnyChannel::new(name, FlatSamples::F32(vec![1.0 + index as f32; 2])),
        };
        let part = |text: &str| {
            let (name, channels) = text.split_once(':').expect("a name");
            let channels = channels.split_whitespace().enumerate().map(channel);
            let attributes = LayerAttributes {
                layer_name: (!name.trim().is_empty()).then(|| name.trim().into()),
                ..LayerAttributes::default()
            };
            let channels = AnyChannels::sort(channels.collect());
            exr::prelude::Layer::new((2, 1), attributes, Encoding::SMALL_LOSSLESS, channels)
        };
        let display = ImageAttributes::new(IntegerBounds::from_dimensions((2, 1)));
        let image = Image::from_layers(display, text.split('/').map(part).collect::<Vec<_>>());
        let mut file = Cursor::new(Vec::new());
        image.write().to_buffered(&mut file).expect("written");
        file.into_inner()
    }

    #[test]
    fn light_is_chosen_and_never_alpha_depth_or_an_identifier() {
        // Layers without a name come first, then the only one with light; so do parts. What is not
        // plain is asked for.
        let table = "
            :A Y => channel Y
            :A B G R Z => mean of R, G and B
            :Y RY BY => channel Y
            :A depth #id intensity => channel intensity
            :Z #object A b g r => mean of R, G and B
            :R G B spot.R spot.G spot.B => mean of R, G and B
            :A Z spot.R spot.G spot.B => mean of R, G and B of spot
            :N.X N.Y N.Z spot.Y crypto00.R => channel spot.Y
            left:Y / right:Y => channel left.Y
            depth:Z / beauty:Y A => channel beauty.Y
            :real imaginary => by --channel: imaginary, real
            :A => by --channel: A
            :X Y Z => by --channel: X, Y, Z
            :up.Y down.Y => by --channel: down.Y, up.Y";
        for [content, expected] in rows(table) {
            let told = match read_light(&parts(&content), None) {
                Ok(image) => image.interpretation,
                Err(error) => error.to_string(),
            };
            assert!(told.contains(&expected), "{content}: {told}");
            let is_whole = told.len() == expected.len()
                || told.contains("--channel")
                || told.contains("differ");
            assert!(is_whole, "{content}: {told}");
        }
        // Any channel is read by its name.
        let alpha = read_light(&parts(":A Y"), Some("A")).expect("there is one");
        assert_eq!(alpha.interpretation, "channel A");
    }

    #[test]
    fn every_channel_survives_bit_by_bit() {
        let grids = example();
        let file = written(&grids);
        for (name, grid) in ["total.R", "laser 0.speckle", "incoherent"]
            .iter()
            .zip(&grids)
        {
            let found = read_light(&file, Some(name)).expect("an EXR file");
            assert_eq!(found.values, *grid);
        }
        let error = read_light(&file, Some("spekle")).expect_err("there is none");
        assert!(error.to_string().contains("laser 0.speckle"), "{error}");
        for length in [0, 8, 100, file.len() - 10] {
            assert!(read_light(&file[..length], None).is_err(), "{length} bytes");
        }
    }

    #[test]
    fn without_a_name_the_mean_of_the_colours_is_taken() {
        let grids = example();
        let image = read_light(&written(&grids), None).expect("an EXR file");
        let told = &image.interpretation;
        let expected = "mean of R, G and B of total, which differ";
        assert!(told.starts_with(expected), "{told}");
        for (index, got) in image.values.values().iter().enumerate() {
            let values = grids.iter().map(|grid| f64::from(grid.values()[index]));
            let mean = values.sum::<f64>() / 3.0;
            // One rounding of 2⁻²⁴.
            assert!(
                (f64::from(*got) / mean - 1.0).abs() < 6e-8,
                "{got} is {mean}"
            );
        }
    }
}
