//! The characteristics of a rendered set-up, beside its budget by formulas.

use std::sync::atomic::AtomicBool;

use tem00::{
    scan::SetupSensor,
    statistics::laws::imaged_line_power_contrast,
    topography::{Estimate, Options, characterise},
    triangulation::{Budget, UncertaintySource, parse_setup},
};

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

/// The root of the sum of squares of what some sources contribute on the reference plane, in metres.
fn contribution(budget: &Budget, sources: &[UncertaintySource]) -> f64 {
    let squares = sources
        .iter()
        .map(|source| budget.contribution(*source).powi(2));
    squares.sum::<f64>().sqrt()
}

fn is(what: &str, found: Estimate, truth: f64) {
    let apart = (found.value - truth).abs();
    assert!(
        apart < 3.5 * found.uncertainty,
        "{what}: {found:?}, {truth}"
    );
}

#[test]
fn a_rendered_set_up_has_the_characteristics_of_its_budget() {
    let setup = parse_setup(SETUP).expect("a set-up");
    let cancel = AtomicBool::new(false);
    let mut sensor = SetupSensor::new(&setup, 16, 5, &|_| (), &cancel);
    let found = characterise(&mut sensor, Options { repetitions: 16 }).expect("it is measured");
    let budget = Budget::at_height(&setup, 0.0).expect("it measures");
    let flat = found.flat.expect("seen");

    // Noise goes with the inverse of a column's power, as shot noise, or of its square. The power is a sum of 1/K² equal grains.
    let (line, speckle) = (setup.line(), setup.line().speckle_size[1]);
    let radius = 0.5 * line.projected_thickness / speckle;
    let grains = imaged_line_power_contrast(radius, 1.0 / speckle).powi(-2);
    let inverse = grains / (grains - 1.0);
    let squares = [
        (UncertaintySource::ShotNoise, inverse),
        (
            UncertaintySource::DarkNoise,
            inverse * grains / (grains - 2.0),
        ),
        (
            UncertaintySource::Quantisation,
            inverse * grains / (grains - 2.0),
        ),
    ]
    .map(|(source, more)| more * budget.contribution(source).powi(2));
    let instrument = squares.iter().sum::<f64>().sqrt();
    let [ratio, uncertainty] = [
        flat.instrument_noise.value,
        flat.instrument_noise.uncertainty,
    ]
    .map(|m| m / instrument);
    // A few dim columns decide.
    assert!(
        (ratio - 1.0).abs() < 0.1 + 3.5 * uncertainty,
        "instrument noise: {ratio} ± {uncertainty}"
    );
    let noise = contribution(&budget, &UncertaintySource::ALL);
    let ratio = flat.measurement_noise.value / noise;
    assert!((ratio - 1.0).abs() < 0.1, "measurement noise: {ratio}");
    // 95 % of normal numbers lie within ± 1.95996 σ; with speckle the line's places are nearly normal.
    let ratio = flat.form[0].value / (2.0 * 1.959_96 * flat.measurement_noise.value);
    assert!((ratio - 1.0).abs() < 0.03, "flat form: {ratio}");

    let response = found.response.expect("seen");
    is("amplification", response.amplification, 1.0);
    let sphere = found.sphere.expect("seen");
    is("size", sphere.size, 0.0);
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
