//! The look-ups as printed in Bergmann et al. 2016 against ours: what of the contrast is left
//! between samples and between slices.

use tem00::{
    speckle::{PupilField, SlicePath, SpeckleStack},
    statistics::{Contrast, Moments},
};
use tem00_paper::BilinearStack;

/// The squared contrast of a look-up over the cells of a tile, at one fraction of each.
fn squared_contrast(size: usize, [fx, fy]: [f64; 2], look_up: impl Fn(f64, f64) -> f64) -> f64 {
    // The printed period is one less than the size.
    let cells = size - 1;
    let at = |i: usize| look_up((i % cells) as f64 + fx, (i / cells) as f64 + fy);
    let values: Vec<_> = (0..cells * cells).map(at).collect();
    Contrast::from_samples(&values)
        .expect("a bright pattern")
        .value()
        .powi(2)
}

/// Two look-ups made of the same fields.
struct Pair {
    printed: BilinearStack,
    ours: SpeckleStack,
}

impl Pair {
    fn new(field: &PupilField, half_period: usize) -> Self {
        Self {
            printed: BilinearStack::generate(field, half_period).expect("a small stack"),
            ours: SpeckleStack::generate(field, SlicePath::Circle { half_period })
                .expect("a small stack"),
        }
    }

    /// The squared contrasts of the printed look-up and of ours, over that of the two slices.
    fn shares(&self, fractions: [f64; 2], u: f64) -> [f64; 2] {
        let size = self.printed.size()[0];
        let sampled =
            |u: f64| squared_contrast(size, [0.0; 2], |x, y| self.ours.intensity_at(x, y, u));
        let sampled = if u.fract() > 0.0 {
            0.5 * (sampled(u.floor()) + sampled(u.ceil()))
        } else {
            sampled(u)
        };
        let printed = squared_contrast(size, fractions, |x, y| self.printed.intensity_at(x, y, u));
        let ours = squared_contrast(size, fractions, |x, y| self.ours.intensity_at(x, y, u));
        [printed / sampled, ours / sampled]
    }
}

/// The shares over tiles: over those of one tile most of its own fluctuation cancels.
fn shares(field: &PupilField, half_period: usize, fractions: [f64; 2], u: f64) -> [Vec<f64>; 2] {
    const TILES: u64 = 12;
    let tile = |seed| Pair::new(&field.clone().with_seed(seed), half_period).shares(fractions, u);
    let both: Vec<_> = (0..TILES).map(tile).collect();
    [0, 1].map(|which| both.iter().map(|shares| shares[which]).collect())
}

/// The figures of the documentation: contrasts half-way.
#[test]
fn the_gain_is_as_stated() {
    let root = |shares: &[f64]| Moments::from_samples(shares).expect("tiles").mean().sqrt();
    for (size, stated) in [(96, 0.757), (192, 0.927), (384, 0.981)] {
        let field = PupilField::new(size, 48, 0).expect("a valid field");
        let [printed, ours] = shares(&field, 1, [0.5; 2], 0.0).map(|shares| root(&shares));
        // C = 48 is off the disc by 1e−3; the mean of twelve shares spreads by 1e−3, here four of
        // it.
        assert!(
            (printed - stated).abs() < 5e-3,
            "printed {printed}, stated {stated}"
        );
        assert!((ours - 1.0).abs() < 5e-3, "ours {ours}");
    }
    for (half_period, stated) in [(4, 0.799), (8, 0.885), (16, 0.940)] {
        let field = PupilField::new(96, 48, 0).expect("a valid field");
        let [printed, ours] =
            shares(&field, half_period, [0.0; 2], 1.5).map(|shares| root(&shares));
        // Rounded centres change γ by 1.8/48 at most, and the contrast by a quarter of that.
        assert!(
            (printed - stated).abs() < 0.015,
            "printed {printed}, stated {stated}"
        );
        assert!((ours - 1.0).abs() < 8e-3, "ours {ours}");
    }
}
