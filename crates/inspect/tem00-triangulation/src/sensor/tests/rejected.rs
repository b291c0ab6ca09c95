use tem00_testkit::refuses;

use super::*;
use crate::{SetupDescription, SetupQuantity};

#[test]
fn every_quantity_has_a_range() {
    for quantity in SetupQuantity::of_section("sensor").chain([SetupQuantity::PixelPitch]) {
        let positive = [
            "quantum_efficiency",
            "exposure",
            "gain",
            "fill_factor",
            "pixel_pitch",
        ];
        let min = if positive.contains(&quantity.key()) {
            0.0
        } else {
            -1e-9
        };
        for bad in [min, -1.0, 2e12, f64::NAN, f64::INFINITY] {
            let mut setup = SetupDescription::default();
            quantity.set(&mut setup, bad);
            let error = Sensor::new(setup.sensor).unwrap_err();
            assert_eq!(error.parameter(), Some(quantity.key()), "{bad}: {error}");
        }
    }
    refuses!(sensor = SensorDescription::typical(12) => Sensor::new(sensor);
        sensor.fill_factor: [1.01],
        sensor.prnu: [0.11],
        sensor.black_level: [4095.0],
        sensor.bit_depth: [0, 1, 9, 11, 17, 32, u32::MAX],
    );
}

#[test]
fn electrons_are_not_negative() {
    for bad in [-1.0, f32::NAN, f32::NEG_INFINITY] {
        let image = Grid::from_fn(3, 2, |x, y| if (x, y) == (2, 1) { bad } else { 1.0 });
        let result = typical().expose(&image, 0);
        assert_eq!(result.unwrap_err().parameter(), Some("electrons"), "{bad}");
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
