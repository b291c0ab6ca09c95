//! The characteristics of a rendered set-up, beside its budget by formulas.

use std::sync::atomic::AtomicBool;

use tem00::{
    scan::SetupSensor,
    statistics::laws::imaged_line_power_contrast,
    topography::{Estimate, Options, characterise},
    triangulation::{Budget, Setup, UncertaintySource, parse_setup},
};
use tem00_testkit::{assert_absolute, assert_relative};

const SETUP: &str = r#"
[laser]
wavelength = "660 nm"
power = "10 mW"
line_thickness = "0.2 mm"
line_length = "70 mm"

[camera]
focal_length = "25 mm"
f_number = 8
pixel_pitch = "3.45 um"
resolution = [420, 200]
distance = "300 mm"
angle = "30 deg"

[sensor]
quantum_efficiency = 0.6
exposure = "auto"

[surface]
reflectance = 0.4

[detector]
window = 21
"#;

fn is(found: Estimate, truth: f64) {
    assert_absolute(found.value, truth, 3.5 * found.uncertainty);
}

/// The noise of repeated measurements at one place. It goes with the inverse of a column's power,
/// as shot noise, or of its square; the power is a sum of 1/K² equal grains.
fn instrument_noise(setup: &Setup, budget: &Budget) -> f64 {
    let (line, speckle) = (setup.line(), setup.line().speckle_size[1]);
    let radius = 0.5 * line.projected_thickness / speckle;
    let grains = imaged_line_power_contrast(radius, 1.0 / speckle).powi(-2);
    let inverse = grains / (grains - 1.0);
    let inverse_square = inverse * grains / (grains - 2.0);
    let squares = [
        (UncertaintySource::ShotNoise, inverse),
        (UncertaintySource::DarkNoise, inverse_square),
        (UncertaintySource::Quantisation, inverse_square),
    ]
    .map(|(source, more)| more * budget.contribution(source).powi(2));
    squares.iter().sum::<f64>().sqrt()
}

#[test]
fn a_rendered_set_up_has_the_characteristics_of_its_budget() {
    let setup = parse_setup(SETUP).expect("a set-up");
    let cancel = AtomicBool::new(false);
    let mut sensor = SetupSensor::new(&setup, 8, 5, &|_| (), &cancel);
    let found = characterise(&mut sensor, Options { repetitions: 16 }).expect("it is measured");
    let budget = Budget::at_height(&setup, 0.0).expect("it measures");
    let flat = found.flat.expect("seen");

    assert_relative(flat.measurement_noise.value, budget.combined(), 0.1);
    // A few dim columns decide.
    let instrument = instrument_noise(&setup, &budget);
    let allowed = 0.1 * instrument + 3.5 * flat.instrument_noise.uncertainty;
    assert_absolute(flat.instrument_noise.value, instrument, allowed);
    // 95 % of normal numbers lie within ± 1.95996 σ; with speckle the line's places are nearly
    // normal.
    let of_noise = 2.0 * 1.959_96 * flat.measurement_noise.value;
    assert_relative(flat.form[0].value, of_noise, 0.03);

    let response = found.response.expect("seen");
    is(response.amplification, 1.0);
    let sphere = found.sphere.expect("seen");
    is(sphere.size, 0.0);
    // A column sees grooves down to its own width and that of the lens's image of an edge.
    let [along_profile, along_scan] = found.grooves.map(|grooves| grooves.expect("seen"));
    let columns = along_profile.resolution.expect("crossed").value / found.field.column;
    assert!((0.3..2.0).contains(&columns), "{columns} columns");
    // The wall on the camera's side hides the middle of grooves narrower than 2 h tan θ.
    let hidden = 2.0 * along_scan.depth * 30_f64.to_radians().tan();
    let resolution = along_scan.resolution.expect("crossed").value;
    assert!(
        (hidden..3.0 * hidden).contains(&resolution),
        "{resolution:e}, {hidden:e}"
    );
}
