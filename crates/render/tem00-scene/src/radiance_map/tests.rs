use std::fs;

use exr::{
    meta::attribute::Chromaticities,
    prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer,
        LayerAttributes, Vec2, WritableImage,
    },
};
use tem00_testkit::robust;

use super::*;

/// Writes a file under a temporary folder and reads it.
fn read_file(name: &str, content: &[u8], scale: f64) -> Result<Grid<f32>, RadianceMapError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    match read_radiance_map(&path, scale) {
        Err(RadianceMapError::File {
            path: named,
            source,
        }) => {
            assert_eq!(named, path, "the error names the file");
            Err(*source)
        }
        other => other,
    }
}

fn exr_file(channels: &[(&str, [f32; 6])]) -> Vec<u8> {
    exr_file_in(channels, None)
}

/// Writes an OpenEXR file that states its colours: red, green, blue and white.
fn exr_file_in(channels: &[(&str, [f32; 6])], colours: Option<[[f32; 2]; 4]>) -> Vec<u8> {
    let channel = |(name, values): &(&str, [f32; 6])| {
        AnyChannel::new(*name, FlatSamples::F32(values.to_vec()))
    };
    let list = channels.iter().map(channel);
    let layer = Layer::new(
        (3, 2),
        LayerAttributes::named("sky"),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.collect()),
    );
    let mut attributes = ImageAttributes::with_size((3, 2));
    attributes.chromaticities = colours.map(|colours| {
        let [red, green, blue, white] = colours.map(|[x, y]| Vec2(x, y));
        Chromaticities {
            red,
            green,
            blue,
            white,
        }
    });
    let image = Image::from_layers(attributes, vec![layer]);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

const RED: [f32; 6] = [1.0, 0.0, 0.0, 2.0, 0.0, 4.0];
const GREEN: [f32; 6] = [0.0, 1.0, 0.0, 3.0, 0.0, 4.0];
const BLUE: [f32; 6] = [0.0, 0.0, 1.0, 5.0, 0.0, 4.0];
/// 0.2126 R + 0.7152 G + 0.0722 B, by hand.
const GREY: [f32; 6] = [0.2126, 0.7152, 0.0722, 2.9318, 0.0, 4.0];

fn assert_close(got: &Grid<f32>, expected: &[f32]) {
    assert_eq!((got.width(), got.height()), (3, 2), "size");
    for (got, expected) in got.values().iter().zip(expected) {
        // Three roundings of single precision.
        assert!(
            (got - expected).abs() <= 3e-7 * expected,
            "{got}, not {expected}"
        );
    }
}

#[test]
fn colours_of_open_exr_become_luminance() {
    let alpha = [0.5; 6];
    let file = exr_file(&[("B", BLUE), ("A", alpha), ("R", RED), ("G", GREEN)]);
    assert_close(&read_file("sky.EXR", &file, 1.0).unwrap(), &GREY);
    let single = exr_file(&[("Y", RED)]);
    let doubled = RED.map(|value| 2.0 * value);
    assert_close(&read_file("sky.exr", &single, 2.0).unwrap(), &doubled);
}

#[test]
fn colours_are_those_that_the_file_states() {
    const D65: [f32; 2] = [0.3127, 0.329];
    const ACES: [f32; 2] = [0.32168, 0.33767];
    const XYZ: [[f32; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0; 2]];
    let written = |colours| {
        let file = exr_file_in(&[("R", RED), ("G", GREEN), ("B", BLUE)], Some(colours));
        read_file("sky.exr", &file, 1.0)
    };
    for (colours, parts, tolerance) in [
        // By definition: the second channel is the luminance.
        (XYZ, [0.0, 1.0, 0.0], 1e-6),
        // ITU-R BT.2020-2, table 4, rounded there.
        (
            [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], D65],
            [0.2627, 0.678, 0.0593],
            5.1e-5,
        ),
        // SMPTE ST 2065-1, the matrix to XYZ of AP0, whose blue lies outside of all colours.
        (
            [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], ACES],
            [0.343_966_45, 0.728_166_1, -0.072_132_54],
            1e-6,
        ),
        // S-2014-004, the matrix of AP1.
        (
            [[0.713, 0.293], [0.165, 0.83], [0.128, 0.044], ACES],
            [0.272_228_72, 0.674_081_77, 0.053_689_517],
            1e-6,
        ),
        // Green and red the other way around, which is as good.
        (
            [[0.3, 0.6], [0.64, 0.33], [0.15, 0.06], D65],
            [0.7152, 0.2126, 0.0722],
            5e-5,
        ),
    ] {
        let map = written(colours).unwrap();
        for (got, expected) in map.values().iter().zip(parts) {
            let is_near = (got - expected).abs() <= tolerance;
            assert!(is_near, "{got}, not {expected}: {colours:?}");
        }
        let white = map.values()[5];
        assert!((white - 4.0).abs() < 1e-5, "{white} stays: {colours:?}");
    }
    let rec_709 = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], D65];
    assert_close(&written(rec_709).unwrap(), &GREY);
    // A single channel is not converted.
    let grey = exr_file_in(&[("Y", RED)], Some(XYZ));
    assert_close(&read_file("sky.exr", &grey, 1.0).unwrap(), &RED);
    for colours in [
        [[0.0; 2]; 4],
        [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.9, 0.9]],
        [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3], [0.2, 0.2]],
        [[f32::NAN, 0.33], [0.3, 0.6], [0.15, 0.06], D65],
        [[1.0, -1.0], [0.0, -1.0], [0.5, -0.5], [0.5, -0.8]],
    ] {
        let error = written(colours).unwrap_err().to_string();
        let [red, _, _, white] = colours.map(|[x, y]| format!("({x}, {y})"));
        let named = error.contains(&format!("got white {white}, red {red}, green "));
        assert!(
            named && error.contains("white inside the triangle"),
            "{error}"
        );
    }
}

#[test]
fn headers_of_portable_float_maps_may_end_as_on_windows_and_the_length_must_fit() {
    // The first byte of the pixels is a line feed, or a carriage return.
    for first in [0x0a, 0x0d, 0x20, 0x00] {
        let grey = f32::from_le_bytes([first, 0, 0x80, 0x3f]);
        let pixels = [grey.to_le_bytes(), 2.0_f32.to_le_bytes()].concat();
        for header in [
            "Pf\n2 1\n-1.0\n",
            "Pf\r\n2 1\r\n-1.0\r\n",
            "Pf\r2 1\r-1.0\r",
            "Pf 2 1 -1 ",
        ] {
            let file = [header.as_bytes(), &pixels].concat();
            let map = read_file("sky.pfm", &file, 1.0).unwrap();
            assert_eq!(map.values(), [grey, 2.0], "{header:?}, {first}");
            for wrong in [&file[..file.len() - 1], &[&file[..], &[0; 2]].concat()] {
                let error = read_file("sky.pfm", wrong, 1.0).unwrap_err().to_string();
                let told = "announces 8 bytes of pixels, but it has";
                assert!(error.contains(told), "{error}");
            }
        }
    }
}

#[test]
fn portable_float_maps_are_read_from_the_lowest_row() {
    let rows = |row: usize| (3 * row..3 * row + 3).flat_map(|i| [RED[i], GREEN[i], BLUE[i]]);
    let colours: Vec<f32> = rows(1).chain(rows(0)).collect();
    let mut little = b"PF\n3 2\n-1.0\n".to_vec();
    little.extend(colours.iter().flat_map(|value| value.to_le_bytes()));
    assert_close(&read_file("sky.pfm", &little, 1.0).unwrap(), &GREY);
    let mut big = b"Pf 3\t2 1\n".to_vec();
    let grey = GREY[3..].iter().chain(&GREY[..3]);
    big.extend(grey.flat_map(|value| value.to_be_bytes()));
    assert_close(&read_file("sky.pfm", &big, 1.0).unwrap(), &GREY);
}

#[test]
fn what_is_no_map_is_refused_with_the_reason() {
    use RadianceMapError as E;
    let file = exr_file(&[("X", RED), ("Y", GREEN)]);
    let names = vec!["X".to_owned(), "Y".to_owned()];
    assert_eq!(read_file("a.exr", &file, 1.0), Err(E::Channels(names)));
    let half = &file[..file.len() / 2];
    let cut = read_file("a.exr", half, 1.0);
    assert!(matches!(cut, Err(E::Format(_))), "{cut:?}");
    for (width, height) in [(0, 2), (65_536, 65_536), (u64::MAX, 2)] {
        let content = format!("Pf {width} {height} 1\n");
        let got = read_file("a.pfm", content.as_bytes(), 1.0);
        assert_eq!(got, Err(E::Size { width, height }), "{content}");
    }
    for content in ["", "P6 1 1 1\n", "PF 1", "PF x 1 1\n", "Pf 1 1 -1\n123"] {
        let got = read_file("a.pfm", content.as_bytes(), 1.0);
        assert!(matches!(got, Err(E::Format(_))), "{content:?}: {got:?}");
    }
    let one = b"Pf 1 1 -1\n\0\0\0\0";
    let unnamed = read_file("a", one, 1.0);
    assert!(matches!(unnamed, Err(E::Extension(_))), "no extension");
    for scale in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        let got = read_file("a.pfm", one, scale);
        assert!(matches!(got, Err(E::Scale(_))), "{scale}");
    }
    let missing = read_radiance_map(Path::new("no/such.pfm"), 1.0).unwrap_err();
    let text = missing.to_string();
    assert!(text.starts_with("no/such.pfm: cannot be read: "), "{text}");
}

#[test]
fn no_bytes_make_the_readers_panic() {
    let file = exr_file(&[("R", RED), ("G", GREEN), ("B", BLUE)]);
    robust(|bytes| drop(open_exr::parse(bytes)), &[&file]);
    let file = [b"PF 3 2 -1.0\n".as_slice(), &[1; 72]].concat();
    robust(|bytes| drop(pfm::parse(bytes)), &[&file]);
}
