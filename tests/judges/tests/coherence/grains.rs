//! First-order law, frames and grains under a tilt, and what simpler rules make of them.

use core::f64::consts::{LN_2, TAU};

use tem00::{
    coherence::PolychromaticSpeckle,
    numerics::disc_overlap,
    statistics::{IncoherentSum, kolmogorov_smirnov},
};

use super::{
    bench::{Bench, BenchSpectrum, View, plane_of_incidence},
    contrast::cell,
    heights::Heights,
    sums::{Moments, assert_agrees, assert_refutes, contrast, covariance, for_surfaces},
};

const STEPS: i32 = 10;
/// Where the pupil stands in later frames, in diameters along the tilt and across it.
const FRAMES: [[f64; 2]; 4] = [[0.25, 0.0], [0.0, 0.25], [0.5, 0.0], [0.0, 0.5]];
/// One speckle along the tilt and across it, in pixels.
const LAGS: [[usize; 2]; 2] = [[2, 0], [0, 2]];

/// What is measured on one surface.
struct Measured {
    still: Moments,
    frames: [Moments; 4],
    lags: [Moments; 2],
    samples: Vec<f64>,
}

/// A line whose standard deviation moves the field by 0.15 diameters of the pupil.
fn tilted(heights: Heights) -> (Bench, BenchSpectrum) {
    let view = plane_of_incidence(0.0, 30.0);
    let bench = Bench::new(view, [20, 8], heights);
    let spread = 0.15 * 20.0 * bench.step;
    let linewidth = spread * (8.0 * LN_2).sqrt() * view.wavelength.powi(2) / TAU;
    let spectrum = BenchSpectrum::gaussian(bench.view.wavelength, bench.step, STEPS, linewidth);
    (bench, spectrum)
}

fn measured(bench: &Bench, spectrum: &BenchSpectrum, count: u64) -> Vec<Measured> {
    let moved = FRAMES.map(|pupil| View {
        pupil,
        ..View::default()
    });
    let views = [&[View::default()][..], &moved].concat();
    let pixels = bench.pixels();
    for_surfaces(count, 3, |random| {
        let surface = bench.surface(random, |_| 1.0);
        let images = bench.images(&surface, STEPS, &views, random);
        let frames: Vec<Vec<f64>> = images.iter().map(|images| spectrum.mix(images)).collect();
        let product = |second: &[f64], lag| {
            Moments::of_products([&frames[0], second], &images[0], lag, pixels)
        };
        // Grains are independent 1.5 speckles apart.
        let places = (0..pixels[1] - 2).step_by(3);
        let samples = places.flat_map(|y| (0..pixels[0] - 2).step_by(3).map(move |x| (x, y)));
        Measured {
            still: product(&frames[0], [0, 0]),
            frames: core::array::from_fn(|i| product(&frames[i + 1], [0, 0])),
            lags: LAGS.map(|lag| product(&frames[0], lag)),
            samples: samples.map(|(x, y)| frames[0][y * pixels[0] + x]).collect(),
        }
    })
}

fn all<'a>(surfaces: &'a [Measured], part: impl Fn(&'a Measured) -> Moments) -> Vec<Moments> {
    surfaces.iter().map(part).collect()
}

#[test]
fn frames_grains_and_intensities_of_a_tilted_plate_are_those_of_the_law() {
    for (rms, count) in [(0.0, 200), (1.0e-6, 120)] {
        let heights = match rms {
            0.0 => Heights::Flat,
            rms => Heights::Dense { rms, strata: 3 },
        };
        let (bench, spectrum) = tilted(heights);
        let surfaces = measured(&bench, &spectrum, count);
        let cell = cell(bench.view, rms, 0.0);
        let law = PolychromaticSpeckle {
            spectrum: &spectrum.line,
            cell: &cell,
        };
        let squared = law.contrast().powi(2);
        assert_agrees(
            "contrast",
            contrast(&all(&surfaces, |s| s.still)),
            law.contrast(),
            0.01,
        );
        for (i, moved) in FRAMES.into_iter().enumerate() {
            let waves = covariance(&all(&surfaces, |s| s.frames[i]));
            let expected = law.covariance(moved);
            let name = format!("height {rms:e} m, frame {moved:?}");
            // Patterns of fixed shares that all move alike.
            let shares = squared * disc_overlap(moved[0].hypot(moved[1])).powi(2);
            assert_agrees(&name, waves, expected, 0.02);
            if (expected - shares).abs() > 0.05 {
                assert_refutes(&name, waves, shares);
            }
        }
        for (i, lag) in LAGS.into_iter().enumerate() {
            let waves = covariance(&all(&surfaces, |s| s.lags[i]));
            let expected = law.autocovariance(lag.map(|pixels| 0.5 * pixels as f64));
            assert_agrees(
                &format!("height {rms:e} m, lag {lag:?}"),
                waves,
                expected,
                0.015,
            );
        }
        let samples = surfaces.into_iter().flat_map(|s| s.samples).collect();
        judge_first_order_law(&format!("height {rms:e} m"), samples, &law);
    }
}

/// Asserts that intensities follow the law of the modes, and no simpler one.
fn judge_first_order_law(name: &str, mut samples: Vec<f64>, law: &PolychromaticSpeckle<'_>) {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    samples.iter_mut().for_each(|value| *value /= mean);
    let test = |cumulative: &dyn Fn(f64) -> f64| {
        kolmogorov_smirnov(&samples, cumulative).expect("samples")
    };
    let modes = IncoherentSum::new(&law.modes()).expect("modes");
    let right = test(&|x| modes.cumulative(x));
    assert!(right.p_value > 1e-3, "{name}: {right:?}");

    let patterns = IncoherentSum::new(&[1.0; 2]).expect("two patterns");
    let contrast = law.contrast();
    let with_mean = |x: f64| -(-(x - 1.0 + contrast).max(0.0) / contrast).exp_m1();
    for (rule, wrong) in [
        ("mixed with the mean", test(&with_mean)),
        ("two patterns", test(&|x| patterns.cumulative(x))),
    ] {
        assert!(wrong.p_value < 1e-6, "{rule}, {name}: {wrong:?}");
    }
}
