use super::*;
use crate::TriangulationError;

fn error_of(change: impl FnOnce(&mut SensorDescription)) -> String {
    let mut description = SensorDescription::typical(12);
    change(&mut description);
    Sensor::new(description).unwrap_err().to_string()
}

#[test]
fn every_quantity_has_a_range() {
    type Change = fn(&mut SensorDescription, f64);
    let cases: [(&str, Change, &[f64]); 11] = [
        (
            "quantum_efficiency",
            |d, v| d.quantum_efficiency = v,
            &[0.0, -0.1, 1.01],
        ),
        ("gain", |d, v| d.gain = v, &[0.0, -1.0, 2e6]),
        ("dark_noise", |d, v| d.dark_noise = v, &[-1e-9, 2e6]),
        ("dark_current", |d, v| d.dark_current = v, &[-1.0, 2e12]),
        ("full_well", |d, v| d.full_well = v, &[0.0, 0.5, 2e9]),
        ("prnu", |d, v| d.prnu = v, &[-0.01, 0.11]),
        ("dsnu", |d, v| d.dsnu = v, &[-1.0, 2e6]),
        ("black_level", |d, v| d.black_level = v, &[-1.0, 4_095.0]),
        ("pixel_pitch", |d, v| d.pixel_pitch = v, &[0.0, -1e-6, 2.0]),
        ("fill_factor", |d, v| d.fill_factor = v, &[0.0, 1.1]),
        ("exposure", |d, v| d.exposure_time = v, &[0.0, -1.0, 2e6]),
    ];
    for (name, change, bad) in cases {
        for &value in bad.iter().chain(&[f64::NAN, f64::INFINITY]) {
            let message = error_of(|d| change(d, value));
            let start = format!("{name} must be ");
            assert!(message.starts_with(&start), "{name} = {value}: {message}");
        }
    }
}

#[test]
fn the_bits_are_those_of_sensors() {
    for bits in [0, 1, 9, 11, 17, 32, u32::MAX] {
        let message = error_of(|d| *d = SensorDescription::typical(bits));
        assert!(message.contains("8, 10, 12, 14 or 16"), "{bits}: {message}");
    }
}

#[test]
fn electrons_are_not_negative() {
    for bad in [-1.0, f32::NAN, f32::NEG_INFINITY] {
        let image = Grid::from_fn(3, 2, |x, y| if (x, y) == (2, 1) { bad } else { 1.0 });
        let result = typical().expose(&image, 0);
        assert!(
            matches!(
                result,
                Err(TriangulationError::OutOfRange {
                    parameter: "electrons",
                    ..
                })
            ),
            "{bad}"
        );
    }
    assert!(
        typical().uniform_frame([0, 3], 1.0, 0).is_err(),
        "no pixels"
    );
}

#[test]
fn pairs_have_one_size() {
    let frame = |size| typical().uniform_frame(size, 10.0, 0).unwrap();
    let pair = |a, b| PhotonTransferPoint::of_pair(&frame(a), &frame(b));
    assert!(pair([4, 3], [3, 4]).is_err(), "turned");
    assert!(pair([4, 3], [4, 4]).is_err(), "longer");
    assert!(pair([1, 1], [1, 1]).is_err(), "one pixel has no spread");
}
