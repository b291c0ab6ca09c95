use proptest::prelude::*;

use tem00_speckle::PupilField;
use tem00_testkit::{robust, rows};

use super::*;

const LIMIT: u64 = 1 << 20;

/// Returns the bytes of pairs of hexadecimal digits.
pub(crate) fn hex(text: &str) -> Vec<u8> {
    let digits: String = text.split_whitespace().collect();
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).expect("two digits");
    (0..digits.len()).step_by(2).map(byte).collect()
}

/// The content before the values, byte by byte as the format says, without a line of the library.
fn header(version: u8, text: &str) -> Vec<u8> {
    let length = u32::try_from(text.len()).unwrap().to_le_bytes();
    let mut file = b"\x93NUMPY".to_vec();
    file.extend([version, 0]);
    file.extend(&length[..if version == 1 { 2 } else { 4 }]);
    file.extend(text.as_bytes());
    file
}

/// An array as NumPy writes it, except for the blanks behind the header.
pub(crate) fn array(descr: &str, shape: &str, values: &[u8]) -> Vec<u8> {
    let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n");
    [&header(1, &text), values].concat()
}

fn complex(file: &[u8]) -> Result<Grid<Complex<f32>>, NpyError> {
    NpyReader::new(file)?.into_complex(LIMIT)
}

fn real(file: &[u8]) -> Result<Grid<f32>, NpyError> {
    NpyReader::new(file)?.into_real(LIMIT)
}

fn wave(width: usize, height: usize) -> Grid<Complex<f32>> {
    Grid::from_fn(width, height, |x, y| {
        Complex::new(x as f32 - 0.25 * y as f32, 1.0 / (1.0 + y as f32))
    })
}

#[test]
fn files_are_those_of_numpy() {
    let mut file = Vec::new();
    write_npy(&wave(3, 2), &mut file).unwrap();
    // np.save of an array of the shape (2, 3): 128 bytes of header, blanks up to the line's end.
    let text = "{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3), }";
    assert_eq!(
        file[..128],
        header(1, &format!("{text:<117}\n")),
        "the header"
    );
    let values: Vec<u8> = [0.0_f32, 1.0, 1.0, 1.0, 2.0, 1.0]
        .into_iter()
        .chain([-0.25, 0.5, 0.75, 0.5, 1.75, 0.5])
        .flat_map(f32::to_le_bytes)
        .collect();
    assert_eq!(file[128..], values, "the values");
}

#[test]
fn another_library_reads_what_is_written() {
    let pattern = PupilField::from_speckle_size([40, 32], 2.0, 3).unwrap();
    let (intensity, amplitude) = (pattern.pattern(), pattern.field());
    let (mut real, mut complex) = (Vec::new(), Vec::new());
    write_real_npy(intensity.values(), &mut real).unwrap();
    write_npy(amplitude.values(), &mut complex).unwrap();
    let real = npyz::NpyFile::new(real.as_slice()).unwrap();
    assert_eq!(real.shape(), [32, 40]);
    assert_eq!(real.into_vec::<f32>().unwrap(), intensity.values().values());
    let complex = npyz::NpyFile::new(complex.as_slice()).unwrap();
    assert_eq!(complex.shape(), [32, 40]);
    let values: Vec<Complex<f32>> = complex.into_vec().unwrap();
    assert_eq!(values, amplitude.values().values());
}

#[test]
fn every_type_and_order_of_bytes_is_understood() {
    // Two numbers. Of binary16 the smallest and the largest are 2⁻²⁴ and 65504.
    let table = "
        <f4 => 0000c03f 000000c0 => 1.5 -2
        >f4 => 3fc00000 c0000000 => 1.5 -2
        <f8 => 000000000000f83f 00000000000000c0 => 1.5 -2
        >f8 => 3ff8000000000000 c000000000000000 => 1.5 -2
        <f2 => 0100 ff7b => 5.9604645e-8 65504
        >f2 => 3c00 c000 => 1 -2
        |b1 => 01 00 => 1 0
        |u1 => 00 ff => 0 255
        <u2 => 0102 ffff => 513 65535
        >u2 => 0102 0009 => 258 9
        <u4 => 01000000 00000080 => 1 2147483648
        >u8 => 0000000000000001 0000010000000000 => 1 1099511627776
        |i1 => ff 80 => -1 -128
        >i2 => ffff 8000 => -1 -32768
        <i4 => ffffffff 70110100 => -1 70000
        <i8 => ffffffffffffffff 0000000000010000 => -1 1099511627776";
    for [descr, bytes, numbers] in rows(table) {
        let bytes = hex(&bytes);
        let numbers = numbers.split(' ').map(|word| word.parse().unwrap());
        let numbers: Vec<f32> = numbers.collect();
        for shape in ["(1, 2)", "(1, 2, 1)", "(1, 1, 2)"] {
            let grid = real(&array(&descr, shape, &bytes)).unwrap();
            assert_eq!(grid.values(), numbers, "{descr}");
            assert_eq!((grid.width(), grid.height()), (2, 1), "{descr} {shape}");
        }
        if descr.ends_with("f4") || descr.ends_with("f8") {
            let descr = descr.replace("f8", "c16").replace("f4", "c8");
            let grid = complex(&array(&descr, "(1, 1)", &bytes)).unwrap();
            assert_eq!(grid.values(), [Complex::new(1.5, -2.0)], "{descr}");
        }
    }
}

#[test]
fn columns_may_come_first() {
    let text = "{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3)}";
    let grid = real(&[&header(1, text)[..], &[1, 4, 2, 5, 3, 6]].concat()).unwrap();
    assert_eq!(grid.values(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!((grid.width(), grid.height()), (3, 2));
}

#[test]
fn headers_of_other_writers_are_understood() {
    for text in [
        "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2), }",
        r#"{"shape":(1,2),"fortran_order":False,"descr":"|u1"}"#,
        " { 'fortran_order' : False , 'shape' : ( 1L , 2L , ) , 'descr' : '|u1' } \n",
        "{'descr': '|u1', 'fortran_order': False, 'shape': [1, 2]}",
    ] {
        for version in 1..=3 {
            let file = [&header(version, text)[..], &[7, 8]].concat();
            let values = real(&file).map(Grid::into_values);
            assert_eq!(values.ok(), Some(vec![7.0, 8.0]), "{text}");
        }
    }
}

#[test]
fn what_is_no_field_says_what_it_is() {
    let refused = |file: &[u8], part: &str| {
        let error = complex(file).unwrap_err().to_string();
        assert!(error.contains(part), "{part}: {error}");
    };
    // Headers, beside the order of columns.
    let table = "
        'size': 3 => unknown field `size`
        'shape': (1, 2) => missing field `descr`
        'shape' => expected `:`
        'shape': (1, 2) 'descr': '<c8' => expected `,` or `}`
        'shape': twelve => expected ident
        'shape': (1, 2 => expected `,` or `]`
        'descr': '<c8', 'shape': 12 => expected a sequence
        'descr': '<c8', 'shape': (-1, 2) => integer `-1`
        'descr': '<c8', 'shape': (99999999999999999999, 1) => expected u64
        'descr': [('a', '<f4'), ('b', '<f4', (2,))], 'shape': (2, 2) => got the type [[\"a\",\"<f4\"]";
    for [entries, part] in rows(table) {
        let text = format!("{{'fortran_order': False, {entries}}}");
        refused(&header(1, &text), &part);
    }
    let nested = format!("{{'fortran_order': False, 'descr': {}", "(".repeat(60_000));
    refused(&header(1, &nested), "recursion limit");
    refused(&header(1, "[1]"), "header of the NPY file");
    refused(&header(1, "{} {}"), "header of the NPY file");
    refused(b"P5 640 480 255", "not a NumPy file");
    refused(&header(4, "{}"), "got 4.0");
    // Types and shapes.
    let table = "
        <c8 => (4,) => got the shape [4]
        <c8 => () => got the shape []
        <c8 => (2, 2, 2) => [2, 2, 2]
        <c8 => (0, 4) => got the shape [0, 4]
        <f8 => (1, 2) => complex128, got the type <f8
        <i8 => (1, 2) => got the type <i8
        =c8 => (1, 2) => got the type =c8
        <c8 => (1, 9) => ends before
        <c8 => (1000000, 1000000) => at most 1048576 bytes
        <c8 => (9999999999, 9999999999) => 1048576 bytes";
    for [descr, shape, part] in rows(table) {
        refused(&array(&descr, &shape, &[0; 64]), &part);
    }
    let hole = array("<c8", "(1, 1)", &[0, 0, 0, 0, 0, 0, 192, 127]);
    refused(&hole, "index [0, 0]");
    let beyond = [0.0, 0.0, 0.0, 1e39].map(f64::to_le_bytes).concat();
    refused(&array("<c16", "(2, 1)", &beyond), "index [1, 0]");
    let error = real(&array("<c8", "(1, 1)", &[0; 8])).unwrap_err();
    assert!(error.to_string().contains("float32"), "{error}");
    let endless = [&b"\x93NUMPY\x02\x00\xff\xff\xff\xff"[..], &[b' '; 99]].concat();
    let error = NpyReader::new(endless.as_slice()).unwrap_err().to_string();
    assert!(error.contains("65536"), "{error}");
}

#[test]
fn every_shorter_file_is_truncated() {
    let file = array("<c8", "(1, 2)", &[0; 16]);
    for length in 0..file.len() {
        let cut = complex(&file[..length]);
        assert!(
            matches!(cut, Err(NpyError::Truncated)),
            "{length} bytes: {cut:?}"
        );
    }
    assert!(complex(&file).is_ok(), "all of it");
    let short = complex(b"P5");
    assert!(matches!(short, Err(NpyError::Foreign)), "{short:?}");
}

#[test]
fn memory_is_only_asked_for_as_the_file_fills_it() {
    // A petabyte is claimed, a few bytes are there, and no limit is set.
    let file = array("<c8", "(500000000, 250000)", &[0; 800]);
    let cut = NpyReader::new(file.as_slice()).and_then(|array| array.into_complex(u64::MAX));
    assert!(matches!(cut, Err(NpyError::Truncated)), "{cut:?}");
    // More values than there are addresses.
    let endless = array("<c8", "(9999999999, 9999999999)", &[0; 800]);
    let cut = NpyReader::new(endless.as_slice()).and_then(|array| array.into_complex(u64::MAX));
    assert!(matches!(cut, Err(NpyError::Memory(_))), "{cut:?}");

    // What the limit counts: the values once, or twice if they are transposed.
    let file = array("<c16", "(4, 4)", &[0; 256]);
    let within = |file: &[u8], limit| {
        let array = NpyReader::new(file).and_then(|array| array.into_complex(limit));
        array.is_ok()
    };
    assert!(within(&file, 128) && !within(&file, 127), "C order");
    let text = "{'descr': '<c16', 'fortran_order': True, 'shape': (4, 4)}";
    let file = [&header(1, text)[..], &[0; 256]].concat();
    assert!(within(&file, 256) && !within(&file, 255), "Fortran order");
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let mut file = Vec::new();
    write_npy(&wave(3, 3), &mut file).unwrap();
    robust(
        |bytes| (complex(bytes).is_ok(), real(bytes).is_ok()),
        &[&file],
    );
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in "[{}()\\[\\]'\":, a-eTrueFalsdcohp0-9_\\-]{0,60}") {
        let _ = NpyReader::new(header(1, &text).as_slice()).map(|array| array.shape().to_vec());
        let text = format!("{{'descr': {text}, 'fortran_order': False, 'shape': (1, 1)}}");
        let _ = complex(&header(2, &text));
    }

    #[test]
    fn fields_come_back_with_the_same_bits(width in 1_usize..50, height in 1_usize..50) {
        let mut file = Vec::new();
        write_npy(&wave(width, height), &mut file).unwrap();
        prop_assert_eq!(complex(&file).unwrap(), wave(width, height));
    }
}
