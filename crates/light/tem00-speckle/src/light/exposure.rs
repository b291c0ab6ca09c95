use core::f64::consts::{PI, TAU};

use num_complex::Complex;
use tem00_numerics::{
    Fft2, Grid,
    cast::{to_c32, to_f32, to_signed, to_usize},
    check, sinc,
};

use crate::{PupilField, SpeckleError, SpecklePattern, SpeckleScratch};

/// Exposure during which the pattern moves or changes, or both, at a constant rate.
///
/// ```text
/// I(r) = ∫ |U(r − T t; offset + s t)|² dt       t from −½ to ½
/// ```
///
/// The *image drift* T moves the pattern over the sensor; the *pupil drift* s moves the light over
/// the pupil, so that the speckle boils without moving. The exposure is centred: at t = 0 the
/// pattern equals the still pattern. The mean is exactly 1 if the mean of the still pattern is.
///
/// ```text
/// C² = 2 ∫₀¹ (1 − t) |μ(t T)|² dt           image drift alone
/// C² = 2 ∫₀¹ (1 − t) chat(t s)² dt          pupil drift alone, circular pupil
/// ```
///
/// Look-ups of a stack do not need this type: draw the time of each sample of a pixel at random
/// within the exposure, and look up at the coordinates of this time.
///
/// # Validity
///
/// Image drift is exact, by a factor sinc in the spectrum of the intensity. Pupil drift is the mean
/// of [`moments`](Self::moments) patterns at equal steps, between which the pattern moves as in the
/// exposure. The squared contrast is then too high by `(4s/3π + (1 − chat(s)²)/6) / n²` for n
/// moments behind a circle, which is less than 10⁻³.
///
/// # Examples
///
/// A pattern that boils over one pupil diameter has the contrast 0.656:
///
/// ```
/// use tem00_speckle::{Exposure, PupilField};
///
/// let exposure = Exposure::default().with_pupil_drift([1.0, 0.0])?;
/// let pattern = exposure.pattern(&PupilField::new(128, 64, 2)?);
/// let values = pattern.values().values().iter().map(|&i| f64::from(i));
/// let square = values.map(|i| (i - 1.0).powi(2)).sum::<f64>() / 16_384.0;
/// assert!((square.sqrt() - 0.656).abs() < 0.02);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4 (integrated speckle).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    image_drift: [f64; 2],
    pupil_drift: [f64; 2],
}

impl Exposure {
    /// The largest image drift along an axis, in speckle sizes: a phase of 10⁶ turns still has ten
    /// digits after the decimal point.
    pub const MAX_IMAGE_DRIFT: f64 = 1e6;
    /// The largest pupil drift along an axis, in pupil diameters: 3840 patterns.
    pub const MAX_PUPIL_DRIFT: f64 = 128.0;

    /// Returns the exposure with another drift of the pattern over the sensor, in speckle sizes h
    /// along x and y.
    ///
    /// # Errors
    ///
    /// Returns an error unless the drift along both axes is within ±`MAX_IMAGE_DRIFT`.
    pub fn with_image_drift(mut self, drift: [f64; 2]) -> Result<Self, SpeckleError> {
        let allowed = "within ±1e6 speckle sizes in the image";
        check_drift(drift, Self::MAX_IMAGE_DRIFT, allowed)?;
        self.image_drift = drift;
        Ok(self)
    }

    /// Returns the exposure with another drift of the light over the pupil, in pupil diameters
    /// along x and y.
    ///
    /// # Errors
    ///
    /// Returns an error unless the drift along both axes is within ±`MAX_PUPIL_DRIFT`.
    pub fn with_pupil_drift(mut self, drift: [f64; 2]) -> Result<Self, SpeckleError> {
        let allowed = "within ±128 diameters over the pupil";
        check_drift(drift, Self::MAX_PUPIL_DRIFT, allowed)?;
        self.pupil_drift = drift;
        Ok(self)
    }

    /// Returns the drift of the pattern over the sensor, in speckle sizes along x and y.
    pub const fn image_drift(&self) -> [f64; 2] {
        self.image_drift
    }

    /// Returns the drift of the light over the pupil, in pupil diameters along x and y.
    pub const fn pupil_drift(&self) -> [f64; 2] {
        self.pupil_drift
    }

    /// Returns the number of patterns that the exposure averages, 1 without pupil drift.
    ///
    /// ```text
    /// n = ⌈30 max(s, √s)⌉
    /// ```
    pub fn moments(&self) -> usize {
        let [x, y] = self.pupil_drift;
        let drift = x.hypot(y);
        to_usize((30.0 * drift.max(drift.sqrt())).ceil()).max(1)
    }

    /// Returns the exposure of the undisplaced pupil in focus.
    pub fn pattern(&self, field: &PupilField) -> SpecklePattern {
        self.pattern_at(field, [0.0; 2], 0.0)
    }

    /// Returns the exposure with the pupil displaced by `offset` diameters at its middle and out of
    /// focus by `defocus`, as for [`PupilField::pattern_at`].
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    pub fn pattern_at(&self, field: &PupilField, offset: [f64; 2], defocus: f64) -> SpecklePattern {
        let mut smear = self.smear(field);
        let [width, height] = field.size();
        let mut moment = Grid::filled(width, height, 0.0);
        let mut sum = moment.clone();
        let mut scratch = SpeckleScratch::default();
        for time in self.times() {
            let position = [0, 1].map(|axis| offset[axis] + self.pupil_drift[axis] * time);
            field.pattern_into(position, defocus, &mut moment, &mut scratch);
            match &mut smear {
                Some(smear) => smear.add(&moment, time),
                None => add(&mut sum, &moment),
            }
        }
        let mut sum = smear.map_or(sum, |smear| smear.into_values());
        let share = to_f32((self.moments() as f64).recip());
        sum.values_mut()
            .iter_mut()
            .for_each(|value| *value *= share);
        SpecklePattern::new(sum, field.speckle_size())
    }

    /// The middles of equal parts of the time from −½ to ½.
    fn times(&self) -> impl Iterator<Item = f64> + use<> {
        let count = self.moments();
        (0..count).map(move |i| (i as f64 + 0.5) / count as f64 - 0.5)
    }

    fn smear(&self, field: &PupilField) -> Option<Smear> {
        let [x, y] = self.image_drift;
        let samples = [x, y].map(|drift| drift * field.speckle_size());
        (x.abs() + y.abs() > 0.0).then(|| Smear::new(field.size(), samples, self.moments()))
    }
}

/// Moving patterns, summed as spectra.
struct Smear {
    transform: Fft2,
    /// The drift in periods of the pattern.
    drift: [f64; 2],
    moments: usize,
    sum: Grid<Complex<f32>>,
}

impl Smear {
    fn new([width, height]: [usize; 2], samples: [f64; 2], moments: usize) -> Self {
        Self {
            transform: Fft2::new(width, height)
                .unwrap_or_else(|_| unreachable!("a pattern has samples")),
            drift: [samples[0] / width as f64, samples[1] / height as f64],
            moments,
            sum: Grid::filled(width, height, Complex::new(0.0, 0.0)),
        }
    }

    /// Adds the pattern of the moment about `time`, smeared over its part of the exposure.
    fn add(&mut self, pattern: &Grid<f32>, time: f64) {
        let size = [pattern.width(), pattern.height()];
        let turns = |axis: usize| -> Vec<f64> {
            (0..size[axis])
                .map(|index| frequency(index, size[axis]) * self.drift[axis])
                .collect()
        };
        let shift = |turns: &[f64]| -> Vec<Complex<f32>> {
            turns
                .iter()
                .map(|turns| to_c32(wave(-turns * time)))
                .collect()
        };
        let [x, y] = [turns(0), turns(1)];
        let [shift_x, shift_y] = [shift(&x), shift(&y)];
        let part = PI / self.moments as f64;
        let pattern = pattern.map(|&value| value.into());
        let spectrum = self.transform.forward(&pattern, |kx, ky, value| {
            let smear = to_f32(sinc(part * (x[kx] + y[ky])));
            value * shift_x[kx] * shift_y[ky] * smear
        });
        add(&mut self.sum, &spectrum);
    }

    /// The inverse transform, which is the conjugate of the transform of the conjugate.
    fn into_values(self) -> Grid<f32> {
        let [width, height] = [self.sum.width(), self.sum.height()];
        let norm = to_f32((width as f64 * height as f64).recip());
        let conjugate = self.sum.map(Complex::conj);
        self.transform
            .forward(&conjugate, |_, _, value| norm * value.re)
    }
}

/// The frequency at `index` in a spectrum of `size` points, in periods per pattern.
fn frequency(index: usize, size: usize) -> f64 {
    let (index, size) = (to_signed(index), to_signed(size));
    let is_negative = 2 * index > size;
    (if is_negative { index - size } else { index }) as f64
}

/// exp(2πi turns)
fn wave(turns: f64) -> Complex<f64> {
    Complex::cis(TAU * (turns - turns.round()))
}

fn add<T: Copy + core::ops::AddAssign>(sum: &mut Grid<T>, values: &Grid<T>) {
    let pairs = sum.values_mut().iter_mut().zip(values.values());
    pairs.for_each(|(sum, value)| *sum += *value);
}

/// Refuses a drift with a component beyond ±`maximum`.
fn check_drift(drift: [f64; 2], maximum: f64, allowed: &'static str) -> Result<(), SpeckleError> {
    for x in drift {
        let holds = (-maximum..=maximum).contains(&x);
        check::that(holds, "drift", x, "", allowed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
