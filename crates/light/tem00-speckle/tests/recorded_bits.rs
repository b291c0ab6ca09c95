//! The same bits with and without the feature `parallel`, and for any number of threads: either
//! build is held to the same recorded checksums.

use tem00_speckle::{Complex, Phasors, Pupil, PupilField, SlicePath, SpeckleError, SpeckleStack};
use tem00_testkit::on_threads;

/// FNV-1a over the bits of `f32` values.
fn checksum(values: impl IntoIterator<Item = f32>) -> u64 {
    let bytes = values.into_iter().flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |sum, byte| {
        (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

fn parts(values: &[Complex<f32>]) -> impl Iterator<Item = f32> {
    values.iter().flat_map(|z| [z.re, z.im])
}

fn bits_of_stack(field: &PupilField, path: SlicePath) -> Result<u64, SpeckleError> {
    let stack = SpeckleStack::generate(field, path)?;
    let slices = (0..stack.slice_count()).map(|index| stack.coefficients(index).values());
    Ok(checksum(slices.flat_map(parts)))
}

/// Patterns, a field and stacks: square and not, of sides with large prime factors too.
fn checksums() -> Result<[u64; 5], SpeckleError> {
    let square = PupilField::new(96, 40, 8)?;
    let oblong = PupilField::from_speckle_size([90, 77], 2.3, 2_016)?
        .with_pupil(Pupil::Annulus { inner: 0.3 })?
        .with_phasors(Phasors::Gaussian);
    let displaced = oblong.pattern_at([5.3, -2.25], 0.35);
    let straight = SlicePath::Straight {
        half_period: 2,
        length: 3,
    };
    Ok([
        checksum(square.pattern().into_values().into_values()),
        checksum(displaced.into_values().into_values()),
        checksum(parts(oblong.speckle([0.2, 0.0], 0.0).values().values())),
        bits_of_stack(&square, SlicePath::Circle { half_period: 3 })?,
        bits_of_stack(&oblong, straight)?,
    ])
}

/// Recorded once without the feature `parallel`. The transform rounds as the processor's
/// instructions demand, here AVX and FMA; a new version of it may round otherwise and be recorded
/// anew.
const RECORDED: [u64; 5] = [
    0x6413_a0f7_57ba_767a,
    0x116d_4df6_424c_93b4,
    0xa9dd_7762_ce84_3ae9,
    0x57f6_1c3d_c64c_7556,
    0x06bd_4724_111c_268f,
];

#[cfg(target_arch = "x86_64")]
fn rounds_as_recorded() -> bool {
    is_x86_feature_detected!("avx") && is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
const fn rounds_as_recorded() -> bool {
    false
}

#[test]
fn threads_change_no_bit() {
    let one = on_threads(1, checksums).expect("valid fields");
    for count in [2, 7] {
        let many = on_threads(count, checksums).expect("valid fields");
        assert_eq!(one, many, "{count} threads");
    }
    if rounds_as_recorded() {
        assert_eq!(one, RECORDED, "other bits than recorded");
    }
}
