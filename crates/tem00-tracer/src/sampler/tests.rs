use super::*;

fn pairs(sequence: &Sequence, pixel: u64, samples: u32, purpose: Use) -> Vec<[f64; 2]> {
    let stream = |index| sequence.stream(pixel, index);
    (0..samples)
        .map(|index| sequence.pair(stream(index), purpose))
        .collect()
}

/// Returns which of so many equal parts of (0, 1) holds `x`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "x is positive and the parts are few"
)]
fn place(x: f64, parts: usize) -> usize {
    (x * parts as f64) as usize
}

/// Tells whether each cell of a grid of so many columns and rows holds one of the points.
fn one_in_each_cell(points: &[[f64; 2]], columns: usize, rows: usize) -> bool {
    let mut cells = vec![0; columns * rows];
    for [x, y] in points {
        let (column, row) = (place(*x, columns), place(*y, rows));
        cells[row * columns + column] += 1;
    }
    cells.iter().all(|&points| points == 1)
}

#[test]
fn every_elementary_rectangle_holds_one_point_of_every_use() {
    const SAMPLES: u32 = 64;
    let sequence = Sequence::new(SAMPLES);
    let uses = [Use::Lens, Use::Scattering(3), Use::Light(1, 2)];
    for (pixel, purpose) in (0..20).flat_map(|pixel| uses.map(|purpose| (pixel, purpose))) {
        let points = pairs(&sequence, pixel_key(5, [0, pixel, 0]), SAMPLES, purpose);
        for columns in [1, 2, 4, 8, 16, 32, 64] {
            assert!(
                one_in_each_cell(&points, columns, 64 / columns),
                "pixel {pixel}, {purpose:?}, {columns} columns"
            );
        }
    }
}

#[test]
fn a_few_samples_of_many_pixels_are_uniform() {
    // Three samples of 4096 pixels: 12 288 points in 64 cells, 192 in each on average.
    let sequence = Sequence::new(3);
    let mut cells = [0_u32; 64];
    for pixel in 0..4096 {
        for [x, y] in pairs(&sequence, pixel_key(1, [0, pixel, 0]), 3, Use::Lens) {
            cells[place(y, 8) * 8 + place(x, 8)] += 1;
        }
    }
    let chi_squared: f64 = cells
        .iter()
        .map(|&n| (f64::from(n) - 192.0).powi(2) / 192.0)
        .sum();
    // With 63 degrees of freedom, above 113 with probability 1e-4; the points are more even than
    // independent ones, which lowers it.
    assert!(chi_squared < 113.0, "χ² = {chi_squared}");
}

#[test]
fn uses_and_vertices_are_independent_of_each_other() {
    const SAMPLES: u32 = 256;
    const PIXELS: u64 = 64;
    let sequence = Sequence::new(SAMPLES);
    let uses = [
        Use::Pixel,
        Use::Lens,
        Use::Scattering(1),
        Use::Scattering(2),
        Use::Survival(1),
        Use::Light(1, 0),
        Use::Light(1, 1),
        Use::Laser(1, 0),
    ];
    let correlation = |first, second, [k, l]: [usize; 2]| {
        let of_pixel = |pixel| {
            let a = pairs(&sequence, pixel_key(3, [0, pixel, 0]), SAMPLES, first);
            let b = pairs(&sequence, pixel_key(3, [0, pixel, 0]), SAMPLES, second);
            let products = a.iter().zip(&b).map(|(a, b)| (a[k] - 0.5) * (b[l] - 0.5));
            12.0 * products.sum::<f64>() / f64::from(SAMPLES)
        };
        (0..PIXELS).map(of_pixel).sum::<f64>() / PIXELS as f64
    };
    for (i, &first) in uses.iter().enumerate() {
        for &second in &uses[i + 1..] {
            for axes in [[0, 0], [0, 1], [1, 0], [1, 1]] {
                let correlation = correlation(first, second, axes);
                // Points come in pairs in opposite halves, so only 128 of a pixel are independent:
                // the standard deviation is 1/√(128 · 64) at most, and 4.7 of them have a
                // probability of 3e-6 for each of the 112 pairs.
                assert!(
                    correlation.abs() < 4.7 / 90.5,
                    "{first:?}, {second:?}, {axes:?}: {correlation}"
                );
            }
        }
    }
}

#[test]
fn more_samples_than_points_start_afresh() {
    let sequence = Sequence::new(u32::MAX);
    let of = |index| sequence.pair(sequence.stream(7, index), Use::Lens);
    let (first, second) = (
        of(3).map(f64::to_bits),
        of(3 + MAX_POINTS).map(f64::to_bits),
    );
    assert_ne!(first, second, "the second set repeats the first");
}

#[test]
fn streams_differ_by_seed_frame_pixel_and_round_and_repeat() {
    let sequence = Sequence::new(16);
    let first = |seed, place| {
        let stream = sequence.stream(pixel_key(seed, place), 0);
        sequence.pair(stream, Use::Lens).map(f64::to_bits)
    };
    let reference = first(1, [2, 3, 4]);
    assert_eq!(reference, first(1, [2, 3, 4]), "the same again");
    for (seed, place) in [
        (2, [2, 3, 4]),
        (1, [3, 3, 4]),
        (1, [2, 4, 4]),
        (1, [2, 3, 5]),
    ] {
        assert_ne!(reference, first(seed, place), "{seed}, {place:?}");
    }
}
