use crate::SensorDescription;

/// Variances of the position of a line along a column, source by source, in square pixels.
///
/// To first order the position moves with the grey values of the column, δy = Σ gᵢ δIᵢ. With the
/// electrons nᵢ, the gain K and the speckled part Eᵢ of the electrons:
///
/// ```text
/// speckle        C² K² Σ gᵢ gⱼ Eᵢ Eⱼ cᵢⱼ      c the autocovariance of speckle in pixels
/// shot noise     K² Σ gᵢ² nᵢ
/// dark noise     K² Σ gᵢ² (σ_d² + I_d t)
/// quantisation   Σ gᵢ² / 12
/// PRNU           K² Σ gᵢ² nᵢ² s²
/// DSNU           K² Σ gᵢ² σ²_DSNU
/// ```
///
/// # Validity
///
/// First order, and speckle as a pattern times the line as the lens blurs it, which is what a
/// renderer makes. A camera sees light that interferes: a [`Budget`](crate::Budget) scales this
/// speckle to its law.
///
/// # References
///
/// - EMVA Standard 1288, release 4.0, 2021: the linear model of a sensor.
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, 5.1 and 5.2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PositionNoise {
    /// From speckle.
    pub speckle: f64,
    /// From the Poisson noise of the light.
    pub shot: f64,
    /// From the temporal dark noise and the noise of the dark current.
    pub dark: f64,
    /// From rounding to whole grey values.
    pub quantisation: f64,
    /// From the different response of the pixels.
    pub prnu: f64,
    /// From the different dark signal of the pixels.
    pub dsnu: f64,
}

/// The light in a column, and how the position of a line depends on it.
#[derive(Clone, Copy, Debug)]
pub struct ColumnLight<'a> {
    /// The electrons that light frees in each pixel, without noise.
    pub electrons: &'a [f64],
    /// Part of these electrons whose light carries speckle.
    pub coherent: &'a [f64],
    /// The shift of the position per grey value of each pixel, in pixels per DN.
    pub sensitivities: &'a [f64],
}

impl PositionNoise {
    /// Returns the variances of the position of a line in a column.
    ///
    /// `covariance` gives the covariance of the speckle factors of two pixels, a displacement in
    /// pixels to the right and down apart: C² c, at no displacement the square of the contrast in a
    /// pixel.
    ///
    /// # Panics
    ///
    /// Panics unless the three slices of `column` have one length.
    pub fn of_column(
        sensor: &SensorDescription,
        covariance: impl Fn([f64; 2]) -> f64,
        column: &ColumnLight<'_>,
    ) -> Self {
        column.check();
        let dark =
            sensor.dark_noise * sensor.dark_noise + sensor.dark_current * sensor.exposure_time;
        let mut noise = Self {
            speckle: speckle_covariance(sensor, covariance, [column, column], [0.0; 2]),
            ..Self::default()
        };
        let gain_squared = sensor.gain * sensor.gain;
        for (&g, &n) in column.sensitivities.iter().zip(column.electrons) {
            let per_electron = gain_squared * g * g;
            let response = sensor.prnu * n;
            noise.shot += per_electron * n.max(0.0);
            noise.dark += per_electron * dark;
            noise.quantisation += g * g / 12.0;
            noise.prnu += per_electron * response * response;
            noise.dsnu += per_electron * sensor.dsnu * sensor.dsnu;
        }
        noise
    }

    /// Returns the variance of the position, all terms together.
    pub const fn total(&self) -> f64 {
        let temporal = self.shot + self.dark + self.quantisation;
        self.speckle + temporal + (self.prnu + self.dsnu)
    }

    /// Returns every term, multiplied by a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        self.with(self, |term, _| factor * term)
    }

    /// Combines two noises, term by term.
    pub(crate) fn with(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            speckle: of(self.speckle, other.speckle),
            shot: of(self.shot, other.shot),
            dark: of(self.dark, other.dark),
            quantisation: of(self.quantisation, other.quantisation),
            prnu: of(self.prnu, other.prnu),
            dsnu: of(self.dsnu, other.dsnu),
        }
    }
}

/// Returns the covariance that speckle gives the positions of a line in two columns, in square
/// pixels.
///
/// `displacement` leads from the pattern in the first column to that in the second, in pixels to
/// the right and down: for two columns of one image, their distance; for two frames, the motion of
/// the pattern in between. `covariance` is the covariance of two pixels of the pattern, as for
/// [`PositionNoise::of_column`].
///
/// # Panics
///
/// Panics unless the slices of each column have one length.
pub fn speckle_covariance(
    sensor: &SensorDescription,
    covariance: impl Fn([f64; 2]) -> f64,
    columns: [&ColumnLight<'_>; 2],
    displacement: [f64; 2],
) -> f64 {
    let [first, second] = columns.map(ColumnLight::weights);
    let sum: f64 = first
        .iter()
        .flat_map(|a| second.iter().map(move |b| (a, b)))
        .map(|(&(row_a, a), &(row_b, b))| {
            let [right, down] = displacement;
            a * b * covariance([right, row_b - row_a + down])
        })
        .sum();
    sensor.gain * sensor.gain * sum
}

impl ColumnLight<'_> {
    fn check(&self) {
        let lengths = [self.coherent.len(), self.sensitivities.len()];
        assert!(
            lengths.iter().all(|&length| length == self.electrons.len()),
            "{} pixels, of which {lengths:?} have speckle and a sensitivity",
            self.electrons.len()
        );
    }

    /// The rows that count, and how far the position moves with the speckle factor in each.
    ///
    /// Rows that move it by less than a millionth of the first are left out.
    fn weights(&self) -> Vec<(f64, f64)> {
        let products = self.sensitivities.iter().zip(self.coherent);
        let rows = products
            .zip(0_u32..)
            .map(|((g, e), row)| (f64::from(row), g * e));
        let weights = rows.clone().map(|(_, weight)| weight.abs());
        let min = 1e-6 * weights.fold(0.0, f64::max);
        rows.filter(|(_, weight)| weight.abs() > min).collect()
    }
}
