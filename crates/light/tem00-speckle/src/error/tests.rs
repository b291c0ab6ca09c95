//! Refusals of each constructor, by the name of the argument.

use num_complex::Complex;
use tem00_numerics::Grid;
use tem00_testkit::refuses;

use crate::{
    Exposure, Pupil, PupilField, SlicePath, SpeckleError, SpecklePattern, SpeckleStack, StackNeeds,
    StackPlan, Transmission, incoherent_fractions,
};

const UP: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

#[test]
fn fields() {
    refuses!(size = 256, diameter = 128 => PupilField::new(size, diameter, 0);
        size: [1_000_000, 0, 15], size as "diameter": [255], diameter: [129, 7, 0]);
    refuses!(size = [256, 128], speckle_size = 16.0
        => PupilField::from_speckle_size(size, speckle_size, 0);
        size: [[64, 1 << 16], [0, 128]],
        speckle_size: [1.99, 16.1, NAN, UP]);
    let field = |im| {
        let mut samples = Grid::filled(20, 20, Complex::new(1.0_f32, 0.0));
        samples[(3, 2)].im = im;
        samples
    };
    refuses!(samples = field(0.5) => PupilField::from_samples(samples, [64; 2], 4.0);
        samples: [field(f32::NAN)], samples as "column 3 of row 2": [field(f32::INFINITY)]);
    let measured = PupilField::from_samples(field(1.0), [64; 2], 4.0).unwrap();
    refuses!(patterns = 1 => measured.independent(patterns); patterns as "seeded field": [2]);
}

#[test]
fn pupils() {
    let field = PupilField::new(64, 32, 0).unwrap();
    let with = |pupil| field.clone().with_pupil(pupil);
    refuses!(inner = 0.5 => with(Pupil::Annulus { inner }); inner: [0.0, 1.0, -0.5, NAN, UP]);
    refuses!(height = 1.0 => with(Pupil::Rectangle { height });
        height: [0.0, 1.5, -0.5, NAN, UP], height as "pupil": [0.01]);
    refuses!(radius = 0.5 => with(Pupil::Gaussian { radius });
        radius: [0.0, -0.5, NAN, UP], radius as "pupil": [0.1]);
    // π R² C² phasors of equal weight have the same fluctuations.
    let narrow = with(Pupil::Gaussian { radius: 0.1 }).unwrap_err();
    assert!(narrow.to_string().ends_with("got 32"), "{narrow}");
    let disc = |t: f32| Grid::from_fn(4, 4, |x, _| if x == 1 { t } else { 1.0 });
    refuses!(amplitude = 1.0 => Transmission::new(&disc(amplitude));
        amplitude: [1.5, -0.1, f32::NAN, f32::INFINITY]);
    let turned = |t| Transmission::from_complex(disc(t).map(|&t| Complex::new(0.0, t)));
    refuses!(amplitude = -1.0 => turned(amplitude); amplitude: [1.5, f32::NAN, f32::INFINITY]);
    let even = |t: f32| Transmission::new(&Grid::filled(4, 4, t));
    refuses!(amplitude = 1e-45 => even(amplitude); amplitude: [0.0, -0.0]);
}

#[test]
fn light() {
    for axis in [0, 1] {
        let along = |length: f64| core::array::from_fn(|i| if i == axis { length } else { 0.0 });
        refuses!(drift = 1e6 => Exposure::default().with_image_drift(along(drift));
            drift: [1.1e6, -1e30, NAN, UP]);
        refuses!(drift = 128.0 => Exposure::default().with_pupil_drift(along(drift));
            drift: [128.1, NAN, UP]);
    }
    refuses!(patterns = 1, polarisation = 1.0, weights = vec![1.0; 100]
        => incoherent_fractions(patterns, polarisation, &weights);
        patterns: [0, 11, 1025, usize::MAX],
        polarisation: [-1.0, 1.1, NAN, UP],
        weights: [vec![], vec![0.0], vec![1.0, -1.0], vec![NAN], vec![UP]],
    );
    let field = PupilField::new(32, 16, 5).unwrap();
    refuses!(patterns = 1024 => field.independent(patterns); patterns: [0, 1025, usize::MAX]);
    let pattern = |size| PupilField::new(size, 16, 5).unwrap().pattern();
    refuses!(patterns = vec![pattern(32); 2] => SpecklePattern::weighted_mean(&[1.0; 2], patterns);
        patterns: [
            vec![],
            vec![pattern(32)],
            vec![pattern(32); 3],
            vec![pattern(32), pattern(64)],
        ],
    );
}

#[test]
fn stacks() {
    let field = PupilField::new(64, 16, 0).unwrap();
    refuses!(half_period = 1, length = 2
        => SpeckleStack::generate(&field, SlicePath::Straight { half_period, length });
        half_period: [0, 1 << 16, usize::MAX], length: [0, 1, 1 << 16, usize::MAX]);
    refuses!(half_period = 1 => SpeckleStack::generate(&field, SlicePath::Circle { half_period });
        half_period: [0, 1 << 16, usize::MAX]);
    let needs = StackNeeds {
        image: [300.0, 200.0],
        region: [300.0, 200.0],
        speckle_size: 1.5,
        motion: Some(0.0),
        frames: 2,
        memory_limit: 1 << 30,
    };
    refuses!(needs = needs => StackPlan::new(&needs);
        needs.image: [[1.0, 0.0], [1.0, -1.0], [UP, 1.0]],
        needs.region: [[0.0, 1.0], [-1.0, 1.0], [1.0, NAN]],
        needs.speckle_size: [0.0, -1.0, UP],
        needs.motion: [Some(-0.5), Some(NAN)],
    );
    let memory_limit = 1000;
    let small = StackPlan::new(&StackNeeds {
        memory_limit,
        motion: None,
        ..needs
    });
    let [needed, limit] = [8 * 400 * 288, memory_limit];
    assert_eq!(small, Err(SpeckleError::MemoryLimit { needed, limit }));
    // Speckles of a nanometre: no pattern is large enough, with any memory.
    let huge = StackPlan::new(&StackNeeds {
        speckle_size: 1e-4,
        memory_limit: u64::MAX,
        ..needs
    });
    assert_eq!(huge.unwrap_err().parameter(), "size");
}

#[test]
fn messages_say_what_is_allowed_and_what_was_given() {
    for (refused, message) in [
        (
            PupilField::new(256, 129, 0),
            "diameter must be 8 to 128 lattice points, half the size at most, got 129",
        ),
        (
            PupilField::new(0, 0, 0),
            "size must be 16 to 32768 samples, got 0",
        ),
    ] {
        assert_eq!(refused.unwrap_err().to_string(), message);
    }
    let (needed, limit) = (2, 1);
    let error = SpeckleError::MemoryLimit { needed, limit };
    assert!(
        error.to_string().contains("at most 1 bytes, got 2"),
        "{error}"
    );
    assert_eq!(error.parameter(), "memory_limit");
    assert_eq!(SpeckleError::Memory { bytes: 9 }.parameter(), "memory");
}
