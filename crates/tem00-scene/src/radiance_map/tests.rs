use std::fs;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes,
    WritableImage,
};
use proptest::prelude::*;

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
    let list = channels
        .iter()
        .map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.to_vec())));
    let layer = Layer::new(
        (3, 2),
        LayerAttributes::named("sky"),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.collect()),
    );
    let image = Image::from_layers(ImageAttributes::with_size((3, 2)), vec![layer]);
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
    for (content, size) in [
        ("Pf 0 2 1\n", (0, 2)),
        ("PF 65536 65536 1\n", (65536, 65536)),
        (
            "PF 18446744073709551615 2 1\n",
            (18_446_744_073_709_551_615, 2),
        ),
    ] {
        let (width, height) = size;
        let got = read_file("a.pfm", content.as_bytes(), 1.0);
        assert_eq!(got, Err(E::Size { width, height }), "{content}");
    }
    for content in ["", "P6 1 1 1\n", "PF 1", "PF x 1 1\n", "Pf 1 1 -1\n123"] {
        let got = read_file("a.pfm", content.as_bytes(), 1.0);
        assert!(matches!(got, Err(E::Format(_))), "{content:?}: {got:?}");
    }
    let one = b"Pf 1 1 -1\n\0\0\0\0";
    assert!(
        matches!(read_file("a", one, 1.0), Err(E::Extension(_))),
        "no extension"
    );
    for scale in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        assert!(
            matches!(read_file("a.pfm", one, scale), Err(E::Scale(_))),
            "{scale}"
        );
    }
    let missing = read_radiance_map(Path::new("no/such.pfm"), 1.0).unwrap_err();
    let text = missing.to_string();
    assert!(text.starts_with("no/such.pfm: cannot be read: "), "{text}");
}

proptest! {
    #[test]
    fn no_bytes_make_the_readers_panic(
        at in 0_usize..400,
        byte in any::<u8>(),
        end in 0_usize..600,
    ) {
        let mut file = exr_file(&[("R", RED), ("G", GREEN), ("B", BLUE)]);
        let length = file.len();
        file[at % length] = byte;
        file.truncate(end.min(length));
        let _: Result<_, _> = open_exr::parse(&file);
        let mut file = b"PF 3 2 -1.0\n".to_vec();
        file.extend([1; 72]);
        let length = file.len();
        file[at % length] = byte;
        file.truncate(end.min(length));
        let _: Result<_, _> = pfm::parse(&file);
    }
}
