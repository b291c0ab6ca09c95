use core::cell::Cell;

use proptest::prelude::*;
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;

const SHAPES: [PeakShape; 3] = [
    PeakShape::Gaussian,
    PeakShape::Lorentzian,
    PeakShape::Rectangular,
];

fn shaped(linewidth: f64, shape: PeakShape) -> Spectrum {
    Spectrum::new(650e-9, linewidth, shape).unwrap()
}

#[test]
fn coherence_lengths_have_closed_forms() {
    let unit = 650e-9_f64.powi(2) / 3e-9;
    let factors = [(2.0 * LN_2 / PI).sqrt(), PI.recip(), 1.0];
    for (shape, factor) in SHAPES.into_iter().zip(factors) {
        let line = shaped(3e-9, shape);
        assert_relative(line.coherence_length(), factor * unit, 1e-12);
    }
    let single = Spectrum::monochromatic(650e-9).unwrap();
    assert_eq!(single.coherence_length().to_bits(), f64::INFINITY.to_bits());
}

#[test]
fn the_squared_coherence_is_the_transform_of_the_pairs() {
    let single = |shape| shaped(3e-9, shape);
    let comb = |shape| {
        Spectrum::comb(650e-9, 5e-9, 4)
            .unwrap()
            .with_linewidth(0.3e-9, shape)
            .unwrap()
    };
    for line in SHAPES
        .into_iter()
        .flat_map(|shape| [single(shape), comb(shape)])
    {
        if line.shape == PeakShape::Lorentzian {
            continue;
        }
        for path in [1e-6, 20e-6, 90e-6, 200e-6] {
            let mut sum = 0.0;
            for (first, second) in line
                .peaks
                .iter()
                .flat_map(|a| line.peaks.iter().map(move |b| (a, b)))
            {
                let offset = first.offset - second.offset;
                let part = |kappa: f64| line.pair_density(kappa) * ((kappa + offset) * path).cos();
                let half = [[-12.0 * line.width, 0.0], [0.0, 12.0 * line.width]];
                let part: f64 = half
                    .into_iter()
                    .map(|ends| integrate(part, ends, 0.25 * line.width))
                    .sum();
                sum += first.weight * second.weight * part;
            }
            assert_absolute(sum, line.squared_coherence(path), 1e-9);
        }
    }
}

#[test]
fn a_cavity_is_coherent_again_after_a_round_trip() {
    let comb = Spectrum::comb(450e-9, 1e-9, 21).unwrap();
    let spacing = 1e-9 / 20.0;
    let round_trip = 450e-9_f64.powi(2) / spacing;
    assert_absolute(comb.squared_coherence(round_trip), 1.0, 1e-12);
    assert!(comb.squared_coherence(0.5 * round_trip) < 0.01);
    let modes = comb
        .with_linewidth(0.002e-9, PeakShape::Lorentzian)
        .unwrap();
    let alone = Spectrum::new(450e-9, 0.002e-9, PeakShape::Lorentzian).unwrap();
    let (again, once) = (
        modes.squared_coherence(round_trip),
        alone.squared_coherence(round_trip),
    );
    assert_relative(again, once, 1e-12);
}

#[test]
fn spreads_are_those_of_the_shapes() {
    let full = TAU * 3e-9 / 650e-9_f64.powi(2);
    let gaussian = shaped(3e-9, PeakShape::Gaussian).wave_number_spread();
    assert_relative(gaussian, full / (8.0 * LN_2).sqrt(), 1e-12);
    let rectangular = shaped(3e-9, PeakShape::Rectangular).wave_number_spread();
    assert_relative(rectangular, full / 12.0_f64.sqrt(), 1e-12);
    let two = Spectrum::comb(650e-9, 3e-9, 2)
        .unwrap()
        .wave_number_spread();
    assert_relative(two, 0.5 * full, 1e-12);
    let lorentzian = |linewidth| shaped(linewidth, PeakShape::Lorentzian).wave_number_spread();
    assert!(lorentzian(0.0) == 0.0 && lorentzian(3e-9).is_infinite());
}

#[test]
fn a_comb_stands_about_its_wavelength() {
    let half = 0.5 * TAU * 3e-9 / 650e-9_f64.powi(2);
    for count in [2, 3, 8] {
        let comb = Spectrum::comb(650e-9, 3e-9, count).unwrap();
        for (uniform, end) in [(0.0, -half), (1.0, half)] {
            assert_relative(comb.draw(uniform), end, 1e-12);
        }
    }
}

#[test]
fn nodes_have_the_moments_of_the_line() {
    // With more than 24 peaks the widths are neglected.
    for (count, is_wide) in [(1, true), (3, true), (24, true), (25, false)] {
        let comb = Spectrum::comb(650e-9, 4e-9, count).unwrap();
        let modes = comb.clone().with_linewidth(0.1e-9, PeakShape::Gaussian);
        let modes = modes.unwrap();
        let nodes = modes.nodes(modes.width, 1000).unwrap();
        let moment = |power| {
            nodes
                .iter()
                .map(move |[x, weight]| weight * x.powi(power))
                .sum::<f64>()
        };
        let spread = if is_wide { modes } else { comb }.wave_number_spread();
        // A Gaussian ends after 5.5 standard deviations, with 1e-6 of its variance.
        assert_absolute(moment(0), 1.0, 1e-6);
        assert_relative(moment(2).sqrt(), spread, 1e-5);
    }
}

#[test]
fn peaks_stand_about_their_mean() {
    let line = Spectrum::from_peaks(&[[650e-9, 3e300], [651e-9, 1e300]]).unwrap();
    let mean = 0.75 * TAU / 650e-9 + 0.25 * TAU / 651e-9;
    assert_relative(line.wave_number(), mean, 1e-14);
    let moment: f64 = line
        .peaks
        .iter()
        .map(|peak| peak.offset * peak.weight)
        .sum();
    assert!(moment.abs() < 1e-9 * line.wave_number_spread(), "{moment}");
}

#[test]
fn draws_follow_the_line() {
    let single = |shape| shaped(3e-9, shape);
    let comb = Spectrum::comb(650e-9, 5e-9, 3).unwrap();
    let modes = comb
        .clone()
        .with_linewidth(0.3e-9, PeakShape::Gaussian)
        .unwrap();
    for line in [
        single(PeakShape::Gaussian),
        single(PeakShape::Rectangular),
        comb,
        modes,
    ] {
        // Characteristic function of the draws against the degree of coherence.
        for path in [10e-6, 40e-6, 120e-6] {
            let count = 20_000;
            let draws = (0..count).map(|i| line.draw((f64::from(i) + 0.5) / f64::from(count)));
            let mean = draws
                .map(|kappa| Complex::cis(kappa * path))
                .sum::<Complex<f64>>()
                / f64::from(count);
            assert!(
                (mean - line.coherence(path)).norm() < 3e-4,
                "{line:?} {path}"
            );
        }
    }
    // Half of a Lorentzian lies within its half width.
    let line = single(PeakShape::Lorentzian);
    assert_relative(line.draw(0.75), line.width, 1e-12);
    assert_relative(line.draw(0.25), -line.width, 1e-12);
    assert_relative(line.draw(1.0), 0.1 * line.wave_number(), 1e-12);
}

#[test]
fn the_effective_spread_of_a_gaussian_is_its_spread() {
    let gaussian = shaped(3e-9, PeakShape::Gaussian);
    let spread = gaussian.effective_spread();
    assert_relative(spread, gaussian.wave_number_spread(), 1e-6);
}

proptest! {
    #[test]
    fn coherence_is_one_at_most(
        linewidth in 0.0..60e-9_f64, shape in 0..3_usize, count in 1..30_usize,
        path in -1e3..1e3_f64,
    ) {
        let line = Spectrum::comb(650e-9, linewidth, count).unwrap();
        let line = line.with_linewidth(0.1 * linewidth, SHAPES[shape]).unwrap();
        let squared = line.squared_coherence(path);
        prop_assert!((0.0..=1.0 + 1e-12).contains(&squared), "{squared}");
        let mean = line.mean_over_pairs(f64::INFINITY, |_| 1.0);
        prop_assert!((mean - 1.0).abs() < 2e-9, "{mean}");
    }
}

/// Pairs of many peaks, against their sum for a function whose mean over a pair of Gaussians is
/// known.
#[test]
fn many_peaks_are_the_sum_of_their_pairs() {
    let scale = 3e4;
    let wave = |wavelength: f64| TAU / wavelength;
    for (count, linewidth) in [(9, 0.0), (40, 2e-11), (256, 0.0), (256, 1e-10), (256, 5e-9)] {
        let place = |i: u32| f64::from(i) / f64::from(count) + 0.002 * f64::from(i).sin();
        let peaks: Vec<_> = (0..count)
            .map(|i| [650e-9 + 4e-9 * place(i), 1.0 + f64::from(i % 3)])
            .collect();
        let line = Spectrum::from_peaks(&peaks).unwrap();
        let line = line.with_linewidth(linewidth, PeakShape::Gaussian).unwrap();
        let total: f64 = peaks.iter().map(|peak| peak[1]).sum();
        // ∫ exp(−(κ/scale)²) over a Gaussian difference about κ₀.
        let spread = 1.0 + 4.0 * (line.width / scale).powi(2);
        let of_pair = |kappa: f64| (-(kappa / scale).powi(2) / spread).exp() / spread.sqrt();
        let pairs = peaks.iter().flat_map(|a| peaks.iter().map(move |b| (a, b)));
        let expected: f64 = pairs
            .map(|(a, b)| a[1] * b[1] / total.powi(2) * of_pair(wave(a[0]) - wave(b[0])))
            .sum();
        let asked = Cell::new(0_u32);
        let found = line.mean_over_pairs(scale, |kappa| {
            asked.set(asked.get() + 1);
            (-(kappa / scale).powi(2)).exp()
        });
        assert_relative(found, expected, 1e-8);
        // Each of 65,536 pairs with a width takes about 1,500 values.
        let max = if linewidth == 0.0 { 1_200 } else { 2_000_000 };
        assert!(asked.get() < max, "{count} {linewidth:e}: {}", asked.get());
    }
}
