use super::*;

fn pairs(sequence: &Sequence, pixel: u64, samples: u32, purpose: Use) -> Vec<[f64; 2]> {
    (0..samples)
        .map(|index| sequence.pair(stream(pixel, index), purpose))
        .collect()
}

fn stream(key: u64, index: u32) -> Stream {
    let level = 0;
    Stream { key, level, index }
}

fn key_of(seed: u64, column: u64) -> u64 {
    pixel_key(seed, [0, column, 0])
}

fn position(sequence: &Sequence, stream: Stream) -> [f64; 2] {
    let mut position = [[0.0; 2]];
    sequence.positions(stream, &mut position);
    position[0]
}

fn positions(sequence: &Sequence, key: u64) -> Vec<[f64; 2]> {
    let streams = (0..sequence.count).map(|index| stream(key, index));
    streams.map(|stream| position(sequence, stream)).collect()
}

/// The mean square over many pixels of the error that `error` finds for the positions of each.
fn mean_square(count: u32, error: impl Fn(u32, &[[f64; 2]]) -> f64) -> f64 {
    const PIXELS: u32 = 4000;
    let sequence = Sequence::new(count);
    let square = |pixel: u32| {
        let key = key_of(8, pixel.into());
        error(pixel, &positions(&sequence, key)).powi(2)
    };
    (0..PIXELS).map(square).sum::<f64>() / f64::from(PIXELS)
}

/// The error of the mean of points for the area to one side of an edge in some direction.
fn edge_error(pixel: u32, points: &[[f64; 2]]) -> f64 {
    let angle = (f64::from(pixel) + 0.5) * 2.4;
    let offset = (f64::from(pixel) * 0.618).fract() * 0.8 - 0.4;
    let (sin, cos) = libm::sincos(angle);
    let is_behind = |[x, y]: &[f64; 2]| (x - 0.5) * cos + (y - 0.5) * sin < offset;
    let found = points.iter().filter(|point| is_behind(point)).count() as f64;
    // The area of the unit square behind the edge, by the integral of a box over a box.
    let (a, b) = (cos.abs(), sin.abs());
    let half_square = |t: f64| 0.5 * t.max(0.0).powi(2);
    let t = offset + 0.5 * (a + b);
    let area = (half_square(t) - half_square(t - a) - half_square(t - b) + half_square(t - a - b))
        / (a * b);
    found / points.len() as f64 - area
}

/// Returns the index of the part that holds `x`, of equal parts of (0, 1).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "x is positive and the parts are few"
)]
fn place(x: f64, parts: usize) -> usize {
    (x * parts as f64) as usize
}

/// Returns whether each cell of a grid of `columns` columns and `rows` rows holds one of the
/// points.
fn one_in_each_cell(points: &[[f64; 2]], columns: usize, rows: usize) -> bool {
    let mut cells = vec![0; columns * rows];
    for [x, y] in points {
        let (column, row) = (place(*x, columns), place(*y, rows));
        cells[row * columns + column] += 1;
    }
    cells.iter().all(|&points| points == 1)
}

#[test]
fn every_column_and_every_row_of_a_pixel_holds_one_sample() {
    for count in [1, 2, 3, 5, 12, 16, 17, 64, 121, 257] {
        let sequence = Sequence::new(count);
        for pixel in 0..20 {
            let points = positions(&sequence, key_of(5, pixel));
            for [columns, rows] in [[count, 1], [1, count]] {
                let is_even = one_in_each_cell(&points, columns as usize, rows as usize);
                assert!(is_even, "pixel {pixel}, {columns} columns of {count}");
            }
        }
    }
}

#[test]
fn a_pixel_misses_of_an_edge_what_one_sample_in_each_column_does() {
    for count in [7, 64, 121] {
        let n = f64::from(count);
        // In one column in n the edge leaves the count to chance: f (1 − f) / n², f between 0
        // and 1.
        let edge = mean_square(count, |pixel, points| {
            let place = (f64::from(pixel) * 0.618).fract();
            let before = points.iter().filter(|[x, _]| *x < place).count() as f64;
            before / n - place
        });
        let ratio = edge * 6.0 * n * n;
        // The relative standard deviation of a mean square of 4000 is √(2/4000) = 0.022 for normal
        // errors; 4 of them.
        assert!((ratio - 1.0).abs() < 0.09, "{count}: {ratio}");
    }
}

#[test]
fn a_ramp_over_the_pixel_is_met_exactly_but_for_a_column_without_a_neighbour() {
    for count in [64, 7, 121] {
        let n = f64::from(count);
        for axis in 0..2 {
            let ramp = mean_square(count, |_, points| {
                let sum: f64 = points.iter().map(|point| point[axis] - 0.5).sum();
                sum / points.len() as f64
            });
            // The last of an odd number lies anywhere in its column: 1 / (12 n²), by n².
            let alone = f64::from(count % 2) / (12.0 * n.powi(4));
            // 4 relative standard deviations of a mean square of 4000, √(0.8/4000) of uniform
            // numbers, and a rounding to 2⁻³² for each sample.
            let error = ramp - alone;
            assert!(error.abs() < 0.06 * alone + 1e-18, "{count}: {ramp:e}");
        }
    }
}

#[test]
fn slanted_edges_cost_no_more_than_in_jittered_cells() {
    // One sample by chance in each of 8 × 8 and of 11 × 11 cells, from
    // benches/peers/pixel_samples.py.
    for (count, jittered) in [(64, 3.3e-4), (121, 1.3e-4)] {
        let error = mean_square(count, edge_error);
        assert!(error < 0.75 * jittered, "{count}: {error:e}");
    }
}

#[test]
fn smooth_functions_of_any_use_are_integrated_to_second_order() {
    for count in [5, 64, 121] {
        let sequence = Sequence::new(count);
        for pixel in 0..20 {
            let points = pairs(&sequence, key_of(2, pixel), count, Use::Lens);
            for axis in [0, 1] {
                let mean = points.iter().map(|p| p[axis]).sum::<f64>() / f64::from(count);
                // At each of the two folds the slope jumps by 4: an error of h² / 3 at most, h =
                // 1/N.
                let bound = 0.67 / f64::from(count * count) + 1e-9;
                assert!((mean - 0.5).abs() < bound, "{count}: {mean}");
            }
        }
    }
}

#[test]
fn orders_are_permutations() {
    for count in [1, 2, 3, 4, 63, 64, 121] {
        for seed in 0..10 {
            let mut found: Vec<_> = (0..count)
                .map(|i| permuted(i, count, scattered(seed)))
                .collect();
            found.sort_unstable();
            assert!(found.into_iter().eq(0..count), "{count}, {seed}");
        }
    }
}

#[test]
fn a_few_samples_of_many_pixels_are_uniform() {
    // Three samples of 4096 pixels: 12 288 points in 64 cells, 192 in each on average.
    let sequence = Sequence::new(3);
    let mut cells = [0_u32; 64];
    for pixel in 0..4096 {
        for [x, y] in pairs(&sequence, key_of(1, pixel), 3, Use::Lens) {
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
            let a = pairs(&sequence, key_of(3, pixel), SAMPLES, first);
            let b = pairs(&sequence, key_of(3, pixel), SAMPLES, second);
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
                let is_small = correlation.abs() < 4.7 / 90.5;
                assert!(is_small, "{first:?}, {second:?}, {axes:?}: {correlation}");
            }
        }
    }
}

#[test]
fn any_number_of_samples_stays_in_the_pixel() {
    let sequence = Sequence::new(u32::MAX);
    for index in [0, 1, u32::MAX / 2, u32::MAX - 1] {
        let stream = stream(7, index);
        let points = [
            position(&sequence, stream),
            sequence.pair(stream, Use::Lens),
        ];
        for x in points.as_flattened() {
            assert!(*x > 0.0 && *x < 1.0, "{stream:?}: {x}");
        }
    }
}

#[test]
fn streams_differ_by_seed_frame_and_pixel_and_repeat() {
    let sequence = Sequence::new(16);
    let first = |seed, place| {
        let stream = stream(pixel_key(seed, place), 0);
        [
            sequence.pair(stream, Use::Lens),
            position(&sequence, stream),
        ]
        .map(|x| x.map(f64::to_bits))
    };
    let reference = first(1, [2, 3, 4]);
    assert_eq!(reference, first(1, [2, 3, 4]), "the same again");
    let others = [
        (2, [2, 3, 4]),
        (1, [3, 3, 4]),
        (1, [2, 4, 4]),
        (1, [2, 3, 5]),
    ];
    for (seed, place) in others {
        assert_ne!(reference, first(seed, place), "{seed}, {place:?}");
    }
}

#[test]
fn runs_of_samples_are_those_of_single_calls() {
    for (count, start) in [(1, 0), (7, 2), (64, 0), (64, 5), (100, 64)] {
        let sequence = Sequence::new(count);
        let first = stream(pixel_key(3, [0, 5, 8]), start);
        let length = (count - start) as usize;
        let (mut pairs, mut positions) = (vec![[0.0; 2]; length], vec![[0.0; 2]; length]);
        sequence.pairs(first, Use::Lens, &mut pairs);
        sequence.positions(first, &mut positions);
        for (index, points) in (start..).zip(pairs.iter().zip(&positions)) {
            let stream = Stream { index, ..first };
            let alone = [
                sequence.pair(stream, Use::Lens),
                position(&sequence, stream),
            ];
            let together = [*points.0, *points.1];
            let bits = |points: [[f64; 2]; 2]| points.map(|x| x.map(f64::to_bits));
            assert_eq!(bits(alone), bits(together), "{stream:?}");
        }
    }
}

#[test]
fn quotients_are_those_of_whole_numbers() {
    let numbers =
        |around: u32| (0..5).map(move |step| around.saturating_sub(2).saturating_add(step));
    const LARGE: [u32; 4] = [65_537, 1 << 31, u32::MAX - 1, u32::MAX];
    for by in [1, 2, 3, 7, 64, 100, 641].into_iter().chain(LARGE) {
        for times in [0, 1, 2, 3, 1000, u32::MAX / by / 2, u32::MAX / by] {
            for number in numbers(by.saturating_mul(times)) {
                assert_eq!(quotient(number, by), number / by, "{number} / {by}");
            }
        }
    }
}

#[test]
fn paths_start_from_points_that_are_spread_evenly() {
    const PATHS: u32 = 4096;
    let key = DrawKey {
        seed: 3,
        frame: 1,
        laser: 0,
        group: 5,
    };
    let mut draws = Draws::new(key);
    let points: Vec<_> = (0..PATHS).map(|_| draws.start()).collect();
    for (first, second) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
        let mut counts = [0_i32; 256];
        for point in &points {
            counts[16 * place(point[first], 16) + place(point[second], 16)] += 1;
        }
        // Of independent points each cell would hold 16 ± 4: χ² = 255 ± 23.
        let squares: i32 = counts.iter().map(|count| (count - 16).pow(2)).sum();
        let chi_squared = f64::from(squares) / 16.0;
        assert!(chi_squared < 64.0, "axes {first}, {second}: {chi_squared}");
    }
    let [other, ..] = Draws::new(DrawKey { group: 6, ..key }).start();
    assert!((other - points[0][0]).abs() > 0.0, "groups start alike");
}
