mod fixed_pattern;
mod noise;
mod rejected;

use tem00_numerics::Grid;

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
    assert!(
        (photons / 3.185_588_96e18 - 1.0).abs() < 2e-9,
        "{photons:e} photons"
    );
    assert!(
        (sensor.electrons(2.0, 632.8e-9) / photons - 0.5).abs() < 1e-15,
        "a quarter of twice the photons, whatever part of the pixel is sensitive"
    );
    assert!(
        (sensor.energy_per_electron(632.8e-9) * photons * 0.25 - 1.0).abs() < 1e-15,
        "the energy of all electrons is a joule"
    );
}

#[test]
fn an_image_of_light_becomes_an_image_of_electrons() {
    let sensor = typical();
    let light = Grid::from_fn(3, 2, |x, y| 0.1 * (x + 3 * y) as f32);
    let electrons = sensor.electron_image(&light, 650e-9);
    for (&e, &light) in electrons.values().iter().zip(light.values()) {
        let expected = sensor.electrons(light.into(), 650e-9);
        // Rounding to f32, 2⁻²⁴.
        assert!(
            (f64::from(e) - expected).abs() <= 6e-8 * expected,
            "{e} for {light} W/m²"
        );
    }
}

#[test]
fn the_sensitive_part_of_a_pixel_is_a_square_of_its_share() {
    let half = sensor(|d| d.fill_factor = 0.49).sensitive_half_width();
    assert!((half - 0.35).abs() < 1e-15, "half width {half}");
}

#[test]
fn a_full_well_of_the_typical_sensor_is_the_largest_grey_value() {
    for bits in [8, 10, 12, 14, 16] {
        let sensor = Sensor::new(SensorDescription::typical(bits)).unwrap();
        let dark = sensor.dark_electrons();
        let full = sensor.mean_grey_value(10_500.0 - dark);
        assert!(
            (full - (f64::from(bits).exp2() - 1.0)).abs() < 1e-8,
            "{bits} bits: {full} DN"
        );
        assert!(
            (sensor.saturation_electrons() - (10_500.0 - dark)).abs() < 1e-8,
            "{bits} bits"
        );
    }
}

#[test]
fn the_signal_is_the_noise_at_the_threshold() {
    let sensor = typical();
    let threshold = sensor.threshold_electrons();
    let ratio = sensor.signal_to_noise_ratio(threshold);
    assert!((ratio - 1.0).abs() < 1e-12, "ratio {ratio}");
    // Half an electron, and the dark noise with that of the dark current, 0.003, and of rounding, 0.75 e⁻.
    let gain: f64 = 4_031.0 / 10_500.0;
    let dark = (2.3_f64.powi(2) + 0.003 + 1.0 / (12.0 * gain * gain) + 0.25).sqrt();
    assert!(
        (threshold - 0.5 - dark).abs() < 1e-12,
        "threshold {threshold} e⁻"
    );
    assert!(
        (sensor.dynamic_range() - 10_499.997 / threshold).abs() < 1e-9,
        "range"
    );
}

#[test]
fn light_at_saturation_fills_the_wells() {
    let sensor = typical();
    let irradiance = sensor.saturation_irradiance(650e-9);
    let electrons = sensor.electrons(irradiance, 650e-9);
    assert!(
        (electrons / sensor.saturation_electrons() - 1.0).abs() < 1e-14,
        "{electrons} e⁻"
    );
}

#[test]
fn the_same_seeds_give_the_same_bits_for_any_number_of_threads() {
    let sensor = typical();
    let electrons = Grid::from_fn(61, 43, |x, y| (3 * x + 5 * y) as f32);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| sensor.expose(&electrons, 17)).unwrap()
    };
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
    // 64 + 0.1 · 10500 with 2.5 e⁻ of noise and offsets: 1114 ± 0.25 DN and rounding.
    let values = frame.values.values();
    assert!(
        values.iter().all(|v| (1_112..=1_116).contains(v)),
        "full wells are not 4095"
    );
    assert!(
        values
            .iter()
            .all(|&v| f64::from(v) >= by_well.saturation_level() - 0.5),
        "no full well lies below the level {}",
        by_well.saturation_level()
    );

    let by_bits = sensor(|d| d.gain = 10.0);
    let frame = by_bits.uniform_frame([40, 30], 1_000.0, 1).unwrap();
    assert_eq!(
        frame.saturated_pixels(),
        1_200,
        "all values are the largest"
    );
    assert!(
        frame
            .values
            .values()
            .iter()
            .all(|&v| v == frame.largest_value()),
        "4095"
    );

    let dark = typical().uniform_frame([40, 30], 0.0, 1).unwrap();
    assert_eq!(
        (dark.saturated_pixels(), dark.pixels_at_zero()),
        (0, 0),
        "nothing clipped"
    );
}

#[test]
fn light_without_end_fills_the_wells() {
    let bright = typical()
        .expose(&Grid::filled(3, 3, f32::INFINITY), 0)
        .unwrap();
    assert_eq!(bright.saturated_pixels(), 9, "all pixels");
}
