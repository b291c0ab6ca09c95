use super::*;
use crate::random::{Purpose, Random};

/// A periodic pattern of waves up to a fifth of the sampling frequency, as the sum of cosines: it
/// can be displaced exactly.
struct Waves {
    waves: Vec<(DVec2, f64, f64)>,
}

impl Waves {
    fn new(seed: u64, size: usize) -> Self {
        let mut random = Random::new(seed, Purpose::Positions);
        let most = size as f64 / 5.0;
        let mut wave = || {
            let number = DVec2::new(random.uniform(), random.uniform()) * 2.0 - 1.0;
            let k = (number * most).round() * TAU / size as f64;
            (k, TAU * random.uniform(), random.gaussian())
        };
        Self {
            waves: (0..60).map(|_| wave()).collect(),
        }
    }

    fn pattern(&self, size: [usize; 2], offset: DVec2) -> Grid<f32> {
        Grid::from_fn(size[0], size[1], |x, y| {
            let at = DVec2::new(x as f64, y as f64) - offset;
            let wave = |(k, phase, height): &(DVec2, f64, f64)| height * (k.dot(at) + phase).cos();
            #[expect(
                clippy::cast_possible_truncation,
                reason = "patterns are stored as f32"
            )]
            let value = self.waves.iter().map(wave).sum::<f64>() as f32;
            value
        })
    }
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
        let waves = Waves::new(seed, 128);
        let first = waves.pattern(size, DVec2::ZERO);
        let second = waves.pattern(size, offset);
        let shift = displacement_between(&first, &second).expect("a maximum");
        let error = (shift.offset - offset).length();
        // Two refinements after the first leave 10⁻⁴ of at most half a sample.
        assert!(error < 5e-5, "seed {seed}: {offset} off by {error:e}");
        assert!(shift.correlation > 1.0 - 1e-5, "{}", shift.correlation);
    }
}
