//! The places of a line, from frame to frame.

use tem00::scan::Exposure;

use super::setting::{Prepared, Ratio, SIZE, Setting};

const FRAMES: u32 = 5;
const SEEDS: u64 = 2;

/// Columns that share no speckle with the next so many, but for those at their edges.
const BLOCK: usize = 32;

/// How much more of a pattern is left in rendered frames than the law says, at most: off the slices
/// of the stack, by their blend.
const BLEND: f64 = 0.06;

/// How far speckle moves the centre of gravity of the line in each column, to first order, in
/// pixels.
fn places(exposure: &Exposure) -> Vec<f64> {
    let place = |column: usize| {
        let rows = (0..SIZE[1]).map(|row| {
            let mean = f64::from(exposure.without_speckle[(column, row)]);
            let speckle = f64::from(exposure.electrons[(column, row)]) - mean;
            [row as f64, mean, speckle]
        });
        let sum = |term: &dyn Fn([f64; 3]) -> f64| rows.clone().map(term).sum::<f64>();
        let light = sum(&|[_, mean, _]| mean);
        let centre = sum(&|[row, mean, _]| row * mean) / light;
        sum(&|[row, _, speckle]| (row - centre) * speckle) / light
    };
    (0..SIZE[0]).map(place).collect()
}

/// Adds the correlation of places in frames so many apart, block by block of their columns.
fn add(ratio: &mut Ratio, scan: &[Vec<f64>], later: usize) {
    for first in (0..SIZE[0]).step_by(BLOCK) {
        let columns = first..first + BLOCK;
        let pairs = scan.windows(later + 1).flat_map(|frames| {
            let columns = columns.clone();
            columns.map(|column| [frames[0][column], frames[later][column]])
        });
        ratio.add(pairs.fold([0.0; 2], |[products, squares], [a, b]| {
            [products + a * b, squares + 0.5 * (a * a + b * b)]
        }));
    }
}

#[test]
fn places_of_a_line_correlate_from_frame_to_frame_as_the_scan_says() {
    for (z, step) in [(20e-3, 70e-6), (-25e-3, 60e-6)] {
        let mut found = [Ratio::default(), Ratio::default()];
        let mut law = Vec::new();
        for seed in 1..=SEEDS {
            let prepared = Prepared::new(Setting::scheimpflug(z, step).scene(FRAMES, seed));
            let frames: Vec<_> = (0..FRAMES).map(|frame| prepared.measure(frame)).collect();
            let scan: Vec<_> = frames.iter().map(|frame| places(&frame.exposure)).collect();
            let (measurement, first) = (&prepared.measurement, &frames[0]);
            let correlation = measurement.frame_correlation(first, 3);
            law = [1, 2]
                .map(|later| {
                    let change = measurement.speckle_change(first, later).expect("a law");
                    [correlation.between(0, later), change.correlation]
                })
                .to_vec();
            add(&mut found[0], &scan, 1);
            add(&mut found[1], &scan, 2);
        }
        for (found, [said, left]) in found.iter().zip(law) {
            let [found, error] = found.with_error();
            let max = said * (1.0 + BLEND / left);
            let nearest = found.clamp(said.min(max), said.max(max));
            assert!(error < 0.03, "{error}: too few columns to tell");
            assert!(
                (found - nearest).abs() < 4.0 * error,
                "z = {z} m: {found:.3} ± {error:.3}, said to be {said:.3} to {max:.3}"
            );
        }
    }
}
