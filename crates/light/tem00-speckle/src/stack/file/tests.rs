use proptest::prelude::*;

use super::*;
use crate::{Interpolation, Phasors, Pupil, SlicePath, StackOptions, Transmission};

const LIMIT: u64 = 1 << 20;

fn bytes(stack: &SpeckleStack) -> Vec<u8> {
    let mut file = Vec::new();
    stack.write_to(&mut file).unwrap();
    file
}

fn read(file: &[u8]) -> Result<SpeckleStack, StackFileError> {
    SpeckleStack::read_from(file, LIMIT)
}

fn small() -> SpeckleStack {
    let field = PupilField::from_speckle_size([20, 16], 2.0, 5).unwrap();
    SpeckleStack::generate(&field, SlicePath::Circle { half_period: 1 }).unwrap()
}

fn gradient(width: usize, height: usize) -> Grid<f32> {
    Grid::from_fn(width, height, |x, y| (x + 3 * y) as f32 / 100.0)
}

fn pupils() -> Vec<Pupil> {
    vec![
        Pupil::Circle,
        Pupil::Annulus { inner: 0.3 },
        Pupil::Rectangle { height: 0.9 },
        Pupil::Gaussian { radius: 0.8 },
        Pupil::Sampled(Transmission::new(&gradient(7, 5)).unwrap()),
    ]
}

/// Equal in all that look-ups depend on, to the last bit.
fn assert_same(a: &SpeckleStack, b: &SpeckleStack) {
    assert_eq!(a, b, "another stack");
    assert_eq!(
        a.speckle_size().to_bits(),
        b.speckle_size().to_bits(),
        "speckle size"
    );
    for (x, u) in [(0.25, 0.0), (7.7, 0.5), (-3.1, 1.8)] {
        let [a, b] = [a, b].map(|stack| stack.intensity_at(x, 0.6 - x, u).to_bits());
        assert_eq!(a, b, "at {x}, {u}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_stack_comes_back_with_the_same_bits(
        width in 26_usize..40, height in 26_usize..40, speckle_size in 2.0_f64..2.3, seed: u64,
        pupil in 0_usize..5, path in 0_usize..3, kind in 0_usize..3, source in 0_usize..3,
    ) {
        let field = match source {
            2 => {
                let samples = gradient(33, 21).map(|&re| Complex::new(re, 0.3 - re));
                PupilField::from_samples(samples, [width, height], speckle_size).unwrap()
            }
            _ => PupilField::from_speckle_size([width, height], speckle_size, seed).unwrap(),
        };
        let phasors = if source == 0 { Phasors::Unit } else { Phasors::Gaussian };
        let field = field.with_phasors(phasors).with_pupil(pupils()[pupil].clone()).unwrap();
        let field = field.displaced([[0, 0], [3, -1]][kind % 2]);
        let path = [
            SlicePath::Still,
            SlicePath::Circle { half_period: 2 },
            SlicePath::Straight { half_period: 2, length: 3 },
        ][path];
        let interpolation = [
            Interpolation::CubicSpline, Interpolation::Bilinear, Interpolation::Nearest,
        ][kind];
        let options = StackOptions { interpolation, ..StackOptions::default() };
        let stack = SpeckleStack::generate_with(&field, path, options).unwrap();
        let file = bytes(&stack);
        prop_assert_eq!(file[32] % 64, 0);
        assert_same(&read(&file).unwrap(), &stack);
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        at in 0_usize..384, value: [u8; 8], tail in 0_usize..4_000,
    ) {
        // A header with one wild entry, made credible by its checksum.
        let mut file = bytes(&small());
        file[at..at + 8].copy_from_slice(&value);
        let checksum = header_checksum(&file);
        file[16..24].copy_from_slice(&checksum.to_le_bytes());
        file.truncate(file.len() - tail.min(file.len()));
        // Whatever it is, it comes to an end without a gigabyte.
        let _ = read(&file);
    }
}

fn header_checksum(file: &[u8]) -> u64 {
    let mut checksum = Checksum::default();
    checksum.add_bytes(&file[32..384]);
    checksum.value()
}

#[test]
fn integer_pupils_come_back_as_they_were() {
    for (size, diameter) in [(49, 11), (16, 8), (65, 32), (40, 13)] {
        let field = PupilField::new(size, diameter, 3).unwrap();
        let stack = SpeckleStack::generate(&field, SlicePath::Still).unwrap();
        assert_same(&read(&bytes(&stack)).unwrap(), &stack);
    }
}

#[test]
fn every_changed_byte_is_an_error() {
    let file = bytes(&small());
    // The prologue, the fixed entries, two slices of 96 bytes, two of 20 × 16 samples.
    assert_eq!(file.len(), 192 + 2 * 96 + 2 * 20 * 16 * 8);
    for at in 0..file.len() {
        for bit in [0, 3, 7] {
            let mut changed = file.clone();
            changed[at] ^= 1 << bit;
            assert!(read(&changed).is_err(), "bit {bit} of byte {at}");
        }
    }
}

#[test]
fn every_shorter_file_is_truncated() {
    let file = bytes(&small());
    for length in 0..file.len() {
        let cut = read(&file[..length]);
        assert!(
            matches!(cut, Err(StackFileError::Truncated)),
            "{length} bytes: {cut:?}"
        );
    }
    // What follows belongs to others.
    let longer = [&file[..], b"more"].concat();
    let mut rest = longer.as_slice();
    let stack = SpeckleStack::read_from(&mut rest, LIMIT).unwrap();
    assert_same(&stack, &small());
    assert_eq!(rest, b"more");
}

#[test]
fn other_files_are_told_from_damaged_ones() {
    let file = bytes(&small());
    let with = |at: usize, new: &[u8]| {
        let mut changed = file.clone();
        changed[at..at + new.len()].copy_from_slice(new);
        read(&changed).unwrap_err()
    };
    assert!(
        matches!(with(0, b"\x93NUMPY"), StackFileError::Foreign),
        "NPY"
    );
    let newer = with(8, &[2, 0, 0, 0]);
    assert!(
        matches!(newer, StackFileError::Newer { version: 2, .. }),
        "{newer:?}"
    );
    assert!(newer.to_string().contains("at most 1, got 2"), "{newer}");
    assert!(
        matches!(with(390, &[1, 2, 3]), StackFileError::Damaged),
        "coefficients"
    );
    assert!(
        matches!(with(200, &[1, 2, 3]), StackFileError::Damaged),
        "table of slices"
    );
}

/// Whose bytes are a multiple of 2⁶⁴, so that they could pass for none.
#[test]
fn sides_beyond_all_files_are_refused() {
    for at in [120, 144] {
        let mut file = bytes(&small());
        file[at..at + 4].copy_from_slice(&(1_u32 << 31).to_le_bytes());
        file[at + 4..at + 8].copy_from_slice(&(1_u32 << 30).to_le_bytes());
        let checksum = header_checksum(&file);
        file[16..24].copy_from_slice(&checksum.to_le_bytes());
        let refused = read(&file);
        let named = matches!(&refused, Err(error) if error.to_string().contains("data offset"));
        assert!(named, "{refused:?}");
    }
}

#[test]
fn memory_is_only_asked_for_as_the_file_fills_it() {
    // The header of a stack of 2 × 32768² samples, 16 GiB, with nothing behind it.
    let mut file = bytes(&small());
    let side = 32_768_u32;
    let diameter = f64::from(side) / 2.0;
    file[40..44].copy_from_slice(&side.to_le_bytes());
    file[44..48].copy_from_slice(&side.to_le_bytes());
    file[64..72].copy_from_slice(&diameter.to_le_bytes());
    file[72..80].copy_from_slice(&diameter.to_le_bytes());
    let checksum = header_checksum(&file);
    file[16..24].copy_from_slice(&checksum.to_le_bytes());
    let limited = read(&file);
    let over = matches!(
        limited,
        Err(StackFileError::Stack(SpeckleError::MemoryLimit {
            limit: LIMIT,
            ..
        }))
    );
    assert!(over, "{limited:?}");
}

/// What another program does that maps the file: no more than the document of the layout tells it.
#[test]
fn a_mapped_file_can_be_looked_up() {
    let stack = small();
    let file = bytes(&stack);
    let u32_at = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let f32_at = |at: usize| f32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    let f64_at = |at: usize| f64::from_le_bytes(file[at..at + 8].try_into().unwrap());
    let data = u32_at(32);
    let [width, height] = [u32_at(40), u32_at(44)];
    assert_eq!(u32_at(52), 3, "cubic");
    // At the sample (3, 4) of slice 1: the weights of the spline are 1/6, 2/3, 1/6, 0.
    let weights = [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0];
    let mut amplitude = Complex::new(0.0, 0.0);
    for (j, wy) in (0..3).zip(weights) {
        for (i, wx) in (0..3).zip(weights) {
            let at = data + 8 * (width * height + (3 + j) * width + 2 + i);
            amplitude += Complex::new(f32_at(at), f32_at(at + 4)) * (wx * wy);
        }
    }
    let lags = [33.0 / 66.0, 2.0 / 9.0, 1.0 / 36.0, 0.0];
    let slice = 192 + 96;
    let variance: f32 = (0..16)
        .map(|i| f32_at(slice + 32 + 4 * i) * lags[i / 4] * lags[i % 4])
        .sum();
    let expected = stack.intensity_at(3.0, 4.0, 1.0);
    let got = f64::from(amplitude.norm_sqr() / variance);
    assert!(
        (got - expected).abs() < 1e-6 * (1.0 + expected),
        "{got} | {expected}"
    );
    // The way back to slice 0: all of the diameter along x.
    assert!(
        (f64_at(slice) - 10.0).abs() < 1e-12,
        "step {}",
        f64_at(slice)
    );
}

#[test]
fn a_file_appears_whole_or_not_at_all() {
    let folder = std::env::temp_dir().join(format!("tem00-save-{}", process::id()));
    fs::create_dir(&folder).unwrap();
    let names = || {
        let entries = fs::read_dir(&folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.collect::<Vec<_>>()
    };
    let stack = small();
    let bytes = bytes(&stack);
    let path = folder.join("stack");
    fs::write(&path, "what was there").unwrap();
    stack.save(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), bytes);
    assert_eq!(names(), ["stack"], "nothing else is left");
    // A folder takes no file, and no folder has none.
    assert!(stack.save(&folder).is_err());
    assert!(stack.save(&folder.join("none/stack")).is_err());
    #[cfg(unix)]
    {
        let link = folder.join("link");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        fs::write(&path, "what was there").unwrap();
        stack.save(&link).unwrap();
        assert_eq!(
            fs::read(&path).unwrap(),
            b"what was there",
            "not through a link"
        );
        assert_eq!(fs::read(&link).unwrap(), bytes);
        stack.save(Path::new("/dev/null")).unwrap();
        assert!(!Path::new("/dev/null").is_file(), "a device stays one");
    }
    fs::remove_dir_all(&folder).unwrap();
}
