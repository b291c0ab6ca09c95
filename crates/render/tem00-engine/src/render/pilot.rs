//! Pilot samples, which determine the sample count of each pixel.

use tem00_numerics::{Grid, cast::to_f32};
use tem00_tracer::{RenderOptions, Sampling, film::PixelSums};

/// The exponent of the standard deviation to which the number of samples is proportional. The mean
/// square error of an image is least with 1 for independent samples, of variance σ²/n, and with 2/3
/// for edges, of variance σ²/n².
const POWER: f64 = 2.0 / 3.0;

/// The number of steps between sample counts for each doubling.
const STEPS: usize = 16;

/// The steps below which pixels get the minimum number of samples, however many are left.
const DARKEST: usize = 64 * STEPS;

/// The radiance, relative to the mean radiance of the image, below which a pixel's error is
/// compared with this radiance instead of its own.
const DARK: f64 = 0.1;

/// Results of a pilot.
pub(super) struct Pilot {
    radiance: Grid<f32>,
    /// The standard deviation of the samples.
    deviation: Grid<f32>,
    /// The number of samples of a pixel, and of all pixels.
    samples: u32,
    all_samples: u64,
}

impl Pilot {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let layer = || Grid::filled(width, height, 0.0_f32);
        Self {
            radiance: layer(),
            deviation: layer(),
            samples: 0,
            all_samples: 0,
        }
    }

    /// Returns whether a pilot samples a pixel of the whole image. A deviation needs at least two
    /// samples: where these would be more than a quarter of all samples, every second pixel
    /// represents its neighbours, as on a chessboard.
    pub(super) const fn looks_at(options: &RenderOptions, [x, y]: [usize; 2]) -> bool {
        let all = matches!(options.sampling, Sampling::TargetError(_));
        all || options.samples_per_pixel >= 8 || (x + y).is_multiple_of(2)
    }

    /// Writes the results of a pixel, if it was sampled.
    pub(super) fn write(&mut self, at: [usize; 2], pixel: &PixelSums) {
        if pixel.samples == 0 {
            return;
        }
        self.radiance[at.into()] = to_f32(pixel.radiance());
        self.deviation[at.into()] = to_f32(pixel.deviation());
        self.samples = pixel.samples;
        self.all_samples += u64::from(pixel.samples);
    }

    /// Returns the number of requested samples that the pilot leaves.
    pub(super) fn left(&self, options: &RenderOptions) -> u64 {
        let pixels = self.radiance.values().len() as u64;
        (pixels * u64::from(options.samples_per_pixel)).saturating_sub(self.all_samples)
    }

    /// Returns the index in `counts` of each pixel's sample count; the first is the sample count of
    /// the pilot.
    pub(super) fn levels(&self, options: &RenderOptions, counts: &[u32]) -> Grid<u8> {
        match options.sampling {
            Sampling::TargetError(target) => self.levels_for(target, counts),
            Sampling::Even | Sampling::Adaptive => self.shared_levels(self.left(options), counts),
        }
    }

    /// Returns the levels that distribute at most `budget` samples.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a step is not negative, and that of no deviation saturates"
    )]
    fn shared_levels(&self, budget: u64, counts: &[u32]) -> Grid<u8> {
        let deviations = around(&self.deviation, f32::max);
        let all = deviations.values().iter().copied();
        let largest = all.fold(f32::MIN_POSITIVE, f32::max);
        // How much less a pixel gets than the pixel with the most samples, in steps.
        let below = |deviation: f32| {
            let doublings = POWER * libm::log2(f64::from(largest / deviation));
            ((doublings * STEPS as f64) as usize).min(DARKEST)
        };
        let mut histogram = vec![0_u64; DARKEST + 1];
        for &deviation in deviations.values() {
            histogram[below(deviation)] += 1;
        }
        let level = |below: usize, max: usize| {
            (1 + max.saturating_sub(below) / STEPS).min(counts.len() - 1)
        };
        let samples = |max: usize| -> u64 {
            let parts = histogram
                .iter()
                .enumerate()
                .filter(|(_, pixels)| **pixels > 0);
            let samples =
                parts.map(|(below, pixels)| pixels * u64::from(counts[level(below, max)]));
            samples.sum()
        };
        // The maximum for the pixel of the largest deviation, in steps above the minimum.
        let max = (0..DARKEST)
            .rev()
            .find(|&max| samples(max) <= budget)
            .unwrap_or(0);
        deviations.map(|&deviation| level(below(deviation), max) as u8)
    }

    /// Returns the levels that bring every pixel below a relative standard error.
    #[expect(clippy::cast_possible_truncation, reason = "there are few levels")]
    fn levels_for(&self, target: f64, counts: &[u32]) -> Grid<u8> {
        let all = self.radiance.values().iter().copied();
        let mean = all.map(f64::from).sum::<f64>() / self.radiance.values().len() as f64;
        // Nine pixels together determine a deviation except for about 1/√n of it, and less well
        // where light is rare.
        let raised = (1.0 + 2.0 / (9.0 * f64::from(self.samples)).sqrt()) / 3.0;
        let deviations = around(&self.deviation, libm::hypotf);
        Grid::from_fn(deviations.width(), deviations.height(), |x, y| {
            let radiance = f64::from(self.radiance[(x, y)]).max(DARK * mean);
            let needed = (raised * f64::from(deviations[(x, y)]) / (target * radiance)).powi(2);
            let enough = counts[1..].partition_point(|&count| f64::from(count) < needed);
            (1 + enough).min(counts.len() - 1) as u8
        })
    }
}

/// Combines the values of each pixel and its eight neighbours, which the pixel itself replaces
/// beyond the edge of the image.
fn around(layer: &Grid<f32>, combine: impl Fn(f32, f32) -> f32) -> Grid<f32> {
    let [right, down] = [layer.width() - 1, layer.height() - 1];
    let combined = |layer: &Grid<f32>, [dx, dy]: [usize; 2]| {
        Grid::from_fn(layer.width(), layer.height(), |x, y| {
            let before = layer[(x.saturating_sub(dx), y.saturating_sub(dy))];
            let after = layer[((x + dx).min(right), (y + dy).min(down))];
            combine(combine(before, layer[(x, y)]), after)
        })
    };
    combined(&combined(layer, [1, 0]), [0, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTS: [u32; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];

    /// A pilot of 8 samples in a row of pixels, each repeated three times.
    fn pilot(deviations: &[f32]) -> Pilot {
        let layer = |values: &[f32]| {
            let row: Vec<f32> = values.iter().flat_map(|&value| [value; 3]).collect();
            Grid::from_vec(row.len(), 1, row).unwrap()
        };
        Pilot {
            radiance: layer(&vec![2.0; deviations.len()]),
            deviation: layer(deviations),
            samples: 8,
            all_samples: 24 * deviations.len() as u64,
        }
    }

    fn counts(levels: &Grid<u8>) -> Vec<u32> {
        let levels = levels.values().iter();
        levels.map(|&level| COUNTS[usize::from(level)]).collect()
    }

    #[test]
    fn samples_go_where_they_differ_and_are_no_more_than_asked_for() {
        // From 1 to 8 times the deviation, 4 times the samples; where nothing differs, the minimum.
        let row = [0.0, 0.0, 1.0, 1.0, 8.0, 8.0, 0.0, 0.0];
        for budget in [30, 40, 56, 100] {
            let shared = counts(&pilot(&row).shared_levels(budget * 24, &COUNTS));
            assert!(
                shared.iter().sum::<u32>() <= 24 * u32::try_from(budget).unwrap(),
                "{shared:?}"
            );
            assert_eq!((shared[1], shared[22]), (16, 16), "nothing differs");
            let [one, eight] = [shared[8], shared[13]];
            assert!(eight == 4 * one || one == 16 || eight == 1024, "{shared:?}");
            assert!(eight > 16, "{shared:?}");
        }
    }

    #[test]
    fn neighbours_of_what_differs_get_as_many() {
        let shared = counts(&pilot(&[0.0, 1.0, 0.0]).shared_levels(9 * 200, &COUNTS));
        let max = shared[4];
        assert_eq!(shared, [16, 16, max, max, max, max, max, 16, 16]);
        assert!(max > 16, "{max}");
    }

    #[test]
    fn a_dark_image_gets_the_least() {
        let shared = counts(&pilot(&[0.0; 4]).shared_levels(12 * 56, &COUNTS));
        assert_eq!(shared, [16; 12]);
    }

    #[test]
    fn a_target_asks_for_the_samples_of_independent_ones() {
        // σ / √n, raised by 1 + 2/√72, below 0.01 of a radiance of 2.
        let deviations = [0.01, 0.05, 0.1, 0.5, 50.0];
        let asked = counts(&pilot(&deviations).levels_for(0.01, &COUNTS));
        for (pixel, deviation) in deviations.into_iter().enumerate() {
            let needed = (f64::from(deviation) * (1.0 + 2.0 / 72_f64.sqrt()) / 0.02).powi(2);
            let count = f64::from(asked[3 * pixel + 1]);
            assert!(count >= needed.min(1024.0), "{deviation}: {asked:?}");
            assert!(count < 2.0 * needed.max(16.0), "{deviation}: {asked:?}");
        }
    }
}
