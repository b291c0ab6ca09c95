//! Does a computed pattern have the statistics of fully developed speckle?
//!
//! Prints measured values beside the theory: `cargo run --example speckle_statistics`.
#![expect(clippy::print_stdout, reason = "the table is the point")]

use std::error::Error;

use tem00::speckle::PupilField;
use tem00::statistics::{
    Boundary, Contrast, Moments, SpeckleSize, airy_autocovariance, airy_power_spectrum,
    autocovariance, contrast_of_phasor_sum, contrast_squared_spread, decorrelated_samples,
    exponential_cumulative, kolmogorov_smirnov, power_spectrum, radial_average,
};

fn row(quantity: &str, measured: f64, theory: f64) {
    println!("{quantity:<28} {measured:>9.4}   {theory:.4}");
}

fn main() -> Result<(), Box<dyn Error>> {
    // Speckles of four pixels, 128 of them across.
    let field = PupilField::new(512, 128, 1)?;
    let h = field.speckle_size();
    let pattern = field.pattern();
    let image = pattern.values();

    println!("{:<28} {:>9}   theory", "quantity", "measured");
    row("mean", Moments::from_samples(image.values())?.mean(), 1.0);
    let contrast = Contrast::from_samples(image.values())?.with_speckle_size(h)?;
    let theory = contrast_of_phasor_sum(field.phasor_count());
    row("contrast", contrast.value(), theory);
    let spread = 0.5 * contrast_squared_spread(128.0);
    row("its standard error", contrast.standard_error(), spread);

    let lags = autocovariance(image, Boundary::Periodic)?;
    let size = SpeckleSize::from_autocovariance(&lags)?;
    row("speckle size in pixels", size.mean(), h);
    for lag in [1, 2, 3, 5, 8] {
        let theory = airy_autocovariance(f64::from(lag) / h);
        let measured = f64::from(*lags.wrapped(lag.into(), 0));
        row(&format!("autocovariance at {lag} pixels"), measured, theory);
    }

    let step = 1.0 / image.width() as f64;
    let rings = radial_average(&power_spectrum(image)?, [step, step])?;
    for ring in rings.iter().skip(16).step_by(32).take(4) {
        let frequency = ring.radius * h;
        let theory = h * h * airy_power_spectrum(frequency);
        row(
            &format!("spectrum at {frequency:.2} / h"),
            ring.mean,
            theory,
        );
    }

    // Every fifth pixel: the first zero of the autocovariance lies at 1.22 speckle sizes.
    let samples = decorrelated_samples(image, 5)?;
    let outcome = kolmogorov_smirnov(&samples, exponential_cumulative)?;
    println!("exponential? the p-value is {:.3}", outcome.p_value);
    Ok(())
}
