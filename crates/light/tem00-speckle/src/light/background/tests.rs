use core::f64::consts::{PI, TAU};

use proptest::prelude::*;
use tem00_numerics::Grid;
use tem00_statistics::{CoherentBackground, decorrelated_samples, kolmogorov_smirnov, t_test_mean};

use super::*;
use crate::{PupilField, error::assert_refused};

#[test]
fn mean_and_contrast_of_patterns_follow_the_beam_ratio() {
    for beam_ratio in [0.2, 1.0, 6.0] {
        let share = 1.0 / (1.0 + beam_ratio);
        let phasors = PupilField::new(64, 32, 0).unwrap().phasor_count();
        let (mut means, mut squares) = (Vec::new(), Vec::new());
        for seed in 0..32 {
            let field = PupilField::new(64, 32, seed).unwrap();
            let pattern = field.field().on_background(beam_ratio, 1.2).unwrap();
            let mean = |of: &dyn Fn(f64) -> f64| {
                let values = pattern.values().values();
                values.iter().map(|&i| of(f64::from(i))).sum::<f64>() / 4096.0
            };
            means.push(mean(&|i| i));
            squares.push(mean(&|i| (i - 1.0).powi(2)));
        }
        // a = 1/(1+r): speckle a² (1 − 1/N) and its product with the background 2 a (1 − a).
        let expected = share * (2.0 - share) - share * share / phasors as f64;
        for (samples, expected) in [(means, 1.0), (squares, expected)] {
            // α = 1e−4 each; the tiles are independent.
            let outcome = t_test_mean(&samples, expected).unwrap();
            assert!(
                outcome.p_value > 1e-4,
                "{outcome:?} at r = {beam_ratio}, {expected}"
            );
        }
    }
}

#[test]
fn intensities_follow_the_law() {
    for beam_ratio in [0.5, 3.0] {
        let law = CoherentBackground::new(beam_ratio).unwrap();
        let tile = |seed| {
            let field = PupilField::new(320, 80, seed).unwrap();
            let pattern = field.field().on_background(beam_ratio, 1.2).unwrap();
            decorrelated_samples(pattern.values(), 5).unwrap()
        };
        let samples: Vec<_> = (0..2).flat_map(tile).collect();
        // Stride 5 at a speckle size of 4 for the speckle; its product with the background follows the
        // amplitude, whose correlation there is below 0.02. The mean of a tile is off by
        // √(2r/N)/(1+r) = 0.01, a quarter of the critical distance 2.2/√8192. α = 1e−4.
        let outcome = kolmogorov_smirnov(&samples, |i| law.cumulative(i)).unwrap();
        assert!(outcome.p_value > 1e-4, "{outcome:?} at r = {beam_ratio}");
    }
}

#[test]
fn the_limits_are_speckle_alone_and_a_uniform_wave() {
    let field = PupilField::new(32, 16, 1).unwrap().field();
    let speckle = field.to_pattern();
    let none = field.on_background(0.0, 1.2).unwrap();
    for (a, b) in none.values().values().iter().zip(speckle.values().values()) {
        assert!((a - b).abs() <= 1e-6 * b, "{a} for {b}");
    }
    let uniform = field.on_background(1e12, 1.2).unwrap();
    for &intensity in uniform.values().values() {
        // 2 |U| / √r, with |U|² below 16.
        assert!((intensity - 1.0).abs() < 8.2e-6, "{intensity}");
    }
}

#[test]
fn four_phases_give_the_amplitude_back() {
    let field = PupilField::new(32, 16, 2).unwrap().field();
    let steps =
        [0.0, 0.5, 1.0, 1.5].map(|half_turns| field.on_background(2.0, half_turns * PI).unwrap());
    for (index, amplitude) in field.values().values().iter().enumerate() {
        let i = steps
            .each_ref()
            .map(|step| f64::from(step.values().values()[index]));
        // (1 + r) (I₀ − I_π) = 4 √r Re U, and the sines likewise.
        let scale = 3.0 / (4.0 * 2.0_f64.sqrt());
        let (re, im) = (scale * (i[0] - i[2]), scale * (i[1] - i[3]));
        let error = (re - f64::from(amplitude.re)).hypot(im - f64::from(amplitude.im));
        // f32 of intensities below ten.
        assert!(error < 3e-6, "{re} + {im}i for {amplitude}");
    }
}

#[test]
fn backgrounds_outside_their_range_are_refused() {
    let field = PupilField::new(32, 16, 2).unwrap().field();
    for bad in [-1e-9, 1.1e12, f64::NAN, f64::INFINITY] {
        let background = field.on_background(bad, 0.0);
        assert_refused(background, "beam_ratio must be 0 to 1e12", bad);
    }
    for bad in [f64::NAN, f64::INFINITY] {
        let background = field.on_background(1.0, bad);
        assert_refused(background, "phase must be finite, in radians", bad);
    }
}

proptest! {
    #[test]
    fn any_background_gives_an_intensity_between_the_two_waves(
        ratio in -30.0..12.0_f64, phase in -TAU..TAU, re in -1e30..1e30_f32, scale in -30.0..0.0_f32,
    ) {
        let ratio = 10.0_f64.powf(ratio);
        let amplitude = Complex::new(re, 0.5 * re) * 10.0_f32.powf(scale);
        let field = SpeckleField::new(Grid::filled(1, 1, amplitude), 4.0);
        let pattern = field.on_background(ratio, phase).unwrap();
        let intensity = f64::from(pattern.values()[(0, 0)]);
        let (a, b) = (f64::from(amplitude.re).hypot(f64::from(amplitude.im)), ratio.sqrt());
        let [least, most] = [(a - b).powi(2), (a + b).powi(2)].map(|i| i / (1.0 + ratio));
        // Rounding of the two waves, and of the intensity to single precision.
        let rounding = 1e-14 * most + 1e-7 * intensity;
        prop_assert!(intensity >= least - rounding && intensity <= most + rounding);
    }
}
