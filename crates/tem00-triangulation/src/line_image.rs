use tem00_numerics::Grid;
use tem00_speckle::{IncoherentSum, PupilField, SpecklePattern};

use crate::{Setup, TriangulationError, setup::share_between, setup::within};

/// How many samples a speckle has at least, along each axis.
///
/// A pixel is a sum over its samples. To second order that lets frequencies f pass by the factor
/// `1 + (π f s)²/6` too well, with the spacing s: at 6 samples, 2 % of amplitude for the average
/// frequency of speckle in pixels smaller than it, and less in larger ones.
const SAMPLES_PER_SPECKLE: f64 = 6.0;

/// The most samples of a pattern.
const MAXIMUM_SAMPLES: usize = 1 << 25;

/// What determines a [`LineImage`]. Lengths are in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineImageData {
    /// The numbers of columns and rows.
    pub size: [usize; 2],
    /// The full width of the line between the points of 1/e².
    pub width: f64,
    /// The mean number of electrons that light frees in a column.
    pub column_electrons: f64,
    /// The speckle size along the rows and along the columns.
    pub speckle_size: [f64; 2],
    /// The side of the sensitive square in the middle of a pixel.
    pub sensitive_side: f64,
    /// The number of independent patterns.
    pub patterns: u32,
    /// The degree of polarisation of each pattern, from 0 to 1.
    pub polarisation: f64,
}

/// Images of a speckled laser line, fast: a Gaussian line times a pattern, summed over the pixels.
///
/// ```text
/// n(x, y) = N/a² ∫∫ G(v − c(u)) I(u, v) du dv      over the sensitive square, of the side a
/// ```
///
/// Each pixel is a sum over whole samples of the pattern; the line is integrated exactly over each of
/// them, the pattern is taken as even over it.
///
/// # Validity
///
/// The pattern multiplies the line, which holds for lines wider than a speckle. Samples are so fine
/// that a speckle has six at least. Speckle that the tilt of the sensor stretches along the columns is
/// matched by unequal numbers of samples along and across, which leaves at most 2 % of its size.
#[derive(Clone, Debug)]
pub struct LineImage {
    data: LineImageData,
    samples: [usize; 2],
    light: IncoherentSum,
    field: PupilField,
}

impl LineImage {
    /// Creates an image generator.
    ///
    /// # Errors
    ///
    /// Returns an error if a quantity is outside its range, or if the pattern would have more than
    /// 2²⁵ samples.
    pub fn new(data: LineImageData) -> Result<Self, TriangulationError> {
        check(&data)?;
        let samples = samples_per_pixel(data.speckle_size);
        let [sx, sy] = [0, 1].map(|axis| data.speckle_size[axis] * samples[axis] as f64);
        let speckle = (sx * sy).sqrt();
        let size = [0, 1].map(|axis| pattern_side(data.size[axis] * samples[axis], speckle));
        if size[0].saturating_mul(size[1]) > MAXIMUM_SAMPLES {
            return Err(TriangulationError::OutOfRange {
                parameter: "speckle_size",
                value: data.speckle_size[0],
                allowed: "so large that at most 2^25 samples resolve the speckle of the image",
            });
        }
        let polarised = IncoherentSum::partially_polarised(data.polarisation)?;
        Ok(Self {
            data,
            samples,
            light: IncoherentSum::equal(data.patterns as usize)?.and(&polarised)?,
            field: PupilField::from_speckle_size(size, speckle, 0)?,
        })
    }

    /// Creates the generator of images of the line of a set-up on the reference plane, of `size` =
    /// [columns, rows].
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn of_setup(setup: &Setup, size: [usize; 2]) -> Result<Self, TriangulationError> {
        let (line, surface) = (setup.line(), &setup.description().surface);
        Self::new(LineImageData {
            size,
            width: line.width,
            column_electrons: line.column_electrons,
            speckle_size: line.speckle_size,
            sensitive_side: line.sensitive_height,
            patterns: surface.patterns,
            polarisation: surface.polarisation,
        })
    }

    /// Returns what the generator was created from.
    pub const fn data(&self) -> &LineImageData {
        &self.data
    }

    /// Returns the mean numbers of electrons without speckle. `centre` gives the place of the line
    /// along the column at a place along the rows, both in pixels.
    pub fn mean(&self, centre: impl Fn(f64) -> f64 + Sync) -> Grid<f32> {
        self.integrated(None, centre)
    }

    /// Returns the mean numbers of electrons with the speckle of a seed.
    ///
    /// # Errors
    ///
    /// None for patterns that [`new`](Self::new) accepted.
    pub fn speckled(
        &self,
        seed: u64,
        centre: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Grid<f32>, TriangulationError> {
        let field = self.field.clone().with_seed(seed);
        let pattern = self.light.pattern(&field, PupilField::pattern)?;
        Ok(self.integrated(Some(&pattern), centre))
    }

    /// Sums line times pattern over the samples of each pixel.
    #[expect(clippy::cast_possible_truncation, reason = "images are f32")]
    fn integrated(
        &self,
        pattern: Option<&SpecklePattern>,
        centre: impl Fn(f64) -> f64 + Sync,
    ) -> Grid<f32> {
        let [columns, rows] = self.data.size;
        let [nx, ny] = self.samples;
        let across = cells(nx, self.data.sensitive_side);
        let along = cells(ny, self.data.sensitive_side);
        let side = self.data.sensitive_side;
        let scale = self.data.column_electrons / (side * side);
        let centres: Vec<f64> = (0..columns).map(|x| centre(x as f64 + 0.5)).collect();
        let mut image = Grid::filled(columns, rows, 0.0_f32);
        image.for_each_row_mut(|y, pixels| {
            for (j, &(from, to)) in along.iter().enumerate() {
                let row = pattern.map(|pattern| pattern.values().row(y * ny + j));
                for (x, pixel) in pixels.iter_mut().enumerate() {
                    let offset = y as f64 - centres[x];
                    let share = share_between(self.data.width, offset + from, offset + to);
                    let speckle = row.map_or(side, |row| {
                        let samples = row[x * nx..].iter().zip(&across);
                        samples.map(|(&i, (a, b))| f64::from(i) * (b - a)).sum()
                    });
                    *pixel += (scale * share * speckle) as f32;
                }
            }
        });
        image
    }
}

/// Returns where the samples of a pixel begin and end within its sensitive part.
fn cells(samples: usize, side: f64) -> Vec<(f64, f64)> {
    let [low, high] = [0.5 - 0.5 * side, 0.5 + 0.5 * side];
    let edge = |index: usize| (index as f64 / samples as f64).clamp(low, high);
    (0..samples).map(|i| (edge(i), edge(i + 1))).collect()
}

/// Returns the numbers of samples per pixel along the rows and the columns for which a speckle has
/// about as many along both.
fn samples_per_pixel([along, across]: [f64; 2]) -> [usize; 2] {
    let least = (SAMPLES_PER_SPECKLE / along.min(across)).ceil().max(1.0);
    let ratio = across / along;
    let mismatch = |ny: f64| {
        let nx = (ny * ratio).round().max(1.0);
        ((ny * ratio / nx).ln().abs(), nx, ny)
    };
    let candidates = (0..8).map(|more| mismatch(least + f64::from(more)));
    let matched = candidates.reduce(|best, next| if next.0 < best.0 - 1e-9 { next } else { best });
    let (_, nx, ny) = matched.unwrap_or((0.0, least, least));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small positive whole numbers"
    )]
    [nx as usize, ny as usize]
}

/// Returns the side of a pattern of at least `needed` samples and 8 speckles that is fast to transform:
/// the least number without prime factors above 5.
fn pattern_side(needed: usize, speckle: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a valid speckle is some hundred samples wide at most"
    )]
    let least = needed.max((8.0 * speckle).ceil() as usize);
    let smooth = |&n: &usize| {
        let mut rest = n;
        for factor in [2, 3, 5] {
            while rest.is_multiple_of(factor) {
                rest /= factor;
            }
        }
        rest == 1
    };
    // There is one between any number and twice it.
    (least..).find(smooth).unwrap_or(least)
}

fn check(data: &LineImageData) -> Result<(), TriangulationError> {
    let LineImageData { size, .. } = *data;
    let pixels = size[0].saturating_mul(size[1]) as f64;
    within(
        "size",
        pixels,
        (1.0, MAXIMUM_SAMPLES as f64),
        "from 1 to 2^25 pixels",
    )?;
    let allowed = "from 0.01 to 1e5 pixels";
    within("width", data.width, (0.01, 1e5), allowed)?;
    let allowed = "from 0 to 1e12";
    within(
        "column_electrons",
        data.column_electrons,
        (0.0, 1e12),
        allowed,
    )?;
    for speckle in data.speckle_size {
        let allowed = "from 1/16 to 64 pixels";
        within("speckle_size", speckle, (1.0 / 16.0, 64.0), allowed)?;
    }
    let allowed = "from 0.01 to 1 pixel";
    within("sensitive_side", data.sensitive_side, (0.01, 1.0), allowed)?;
    let patterns = f64::from(data.patterns);
    within("patterns", patterns, (1.0, 64.0), "from 1 to 64")?;
    within("polarisation", data.polarisation, (0.0, 1.0), "from 0 to 1")
}

#[cfg(test)]
mod tests;
