//! The curves behind the numbers: histogram, autocovariance and power spectrum, with the theory.

use core::f64::consts::TAU;

use serde::Serialize;
use tem00_numerics::{Grid, cast::to_f32};
use tem00_statistics::{
    GammaIntensity, SpeckleSize, StatisticsError, airy_autocovariance,
    estimate::{power_spectrum, radial_average},
    exponential_cumulative,
    laws::airy_power_spectrum,
    test::GreyLevels,
};

/// The curves of the diagrams.
#[derive(Debug, Serialize)]
pub(super) struct Curves {
    /// The speckle sizes along x and y, in pixels.
    pub(super) speckle_size: Option<[f64; 2]>,
    /// The shape of the fitted Gamma law.
    pub(super) gamma_shape: Option<f64>,
    pub(super) histogram: Vec<Bin>,
    pub(super) autocovariance: Vec<Lag>,
    pub(super) power_spectrum: Vec<Frequency>,
}

/// Bin of the histogram of intensity, in units of its mean.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Bin {
    pub(super) from: f64,
    pub(super) to: f64,
    /// The fraction of the pixels in the bin, divided by the width of the bin.
    pub(super) density: f64,
    /// The mean density of the exponential law over the bin.
    pub(super) exponential: f64,
    /// The mean density of the fitted Gamma law over the bin.
    pub(super) gamma: Option<f64>,
}

/// The autocovariance along both axes.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Lag {
    /// The lag in pixels.
    pub(super) lag: usize,
    pub(super) x: f64,
    pub(super) y: f64,
    /// The Airy curves of the measured sizes.
    pub(super) airy: Option<[f64; 2]>,
}

/// The power spectrum averaged over a ring.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Frequency {
    /// The spatial frequency, in cycles per pixel. For elongated speckles, the frequencies along x
    /// and y are scaled so that the spectrum is round.
    pub(super) frequency: f64,
    /// The power spectrum, in pixels² per unit variance.
    pub(super) power: f64,
    /// The spectrum of a circular pupil of the measured size.
    pub(super) chat: Option<f64>,
}

/// An image and what was measured in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured<'a> {
    pub(super) values: &'a Grid<f32>,
    pub(super) levels: Option<&'a GreyLevels>,
    pub(super) mean: f64,
    pub(super) contrast: f64,
    pub(super) size: Option<SpeckleSize>,
    pub(super) gamma: Option<GammaIntensity>,
}

impl Measured<'_> {
    /// Returns the curves; `lags` is the autocovariance of the image.
    pub(super) fn curves(&self, lags: &Grid<f32>) -> Result<Curves, StatisticsError> {
        Ok(Curves {
            speckle_size: self.size.map(|size| [size.x(), size.y()]),
            gamma_shape: self.gamma.map(|law| law.shape()),
            histogram: self.histogram(),
            autocovariance: self.autocovariance(lags),
            power_spectrum: self.power_spectrum()?,
        })
    }

    /// Counts the pixels in bins of a fifth of the standard deviation, up to 15 of them above the
    /// mean; the standard deviation counts as the mean if it is larger.
    fn histogram(&self) -> Vec<Bin> {
        let edges = self.histogram_edges();
        let mut counts = vec![0_usize; edges.len() + 1];
        for &value in self.values.values() {
            let intensity = f64::from(value) / self.mean;
            counts[edges.partition_point(|&edge| edge <= intensity)] += 1;
        }
        let bins = edges.windows(2).zip(&counts[1..]).map(|(edge, &count)| {
            let (from, to) = (edge[0], edge[1]);
            let over_bin = |law: &dyn Fn(f64) -> f64| (law(to) - law(from)) / (to - from);
            Bin {
                from,
                to,
                density: count as f64 / self.values.values().len() as f64 / (to - from),
                exponential: over_bin(&exponential_cumulative),
                gamma: self.gamma.map(|law| over_bin(&|x| law.cumulative(x))),
            }
        });
        bins.collect()
    }

    /// Returns the edges of the bins, in units of the mean; for a rounded image they lie between
    /// its levels.
    fn histogram_edges(&self) -> Vec<f64> {
        // A hot pixel alone can make the contrast exceed 1 by far.
        let deviation = self.contrast.min(1.0);
        let width = 0.2 * deviation;
        let start = (1.0 - 15.0 * deviation).max(0.0);
        let largest = self.values.values().iter().copied().fold(0.0, f32::max);
        let end = (f64::from(largest) / self.mean).min(1.0 + 15.0 * deviation);
        let bins = (0_u32..=151).map(|bin| start + f64::from(bin) * width);
        let within = bins.take_while(|&edge| edge < end + width);
        let snapped = within.map(|edge| match self.levels {
            Some(levels) => levels.nearest_edge(edge * self.mean) / self.mean,
            None => edge,
        });
        let mut edges: Vec<f64> = snapped.collect();
        edges.dedup_by(|next, edge| *next <= *edge);
        edges
    }

    fn autocovariance(&self, lags: &Grid<f32>) -> Vec<Lag> {
        let reach = self.size.map_or(8.0, |size| 4.0 * size.x().max(size.y()));
        let shorter = self.values.width().min(self.values.height());
        let at = |lag: usize| Lag {
            lag,
            x: lags[(lag, 0)].into(),
            y: lags[(0, lag)].into(),
            airy: self.size.map(|size| {
                [size.x(), size.y()].map(|size| airy_autocovariance(lag as f64 / size))
            }),
        };
        (0..shorter)
            .take_while(|&lag| (lag as f64) <= reach.max(8.0))
            .map(at)
            .collect()
    }

    /// Averages the power spectrum over rings.
    ///
    /// The image is faded out towards its edges by a Hann window, which hides the jumps at the
    /// edges. The two rings next to zero frequency are left out, because the window blurs zero
    /// frequency into them.
    fn power_spectrum(&self) -> Result<Vec<Frequency>, StatisticsError> {
        let (width, height) = (self.values.width(), self.values.height());
        let (fade_x, fade_y) = (hann(width), hann(height));
        let faded = |x: usize, y: usize| {
            to_f32((f64::from(self.values[(x, y)]) / self.mean - 1.0) * fade_x[x] * fade_y[y])
        };
        let spectrum = power_spectrum(&Grid::from_fn(width, height, faded))?;
        let stretch = self.size.map_or([1.0; 2], |size| {
            [size.x() / size.mean(), size.y() / size.mean()]
        });
        let step = [stretch[0] / width as f64, stretch[1] / height as f64];
        let rings = radial_average(&spectrum, step)?;
        let frequencies = rings.iter().skip(2).map(|ring| Frequency {
            frequency: ring.radius,
            power: ring.mean,
            chat: self.size.map(|size| chat(size.mean(), ring.radius)),
        });
        Ok(frequencies.collect())
    }
}

/// Returns the power spectrum of speckles of `size` pixels, in pixels² per unit variance.
pub(super) fn chat(size: f64, frequency: f64) -> f64 {
    size * size * airy_power_spectrum(size * frequency)
}

fn hann(size: usize) -> Vec<f64> {
    let at = |index: usize| 0.5 - 0.5 * (TAU * (index as f64 + 0.5) / size as f64).cos();
    (0..size).map(at).collect()
}

#[cfg(test)]
mod tests {
    use tem00_speckle::PupilField;
    use tem00_statistics::{Boundary, autocovariance};

    use super::*;

    /// Speckles of 4 samples, of the mean 10, 100 of them across.
    fn image() -> Grid<f32> {
        let pattern = PupilField::new(512, 128, 12).expect("valid").pattern();
        Grid::from_fn(400, 400, |x, y| 10.0 * pattern.values()[(x, y)])
    }

    fn curves(values: &Grid<f32>, levels: Option<&GreyLevels>) -> Curves {
        let lags = autocovariance(values, Boundary::Finite).expect("valid");
        let measured = Measured {
            values,
            levels,
            mean: 10.0,
            contrast: 1.0,
            size: SpeckleSize::from_autocovariance(&lags).ok(),
            gamma: GammaIntensity::new(1.0).ok(),
        };
        measured.curves(&lags).expect("valid")
    }

    #[test]
    fn every_pixel_is_in_the_histogram() {
        let shares = |curves: &Curves| -> f64 {
            let bins = curves.histogram.iter();
            bins.map(|bin| bin.density * (bin.to - bin.from)).sum()
        };
        // Sums of at most 80 rounded fractions.
        assert!((shares(&curves(&image(), None)) - 1.0).abs() < 1e-13, "raw");
        let rounded = image().map(|value| value.round());
        let levels = GreyLevels::from_values(rounded.values()).expect("few levels");
        let found = curves(&rounded, Some(&levels));
        assert!((shares(&found) - 1.0).abs() < 1e-13, "rounded");
        // Each bin holds whole levels: none lies within half a step of its edge.
        for bin in &found.histogram[1..] {
            let apart = |&level: &f32| (f64::from(level) - 10.0 * bin.from).abs() > 0.499;
            assert!(rounded.values().iter().all(apart), "{bin:?} cuts a level");
        }
    }

    #[test]
    fn a_hot_pixel_does_not_coarsen_the_histogram() {
        let mut values = image();
        values[(3, 3)] = 1e6;
        let measured = Measured {
            values: &values,
            levels: None,
            mean: 10.0,
            contrast: 250.0,
            size: None,
            gamma: None,
        };
        let bins = measured.histogram();
        assert!((bins[0].to - 0.2).abs() < 1e-12, "{:?}", bins[0]);
        assert_eq!(bins.len(), 80, "up to 16 times the mean");
    }

    #[test]
    fn curves_follow_the_theory() {
        let found = curves(&image(), None);
        // 100² · π/4 / … independent pixels: a bin of the fraction p has √(p / 8000), 0.016 · √0.18
        // at most, over the width 0.2; 4 σ.
        for bin in &found.histogram {
            let off = bin.density - bin.exponential;
            assert!(
                off.abs() < 4.0 * (0.2 * bin.exponential / 8_000.0).sqrt() / 0.2 + 1e-3,
                "{bin:?}"
            );
        }
        // The autocovariance spreads by about 1 / 100 speckles.
        for lag in &found.autocovariance {
            let [x, y] = lag.airy.expect("a size was measured");
            assert!(
                (lag.x - x).abs() < 0.04 && (lag.y - y).abs() < 0.04,
                "{lag:?}"
            );
        }
        // A ring of n cells holds n/2 independent exponential values, n/4 behind the window.
        for (ring, index) in found.power_spectrum.iter().zip(2_u32..) {
            let chat = ring.chat.expect("a size was measured");
            let spread = (std::f64::consts::PI * f64::from(index) / 2.0)
                .sqrt()
                .recip();
            assert!(
                (ring.power - chat).abs() < 4.5 * spread * chat + 0.05,
                "{ring:?}"
            );
            // The jumps at the edges would leave some 1e-2 beyond the cut-off at 0.25.
            assert!(ring.frequency < 0.27 || ring.power < 1e-4, "{ring:?}");
        }
    }
}
