mod fixed_pattern;
mod noise;
mod rejected;

use tem00_numerics::Grid;
use tem00_testkit::{assert_absolute, assert_relative, on_threads};

use super::*;
use crate::PhotonTransferPoint;

fn typical() -> Sensor {
    Sensor::new(SensorDescription::typical(12)).unwrap()
}

/// The typical sensor, changed.
fn sensor(change: impl FnOnce(&mut SensorDescription)) -> Sensor {
    let mut description = SensorDescription::typical(12);
    change(&mut description);
    Sensor::new(description).unwrap()
}

#[test]
fn a_joule_of_red_light_is_three_times_ten_to_the_eighteen_photons() {
    // λ / (h c) = 632.8e-9 / 1.986445857e-25 per joule, CODATA 2018.
    let sensor = sensor(|d| {
        d.pixel_pitch = 1.0;
        d.exposure_time = 1.0;
        d.quantum_efficiency = 0.25;
        d.fill_factor = 0.5;
    });
    let photons = sensor.photons(1.0, 632.8e-9);
    // Nine digits are given.
    assert_relative(photons, 3.185_588_96e18, 2e-9);
    // A quarter of twice the photons, for any sensitive part of the pixel.
    assert_relative(sensor.electrons(2.0, 632.8e-9), 0.5 * photons, 1e-15);
    // The sensitive part is a square.
    assert_relative(sensor.sensitive_half_width(), 0.5 * 0.5_f64.sqrt(), 1e-15);
}

#[test]
fn a_full_well_of_the_typical_sensor_is_the_largest_grey_value() {
    for bits in [8, 10, 12, 14, 16] {
        let sensor = Sensor::new(SensorDescription::typical(bits)).unwrap();
        let dark = sensor.dark_electrons();
        let full = sensor.mean_grey_value(10_500.0 - dark);
        assert_absolute(full, f64::from(bits).exp2() - 1.0, 1e-8);
        assert_absolute(sensor.saturation_electrons(), 10_500.0 - dark, 1e-8);
    }
}

#[test]
fn the_signal_is_the_noise_at_the_threshold() {
    let sensor = typical();
    let threshold = sensor.threshold_electrons();
    assert_relative(sensor.signal_to_noise_ratio(threshold), 1.0, 1e-12);
    // Half an electron, and the dark noise with the noise of the dark current, 0.003, and of
    // rounding, 0.75 e⁻.
    let gain: f64 = 4_031.0 / 10_500.0;
    let dark = (2.3_f64.powi(2) + 0.003 + 1.0 / (12.0 * gain * gain) + 0.25).sqrt();
    assert_absolute(threshold, 0.5 + dark, 1e-12);
    assert_absolute(sensor.dynamic_range(), 10_499.997 / threshold, 1e-9);
    // Light at saturation fills the wells.
    let electrons = sensor.electrons(sensor.saturation_irradiance(650e-9), 650e-9);
    assert_relative(electrons, sensor.saturation_electrons(), 1e-14);
}

#[test]
fn the_same_seeds_give_the_same_bits_for_any_number_of_threads() {
    let sensor = typical();
    let electrons = Grid::from_fn(61, 43, |x, y| (3 * x + 5 * y) as f32);
    let with = |threads| on_threads(threads, || sensor.expose(&electrons, 17).unwrap());
    let one = with(1);
    assert_eq!(one, with(2), "two threads");
    assert_eq!(one, with(7), "seven threads");
    assert_ne!(one, sensor.expose(&electrons, 18).unwrap(), "another seed");
}

#[test]
fn wells_that_are_full_and_values_that_are_largest_are_saturated() {
    let by_well = sensor(|d| d.gain = 0.1);
    let frame = by_well.uniform_frame([40, 30], 30_000.0, 1).unwrap();
    assert_eq!(frame.saturated_pixels(), 1_200, "all wells are full");
    // 64 + 0.1 · 10500 with 2.5 e⁻ of noise and offsets: 1114 ± 0.25 DN and rounding, not 4095.
    for &value in frame.values.values() {
        assert!((1_112..=1_116).contains(&value), "{value}");
        let level = by_well.saturation_level();
        assert!(
            f64::from(value) >= level - 0.5,
            "{value} below the level {level}"
        );
    }
    let by_bits = sensor(|d| d.gain = 10.0);
    let frame = by_bits.uniform_frame([40, 30], 1_000.0, 1).unwrap();
    assert_eq!(
        frame.saturated_pixels(),
        1_200,
        "all values are the largest"
    );
    let largest = Grid::filled(40, 30, frame.largest_value());
    assert_eq!(frame.values, largest, "4095");
    let dark = typical().uniform_frame([40, 30], 0.0, 1).unwrap();
    assert_eq!(dark.saturated_pixels(), 0, "nothing clipped");
    let bright = typical().expose(&Grid::filled(3, 3, f32::INFINITY), 0);
    assert_eq!(
        bright.unwrap().saturated_pixels(),
        9,
        "light without end fills the wells"
    );
}
