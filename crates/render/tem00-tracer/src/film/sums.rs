use glam::DVec3;

use super::{LaserSample, Sample};

/// Sums over the samples of one pixel.
#[derive(Clone, Debug, Default)]
pub struct PixelSums {
    /// The number of samples.
    pub samples: u32,
    /// The sums of each laser.
    pub lasers: Vec<LaserSums>,
    /// The radiance from lights.
    pub lights: Moments,
    /// The radiance from all sources.
    pub total: Moments,
    depth: f64,
    /// The number of samples that meet something.
    hits: u32,
    normal: DVec3,
}

/// Sums over the samples of one pixel for one laser.
#[derive(Clone, Copy, Debug, Default)]
pub struct LaserSums {
    /// Radiance of light that has met one rough surface, before speckle.
    pub single: f64,
    /// Radiance of light that has met more than one, before speckle.
    pub multiple: f64,
    /// The speckle factors.
    pub speckle: f64,
    /// The radiance with its speckle.
    pub radiance: Moments,
    /// The power on the surface.
    pub power: Moments,
}

/// The sums of values and of their squares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// The sum of the values.
    pub sum: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.squares += value * value;
    }

    /// Returns the variance of the mean of `samples` independent values.
    fn variance_of_mean(&self, samples: u32) -> f64 {
        if samples < 2 {
            return f64::INFINITY;
        }
        let n = f64::from(samples);
        let mean = self.sum / n;
        // Rounding alone can make it negative.
        (self.squares / n - mean * mean).max(0.0) / (n - 1.0)
    }
}

impl PixelSums {
    /// Starts with no sample.
    pub fn new(lasers: usize) -> Self {
        Self {
            lasers: vec![LaserSums::default(); lasers],
            ..Self::default()
        }
    }

    /// Forgets all samples, and keeps the memory.
    pub fn clear(&mut self) {
        let mut lasers = core::mem::take(&mut self.lasers);
        lasers.fill(LaserSums::default());
        *self = Self {
            lasers,
            ..Self::default()
        };
    }

    /// Adds a camera sample with its values for each laser.
    pub fn add(&mut self, sample: &Sample, lasers: &[LaserSample]) {
        let weight = sample.weight;
        let lights = weight * sample.lights;
        let mut total = lights;
        for (sums, laser) in self.lasers.iter_mut().zip(lasers) {
            let radiance = weight * laser.radiance;
            sums.single += weight * laser.single;
            sums.multiple += weight * laser.multiple;
            sums.speckle += weight * laser.speckle;
            sums.radiance.add(radiance);
            sums.power.add(weight * laser.power);
            total += radiance;
        }
        self.samples += 1;
        self.lights.add(lights);
        self.total.add(total);
        if let Some(seen) = sample.seen {
            self.hits += 1;
            self.depth += seen.depth;
            self.normal += seen.normal;
        }
    }

    /// Returns the mean over the samples of a quantity whose sum is `sum`.
    pub fn mean(&self, sum: f64) -> f64 {
        sum / f64::from(self.samples.max(1))
    }

    /// Returns the variance of the mean of a quantity with these `moments`.
    pub fn variance(&self, moments: &Moments) -> f64 {
        moments.variance_of_mean(self.samples)
    }

    /// Returns the mean radiance of all sources.
    pub fn radiance(&self) -> f64 {
        self.mean(self.total.sum)
    }

    /// Returns the standard deviation of the radiances of the samples; infinite for a single one.
    pub fn deviation(&self) -> f64 {
        (self.variance(&self.total) * f64::from(self.samples)).sqrt()
    }

    /// Returns the mean depth of the samples that meet something, in metres, or 0.
    pub fn depth(&self) -> f64 {
        self.depth / f64::from(self.hits.max(1))
    }

    /// Returns the mean normal.
    pub fn normal(&self) -> DVec3 {
        self.normal / f64::from(self.samples.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_give_the_textbook_variance_of_the_mean() {
        let mut moments = Moments::default();
        for value in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
            moments.add(value);
        }
        // Mean 5 and sum of squared deviations 32: 32/7 is the variance of a value, 32/56 of the
        // mean.
        let variance = moments.variance_of_mean(8);
        assert!((variance - 32.0 / 56.0).abs() < 1e-15, "{variance}");
        let of_one = moments.variance_of_mean(1);
        assert!(of_one.is_infinite(), "{of_one} of one sample");
    }
}
