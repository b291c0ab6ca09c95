use std::io::{Seek, Write};

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, ImageAttributes,
    IntegerBounds, LayerAttributes, Text, Vec2, WritableImage,
};
use tem00_numerics::Grid;

use super::common::ImageError;

/// Named channels of the same size, stored as one part of an OpenEXR file.
#[derive(Debug)]
pub struct Layer<'a> {
    /// The name of the layer; unique within the file.
    pub name: String,
    /// The wavelength of the light in metres, if it has only one. Stored as `wavelength_m`.
    ///
    /// This is the only attribute of its kind: the order of several would change from run to run,
    /// and with it the bytes of the file.
    pub wavelength: Option<f64>,
    /// A description of the layer. Stored as the standard attribute `comments`.
    ///
    /// Readers disagree on the encoding of characters other than ASCII: these become `?`.
    pub comments: String,
    /// The channels by name.
    pub channels: Vec<(&'static str, &'a Grid<f32>)>,
}

/// The position of layers in an image of which they are a part: in OpenEXR the data window in the
/// display window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The column and the row of the first pixel.
    pub origin: [usize; 2],
    /// The size of the whole image.
    pub image: [usize; 2],
}

/// Writes layers of 32-bit floating-point channels, which are the whole image unless a window says
/// otherwise.
///
/// # Panics
///
/// Panics unless all channels have the same size.
pub fn write_exr(
    writer: impl Write + Seek,
    layers: &[Layer<'_>],
    window: Option<Window>,
) -> Result<(), ImageError> {
    let Some((_, first)) = layers.first().and_then(|layer| layer.channels.first()) else {
        return Err(ImageError::Size {
            width: 0,
            height: 0,
        });
    };
    let size = (first.width(), first.height());
    let window = window.unwrap_or(Window {
        origin: [0, 0],
        image: [size.0, size.1],
    });
    let [x, y] = window.origin.map(saturated);
    let position = Vec2(x, y);
    let part = |layer| {
        let mut part = part(layer, size);
        part.attributes.layer_position = position;
        part
    };
    let parts: Vec<_> = layers.iter().map(part).collect();
    let [width, height] = window.image;
    let display = IntegerBounds::new(Vec2(0, 0), Vec2(width, height));
    let image = Image::from_layers(ImageAttributes::new(display), parts);
    Ok(image.write().to_buffered(writer)?)
}

fn part(layer: &Layer<'_>, size: (usize, usize)) -> exr::prelude::Layer<AnyChannels<FlatSamples>> {
    let mut attributes = LayerAttributes::named(&*layer.name);
    attributes.comments = Some(Text::from(&*ascii(&layer.comments)));
    attributes.software_name = Some(Text::from(concat!("tem00 ", env!("CARGO_PKG_VERSION"))));
    if let Some(wavelength) = layer.wavelength {
        let value = AttributeValue::F64(wavelength);
        attributes.other.insert(Text::from("wavelength_m"), value);
    }
    let channels = layer.channels.iter().map(|&(name, values)| {
        assert_eq!(
            (values.width(), values.height()),
            size,
            "the channel {name} has the size of the others"
        );
        AnyChannel::new(name, FlatSamples::F32(values.values().to_vec()))
    });
    // Scan lines in increasing order: the bytes do not depend on the threads that compress them.
    exr::prelude::Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    )
}

/// Image coordinates are far below what this type holds.
fn saturated(pixels: usize) -> i32 {
    i32::try_from(pixels).unwrap_or(i32::MAX)
}

fn ascii(text: &str) -> String {
    let printable = |character: char| character.is_ascii().then_some(character);
    text.chars().map(|c| printable(c).unwrap_or('?')).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use std::io::Cursor;

    use exr::prelude::MetaData;

    use super::*;

    pub(in crate::image) fn example() -> [Grid<f32>; 3] {
        // Speckle spans many orders of magnitude, hence the powers.
        [1, 2, 3].map(|k| Grid::from_fn(7, 5, |x, y| (0.1 * (x + 7 * y * k) as f32).exp()))
    }

    /// A file of the program: a part of a larger image.
    pub(in crate::image) fn written([red, green, blue]: &[Grid<f32>; 3]) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        let layer = |name: &str, wavelength, comments: &str, channels| Layer {
            name: name.into(),
            wavelength,
            comments: comments.into(),
            channels,
        };
        let [of_all, of_one] = [
            vec![("R", red), ("G", green), ("B", blue)],
            vec![("speckle", green), ("incoherent", blue)],
        ];
        let layers = [
            layer("total", None, "linear sRGB", of_all),
            layer("laser 0", Some(650e-9), "λ", of_one),
        ];
        let window = Window {
            origin: [10, 20],
            image: [64, 48],
        };
        write_exr(&mut file, &layers, Some(window)).expect("written");
        file.into_inner()
    }

    #[test]
    fn a_part_knows_its_place_in_the_image_and_its_light() {
        let file = written(&example());
        let meta = MetaData::read_from_buffered(&file[..], true).expect("an EXR header");
        for header in &meta.headers {
            let display = header.shared_attributes.display_window;
            assert_eq!(display, IntegerBounds::new(Vec2(0, 0), Vec2(64, 48)));
            assert_eq!(header.own_attributes.layer_position, Vec2(10, 20));
            assert_eq!(header.layer_size, Vec2(7, 5));
        }
        let [total, laser] = [0, 1].map(|layer| &meta.headers[layer].own_attributes);
        assert!(total.other.is_empty(), "no wavelength");
        assert_eq!(laser.comments, Some(Text::from("?")));
        assert_eq!(laser.layer_name, Some(Text::from("laser 0")));
        let wavelength = laser.other.get(&Text::from("wavelength_m"));
        assert_eq!(wavelength, Some(&AttributeValue::F64(650e-9)));
    }

    #[test]
    fn the_bytes_are_the_same_every_time() {
        let grids = example();
        let file = written(&grids);
        assert!((0..8).all(|_| written(&grids) == file), "the bytes differ");
    }
}
