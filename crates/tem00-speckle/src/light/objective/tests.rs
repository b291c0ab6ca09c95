use tem00_statistics::{LitArea as LitByLaw, ObjectiveSpeckle as Law};

use super::*;
use crate::error::assert_refused;

const WAVELENGTH: f64 = 532e-9;
const DISTANCE: f64 = 0.8;

fn speckle(area: LitArea) -> ObjectiveSpeckle {
    ObjectiveSpeckle::new(WAVELENGTH, DISTANCE, area).unwrap()
}

/// Pairs of what is lit here and in the closed form.
fn areas() -> [(LitArea, LitByLaw); 3] {
    let (width, height, radius) = (1.5e-3, 0.9e-3, 0.3e-3);
    [
        (
            LitArea::Disc { diameter: width },
            LitByLaw::Disc { diameter: width },
        ),
        (
            LitArea::Rectangle { width, height },
            LitByLaw::Rectangle { width, height },
        ),
        (
            LitArea::GaussianSpot { radius },
            LitByLaw::GaussianSpot { radius },
        ),
    ]
}

#[test]
fn the_field_on_the_screen_is_correlated_as_the_lit_area_demands() {
    for (area, law) in areas() {
        let law = Law::new(WAVELENGTH, DISTANCE, law).unwrap();
        let ours = speckle(area);
        let pitch = ours.speckle_size() / 2.5;
        let field = ours.field([400, 300], pitch, 1).unwrap();
        for lag in [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.5],
            [2.0, 2.5],
            [-4.0, 3.0],
            [6.5, 0.0],
        ] {
            let exact = field.amplitude_correlation(lag).norm_sqr();
            let expected = law.autocovariance(lag.map(|samples| samples * pitch));
            // A rectangle of 161 by 73 lattice points for 160 by 72 has speckles finer by 1/160 and
            // 1/72, and its correlation a slope of 1.1 per logarithm of the lag at most; a disc's rim
            // averages out, the cut of a Gaussian leaves √4e−6 of its amplitude.
            let tolerance = match area {
                LitArea::Rectangle { .. } => 1.1 / 72.0,
                _ => 2e-3,
            };
            assert!(
                (exact - expected).abs() < tolerance,
                "{exact} for {expected} of {area:?} at {lag:?}"
            );
        }
    }
}

#[test]
fn speckles_are_as_large_as_the_wavelength_times_the_distance_over_the_width() {
    let ring = LitArea::Ring {
        outer: 2e-3,
        inner: 1e-3,
    };
    // λz / W = 532 nm · 0.8 m / 2 mm.
    assert!(
        (speckle(ring).speckle_size() - 212.8e-6).abs() < 1e-12,
        "ring"
    );
    for (area, law) in areas() {
        let law = Law::new(WAVELENGTH, DISTANCE, law).unwrap().size()[0];
        let ratio = match area {
            // Cut off at five radii; the law counts two.
            LitArea::GaussianSpot { .. } => 2.0 / 5.0,
            _ => 1.0,
        };
        let size = speckle(area).speckle_size();
        assert!(
            (size / (ratio * law) - 1.0).abs() < 1e-14,
            "{area:?}: {size}"
        );
    }
}

#[test]
fn a_ring_is_an_annular_pupil() {
    let ring = LitArea::Ring {
        outer: 2e-3,
        inner: 0.5e-3,
    };
    let field = speckle(ring).field([64, 64], 80e-6, 3).unwrap();
    assert_eq!(field.pupil(), &Pupil::Annulus { inner: 0.25 });
}

#[test]
fn the_surface_takes_its_phasors_along() {
    let speckle = speckle(LitArea::Disc { diameter: 2e-3 });
    let field = speckle.field([64, 64], 80e-6, 3).unwrap();
    let [offset, _] = speckle.offset([0.5e-3, 0.0]);
    assert!((offset + 0.25).abs() < 1e-15, "{offset}");
    // What was at the centre of the light is then a quarter of its width to the right of it: the
    // pupil's centre stands to its left on the lattice.
    let after = field.speckle([offset, 0.0], 0.0);
    let before = field.speckle([0.0, 0.0], 0.0);
    let pairs = after.values().values().iter().zip(before.values().values());
    let shift = offset * field.diameter()[0];
    let sum: crate::Complex<f64> = pairs
        .enumerate()
        .map(|(index, (a, b))| {
            let product = a * b.conj();
            // Into the frame of the lattice.
            let turns = -shift.round() * f64::from(u8::try_from(index % 64).unwrap()) / 64.0;
            let common = crate::Complex::cis(core::f64::consts::TAU * turns);
            crate::Complex::new(f64::from(product.re), f64::from(product.im)) * common
        })
        .sum();
    let overlap = Pupil::Circle.overlap([0.25, 0.0]);
    // The rim of a disc of 24 points is counted to one in a hundred.
    assert!(
        (sum.norm() / 4096.0 - overlap).abs() < 0.02,
        "{sum} for {overlap}"
    );
}

#[test]
fn lengths_outside_their_range_are_refused() {
    let disc = LitArea::Disc { diameter: 1e-3 };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let speckle = ObjectiveSpeckle::new(bad, 1.0, disc);
        assert_refused(
            speckle,
            "wavelength must be a positive finite number of metres",
            bad,
        );
        let speckle = ObjectiveSpeckle::new(1e-6, bad, disc);
        assert_refused(
            speckle,
            "distance must be a positive finite number of metres",
            bad,
        );
        for area in [
            LitArea::Disc { diameter: bad },
            LitArea::Ring {
                outer: 1.0,
                inner: bad,
            },
            LitArea::Rectangle {
                width: 1.0,
                height: bad,
            },
            LitArea::GaussianSpot { radius: bad },
        ] {
            let speckle = ObjectiveSpeckle::new(1e-6, 1.0, area);
            assert_refused(
                speckle,
                "area must be a positive finite number of metres",
                bad,
            );
        }
        let field = self::speckle(disc).field([64, 64], bad, 0);
        assert_refused(
            field,
            "sample_pitch must be a positive finite number of metres",
            bad,
        );
    }
    let ring = LitArea::Ring {
        outer: 1e-3,
        inner: 2e-3,
    };
    let speckle = ObjectiveSpeckle::new(1e-6, 1.0, ring);
    assert_refused(
        speckle,
        "inner must be inside (0, 1), in units of the outer diameter",
        2,
    );
    let tall = LitArea::Rectangle {
        width: 1e-3,
        height: 2e-3,
    };
    let speckle = ObjectiveSpeckle::new(1e-6, 1.0, tall);
    assert_refused(
        speckle,
        "height must be positive and at most 1, in units of the width",
        2,
    );
    for pitch in [1e-30, 1.0, 1e30] {
        let field = self::speckle(disc).field([64, 64], pitch, 0);
        assert_eq!(field.unwrap_err().parameter(), "speckle_size", "{pitch}");
    }
}
