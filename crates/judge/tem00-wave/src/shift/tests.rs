use tem00_testkit::assert_absolute;

use super::*;
use crate::random::{Purpose, Random};

/// Side and period of a pattern.
const SIDE: usize = 128;

/// A real pattern of random waves with up to a fifth of a period per sample, as its spectrum: the
/// phases of the waves displace it exactly.
struct Waves {
    spectrum: Grid<Complex<f64>>,
}

impl Waves {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed, Purpose::Positions);
        let mut spectrum = Grid::filled(SIDE, SIDE, Complex::new(0.0, 0.0));
        for y in 0..SIDE {
            for x in 0..SIDE {
                if wave_number(x, y).length() <= TAU / 5.0 {
                    spectrum[(x, y)] = random.complex_gaussian();
                }
            }
        }
        Self { spectrum }
    }

    /// The pattern, displaced, in the corner of the given size.
    fn pattern(&self, size: [usize; 2], offset: DVec2) -> Grid<f32> {
        let displaced = Grid::from_fn(SIDE, SIDE, |x, y| {
            // The transform sums exp(−ik·r), so a displacement of r is exp(+ik·offset).
            let phase = Complex::from_polar(1.0, wave_number(x, y).dot(offset));
            let wave = self.spectrum[(x, y)] * phase;
            #[expect(
                clippy::cast_possible_truncation,
                reason = "the transform works in f32"
            )]
            let wave = Complex::new(wave.re as f32, wave.im as f32);
            wave
        });
        let transform = Fft2::new(SIDE, SIDE).expect("a transform");
        let whole = transform.forward(&displaced, |_, _, value| value.re);
        Grid::from_fn(size[0], size[1], |x, y| whole[(x, y)])
    }
}

fn wave_number(x: usize, y: usize) -> DVec2 {
    let along = |i: usize| {
        if 2 * i < SIDE {
            i as f64
        } else {
            i as f64 - SIDE as f64
        }
    };
    DVec2::new(along(x), along(y)) * TAU / SIDE as f64
}

#[test]
fn a_band_limited_pattern_is_found_where_it_was_put() {
    let size = [96, 128];
    for (seed, offset) in [
        (0, DVec2::ZERO),
        (1, DVec2::new(0.5, -0.5)),
        (2, DVec2::new(0.123, 0.789)),
        (3, DVec2::new(-7.3, 3.4)),
        (4, DVec2::new(21.7, -30.2)),
        (5, DVec2::new(-48.1, 60.9)),
    ] {
        let waves = Waves::new(seed);
        let first = waves.pattern(size, DVec2::ZERO);
        let second = waves.pattern(size, offset);
        let shift = displacement_between(&first, &second).expect("a maximum");
        let error = (shift.offset - offset).length();
        // Two refinements after the first leave 10⁻⁴ of at most half a sample.
        assert!(error < 5e-5, "seed {seed}: {offset} off by {error:e}");
        assert!(shift.correlation > 1.0 - 1e-5, "{}", shift.correlation);
    }
}

#[test]
fn correlation_is_what_is_left_of_a_displaced_pattern() {
    const SEEDS: u32 = 16;
    let offset = DVec2::new(5.3, -2.6);
    for rho in [0.3_f32, 0.5, 0.8] {
        let (mut error, mut correlation) = (DVec2::ZERO, 0.0);
        for seed in 0..u64::from(SEEDS) {
            let [common, other] = [seed, 1_000 + seed].map(Waves::new);
            let first = common.pattern([SIDE; 2], DVec2::ZERO);
            let kept = common.pattern([SIDE; 2], offset);
            let new = other.pattern([SIDE; 2], offset);
            let second = Grid::from_fn(SIDE, SIDE, |x, y| {
                rho * kept[(x, y)] + (1.0 - rho * rho).sqrt() * new[(x, y)]
            });
            let shift = displacement_between(&first, &second).expect("a maximum");
            error += (shift.offset - offset) / f64::from(SEEDS);
            correlation += shift.correlation / f64::from(SEEDS);
        }
        // Of the 2058 waves, the common part and its taper leave K = 1200 independent features, and
        // 16 patterns 16 times as many. A correlation scatters by (1 − ρ²)/√K and a displacement by
        // √(1 − ρ²) / (ρ k √K) with the rms wave number k = (2π/5)/2; four of them.
        let (rho, root) = (f64::from(rho), (1_200.0 * f64::from(SEEDS)).sqrt());
        let scatter = (1.0 - rho * rho) / root;
        assert_absolute(correlation, rho, 4.0 * scatter);
        let scatter = (1.0 - rho * rho).sqrt() / (rho * 0.628 * root);
        assert!(
            error.abs().max_element() < 4.0 * scatter,
            "{error} at {rho}"
        );
    }
}

#[test]
fn patterns_without_features_have_no_displacement() {
    let waves = Waves::new(1).pattern([32, 32], DVec2::ZERO);
    let constant = Grid::filled(32, 32, 3.0);
    let mut broken = waves.clone();
    broken[(4, 7)] = f32::NAN;
    for other in [constant, broken] {
        assert_eq!(displacement_between(&waves, &other), None);
        assert_eq!(displacement_between(&other, &waves), None);
    }
}

#[test]
fn the_scale_of_a_pattern_does_not_matter() {
    let waves = Waves::new(1);
    let first = waves.pattern([64, 64], DVec2::ZERO);
    let second = waves.pattern([64, 64], DVec2::new(1.25, 0.5));
    let plain = displacement_between(&first, &second).expect("a maximum");
    for scale in [1e-30_f32, 1e30] {
        let scaled = displacement_between(&first.map(|v| v * scale), &second.map(|v| 2.0 + v));
        let offset = scaled.expect("a maximum").offset;
        // Rounding of the patterns.
        assert!(
            (offset - plain.offset).length() < 1e-4,
            "{offset} at {scale:e}"
        );
    }
}

#[test]
#[should_panic(expected = "patterns of different sizes")]
fn patterns_must_have_one_size() {
    let _ = displacement_between(&Grid::filled(32, 16, 0.0), &Grid::filled(16, 32, 0.0));
}
