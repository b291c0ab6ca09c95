//! The rows of the table: measured values compared with the theory.

use tem00_numerics::Grid;
use tem00_report::{digits::number, image::LoadedImage};
use tem00_statistics::{
    Contrast, Moments, SpeckleSize, StatisticsError,
    estimate::{Evenness, FlatImage, GammaFit, decorrelated_samples, size_before_pixels},
    exponential_cumulative,
    laws::AIRY_FIRST_ZERO,
    pixel_contrast,
    test::{GoodnessOfFit, GreyLevels},
};

use super::pixels;
use crate::comparison::{Expectation, Row};

/// The tolerances, in standard errors.
const SIGMAS: f64 = 4.0;

/// The level of the interval of the contrast.
const CONFIDENCE: f64 = 0.95;

/// The smallest p-value that counts as chance.
const SIGNIFICANCE: f64 = 1e-3;

/// The minimum number of independent samples for a statement about a distribution.
const FEWEST_SAMPLES: usize = 20;

/// The smallest mean, in grey levels, at which rounding hardly changes the fit of a Gamma law: by
/// 0.8 %. The change falls with the square of the mean.
const COARSE: f64 = 5.0;

/// The mean, in grey levels, above which rounding affects none of the measured quantities.
const FINE: f64 = 100.0;

/// The ratio of the smallest to the largest local mean below which noise may show in the quotient.
const DARK: f64 = 0.1;

/// The results so far.
pub(super) struct Findings<'a> {
    pub(super) values: &'a Grid<f32>,
    /// The flattened image that holds the values, if the image was divided by its local mean.
    pub(super) flat: Option<&'a FlatImage>,
    pub(super) levels: Option<&'a GreyLevels>,
    pub(super) mean: f64,
    pub(super) contrast: Contrast,
    /// Whether the rows to come have a theory: the light is even, and pixels without gaps have not
    /// turned out to explain the contrast.
    pub(super) has_theory: bool,
    pub(super) rows: Vec<Row>,
    pub(super) warnings: Vec<String>,
    pub(super) assumptions: Vec<String>,
}

impl Findings<'_> {
    fn row(&mut self, quantity: impl Into<String>, measured: f64, theory: Expectation) {
        let theory = Some(theory).filter(|_| self.has_theory);
        let theory = theory.unwrap_or(Expectation::Open);
        self.rows.push(Row::new(quantity, measured, theory));
    }

    fn open(&mut self, quantity: impl Into<String>, measured: f64) {
        self.row(quantity, measured, Expectation::Open);
    }

    fn assume(&mut self, assumption: impl Into<String>) {
        self.assumptions.push(assumption.into());
    }

    /// Describes the light of the image as it was read.
    pub(super) fn brightness(&mut self, mean: f64, image: &LoadedImage) {
        self.open("mean", mean);
        if let Some(levels) = self.levels {
            let linear = levels.are_multiples().then(|| levels.step());
            // The levels of a mean of channels lie closer than the levels of one channel.
            if let Some(step) = image.step.or(linear.filter(|_| image.unit.is_some())) {
                self.open("mean (grey levels)", mean / step);
            }
        }
        if self.mean_level().is_some_and(|mean| mean < FINE) {
            self.assume(
                "the image is rounded to few grey levels: each pixel is taken to be rounded \
                 to the nearest, and laws are compared at the edges between the levels",
            );
        }
        if let Some(share) = image.saturated {
            let theory = Expectation::at_most(GreyLevels::CLIPPED_FRACTION);
            self.row("saturated fraction of pixels", share, theory);
        }
    }

    /// Warns if the darkest values in even light show that darkness has a grey value above zero.
    ///
    /// In speckle, a thousandth of the pixels are darker than a thousandth of the mean. Where
    /// patterns are added or pixels are large, fewer pixels are dark, but then the distribution is
    /// less skewed: its skewness is twice the contrast or a little more. A pedestal lowers only the
    /// contrast.
    pub(super) fn pedestal(
        &mut self,
        image: &LoadedImage,
        levels: Option<&GreyLevels>,
    ) -> Result<(), StatisticsError> {
        let Some(unit) = image.unit else {
            return Ok(());
        };
        let values = image.values.values();
        let moments = Moments::from_samples(values)?;
        let (mean, deviation) = (moments.mean(), moments.standard_deviation());
        let mut sorted = values.to_vec();
        let rank = values.len() / 1_000;
        let darkest = f64::from(*sorted.select_nth_unstable_by(rank, f32::total_cmp).1);
        let rounding = levels.map_or(0.0, |levels| 2.0 * levels.step());
        if darkest < 0.05 * mean + rounding {
            return Ok(());
        }
        let cubes = values
            .iter()
            .map(|&value| ((f64::from(value) - mean) / deviation).powi(3));
        let skewness = cubes.sum::<f64>() / values.len() as f64;
        let without = deviation / (mean - darkest);
        if without < 0.8 && skewness < 3.0 * deviation / mean {
            return Ok(());
        }
        self.warnings.push(format!(
            "the darkest thousandth of the pixels begins at {:.0} % of the mean: if that is \
             darkness, --black-level {} subtracts it, and the contrast is {}; light without \
             speckle does the same",
            100.0 * darkest / mean,
            number(darkest / unit),
            number(without)
        ));
        Ok(())
    }

    /// Says whether the light is even over the image, and if not, why.
    pub(super) fn evenness(
        &mut self,
        lags: &Grid<f32>,
        size: Option<SpeckleSize>,
    ) -> Result<(), StatisticsError> {
        if let Some(flat) = self.flat {
            let lost = 100.0 * flat.lost_share(size.map_or(1.0, |size| size.mean()));
            self.assume(format!(
                "the image is divided by its local mean, which takes {lost:.2} % of the variance: \
                 contrast and speckle size are corrected for it, to first order, and no other \
                 number is"
            ));
            if flat.darkest() < DARK {
                self.assume(format!(
                    "the local mean falls to {:.2} % of its largest value: noise counts as \
                     contrast there; take a brighter part with --crop",
                    100.0 * flat.darkest()
                ));
            }
        }
        let help = if self.flat.is_some() {
            "take an evenly lit part with --crop, or a smaller window with --flatten=PIXELS"
        } else {
            "take an evenly lit part with --crop, or divide by the light with --flatten"
        };
        let (scale, theory) = (size.map_or(1.0, |size| size.mean()), self.exponential());
        let found = match Evenness::find(lags, size) {
            Evenness::Even { limit }
                if self.contrast.value() <= theory + SIGMAS * self.spread(theory, size)? =>
            {
                self.assume(format!(
                    "the autocovariance falls to zero: the light counts as even over the image, \
                     and its shape makes less than {:.0} % of the variance",
                    100.0 * limit
                ));
                return Ok(());
            }
            Evenness::Even { .. } => {
                "its contrast is higher than that of speckle in even light".to_owned()
            }
            Evenness::Uneven(uneven) => format!(
                "{:.0} to {:.0} pixels apart the autocovariance is {:.3}, where speckle in even \
                 light has less than {:.3}",
                scale * uneven.lags[0],
                scale * uneven.lags[1],
                uneven.covariance,
                uneven.limit
            ),
            Evenness::FewSpeckles { across: [x, y] } => format!(
                "the image is only {x:.1} × {y:.1} speckle sizes large, so that the size may be \
                 that of the light"
            ),
            Evenness::FinerGrains { share, lag } => format!(
                "grains finer than {lag} pixels make {:.1} % of the variance, noise or the speckle \
                 itself, where the size is that of the light",
                100.0 * share
            ),
        };
        self.has_theory = false;
        self.warnings.push(format!(
            "the light does not count as even over the image, and nothing is compared with theory: \
             {found}; {help}"
        ));
        Ok(())
    }

    /// Returns the contrast of an exponential law, after the rounding of the image.
    fn exponential(&self) -> f64 {
        self.levels
            .map_or(1.0, |levels| levels.exponential_contrast(self.mean))
    }

    /// Returns the standard deviation, from image to image, of the contrast of evenly lit speckle.
    ///
    /// It is the value for a Gamma law of this contrast: `C √((1 + C²)/2)` divided by the square
    /// root of the number of independent samples.
    fn spread(&self, contrast: f64, size: Option<SpeckleSize>) -> Result<f64, StatisticsError> {
        let of_image = self.of_image(size)?.standard_error() / self.contrast.standard_error();
        let of_sample = contrast * (0.5 * (1.0 + contrast * contrast)).sqrt();
        Ok(of_sample * of_image / (self.values.values().len() as f64).sqrt())
    }

    /// Returns the contrast with its standard error for pixels that share speckles.
    fn of_image(&self, size: Option<SpeckleSize>) -> Result<Contrast, StatisticsError> {
        size.map_or(Ok(self.contrast), |size| {
            self.contrast.with_speckle_size(size.mean())
        })
    }

    /// Returns the mean of a rounded image in steps of its levels.
    fn mean_level(&self) -> Option<f64> {
        self.levels.map(|levels| self.mean / levels.step())
    }

    /// Returns whether rounding changes more than the error of the measurement.
    fn is_coarse(&self) -> bool {
        self.mean_level().is_some_and(|mean| mean < COARSE)
    }

    /// Returns the speckle size, unless the pixels are too coarse for it.
    pub(super) fn size(
        &mut self,
        lags: &Grid<f32>,
    ) -> Result<Option<SpeckleSize>, StatisticsError> {
        match SpeckleSize::from_autocovariance(lags) {
            Ok(size) => Ok(Some(size)),
            Err(StatisticsError::Unresolved { .. }) => {
                self.assume(
                    "the speckles are smaller than a pixel: their size is not known and all \
                     pixels are taken as independent",
                );
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Compares the contrast with the contrast for point-like pixels and for pixels without gaps.
    pub(super) fn contrast(&mut self, size: Option<SpeckleSize>) -> Result<(), StatisticsError> {
        let contrast = self.of_image(size)?;
        let scale = size.map_or(1.0, |size| size.mean());
        let value = self.flat.map_or(contrast.value(), |flat| {
            flat.contrast_before(contrast.value(), scale)
        });
        let factor = value / contrast.value();
        let theory = self.exponential();
        let tolerance = SIGMAS * self.spread(theory, size)? * factor;
        let with_gaps = self.rows.len();
        self.row("contrast", value, Expectation::near(theory, tolerance));
        let [low, high] = contrast.confidence_interval(CONFIDENCE)?;
        self.open("contrast, from (95 %)", factor * low);
        self.open("contrast, to (95 %)", factor * high);
        self.assume(
            "contrast 1 and the exponential law are those of one fully developed, polarised \
             pattern, seen through pixels much smaller than a speckle",
        );
        let size = size.filter(|_| !self.is_coarse());
        let gapless = size.and_then(|size| Some((size, self.gapless_contrast(size)?)));
        if let Some((size, [theory, uncertainty])) = gapless {
            let tolerance = SIGMAS * self.spread(theory, Some(size))? * factor + uncertainty;
            let near = Expectation::near(theory, tolerance);
            self.row("contrast, if pixels have no gaps", value, near);
            // Pixels are one or the other: the image is judged by what explains it.
            let without_gaps = self.rows.len() - 1;
            for [one, other] in [[with_gaps, without_gaps], [without_gaps, with_gaps]] {
                if self.rows[one].agrees() && !self.rows[other].agrees() {
                    self.rows[other].verdict = None;
                    if one == without_gaps {
                        self.has_theory = false;
                        self.assume(
                            "pixels without gaps explain the contrast: they average over speckle, \
                             and no law of intensity at points is compared with them",
                        );
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the contrast for pixels without gaps, and how much the error of the measured size
    /// may change it.
    fn gapless_contrast(&self, size: SpeckleSize) -> Option<[f64; 2]> {
        let area = self.values.values().len() as f64;
        // From image to image, the relative standard deviation of the size is 0.62 / n in n × n
        // speckles.
        let spread = 0.62 * size.mean() / area.sqrt();
        let wider = size.mean() * (1.0 + SIGMAS * spread);
        let [theory, bound] = [size.mean(), wider]
            .map(|size| Some(pixel_contrast(size_before_pixels(size)?.recip())));
        Some([theory?, bound? - theory?])
    }

    pub(super) fn size_rows(&mut self, size: Option<SpeckleSize>) {
        if let Some(size) = size {
            let before = |size| match self.flat {
                Some(flat) => flat.speckle_size_before(size),
                None => size,
            };
            let [x, y, mean] = [size.x(), size.y(), size.mean()].map(before);
            self.open("speckle size x (pixels)", x);
            self.open("speckle size y (pixels)", y);
            if let Some(before) = size_before_pixels(mean) {
                let quantity = "mean size, if pixels have no gaps";
                self.open(quantity, before);
            }
            self.assume(
                "the speckle size is that of a circular pupil, λ d / D, as seen by the pixels: \
                 those that have no gaps widen it, by 9 % at two pixels and 2 % at four",
            );
        }
    }

    /// Compares independent samples with the exponential law and with the Gamma law fitted to them.
    pub(super) fn distribution(
        &mut self,
        size: Option<SpeckleSize>,
    ) -> Result<Option<GammaFit>, StatisticsError> {
        let stride = size.map_or(1, |size| pixels(AIRY_FIRST_ZERO * size.x().max(size.y())));
        let samples = decorrelated_samples(self.values, stride)?;
        if samples.len() < FEWEST_SAMPLES {
            self.assume(format!(
                "the image holds only {} independent samples: its distribution is not tested",
                samples.len()
            ));
            return Ok(None);
        }
        self.open("independent samples", samples.len() as f64);
        let mean = self
            .levels
            .map_or(self.mean, |levels| levels.exponential_mean(self.mean));
        let cumulative = |light: f64| exponential_cumulative(light / mean);
        let exponential = self.goodness(&samples, cumulative)?;
        self.tests("exponential", &exponential, 2)?;
        self.assume("the law was fitted to these same data: p-values are biased high");
        if self.is_coarse() {
            self.assume("the grey levels are too few for the fit of a Gamma law");
            return Ok(None);
        }
        self.gamma(&samples)
    }

    fn gamma(&mut self, samples: &[f64]) -> Result<Option<GammaFit>, StatisticsError> {
        let spread = self.levels.map(|levels| levels.spread(samples));
        let fit = match GammaFit::by_likelihood(spread.as_deref().unwrap_or(samples)) {
            Err(StatisticsError::NotPositive { .. }) => {
                self.assume(
                    "some samples are 0 or less, which no Gamma law expects: its shape is 1/C² of \
                     the samples",
                );
                GammaFit::by_moments(samples)?
            }
            fit => fit?,
        };
        // The fit is too large by a fraction below 3/n.
        let bias = 3.0 / samples.len() as f64;
        let theory = Expectation::near(1.0, SIGMAS * fit.standard_error() + bias);
        self.row("shape of Gamma", fit.shape(), theory);
        self.open("its standard error", fit.standard_error());
        if let Ok(law) = fit.distribution() {
            let cumulative = |light: f64| law.cumulative(light / self.mean);
            let gamma = self.goodness(samples, cumulative)?;
            self.tests("Gamma", &gamma, 3)?;
        } else {
            self.assume("no sum of patterns has a shape below 1: the Gamma law is not tested");
        }
        Ok(Some(fit))
    }

    fn goodness(
        &self,
        samples: &[f64],
        cumulative: impl Fn(f64) -> f64,
    ) -> Result<GoodnessOfFit, StatisticsError> {
        match self.levels {
            Some(levels) => GoodnessOfFit::of_rounded(samples, levels, cumulative),
            None => GoodnessOfFit::new(samples, cumulative),
        }
    }

    /// Tests samples against a law to which `constraints` of their counts in bins were fitted.
    fn tests(
        &mut self,
        law: &str,
        fit: &GoodnessOfFit,
        constraints: usize,
    ) -> Result<(), StatisticsError> {
        let probable = Expectation::at_least(SIGNIFICANCE);
        let distance = fit.kolmogorov_smirnov()?;
        self.open(format!("KS distance to {law}"), distance.statistic);
        let name = format!("KS p-value of {law}");
        self.row(name, distance.p_value, probable);
        match fit.chi_squared(constraints) {
            Ok(outcome) => {
                let name = format!("χ² p-value of {law}");
                self.row(name, outcome.p_value, probable);
                Ok(())
            }
            // Few levels make few bins.
            Err(StatisticsError::DegreesOfFreedom { .. }) => Ok(()),
            Err(error) => Err(error),
        }
    }
}
