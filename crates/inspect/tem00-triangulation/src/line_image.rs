mod bandwidth;
mod strip;

use tem00_numerics::{
    Grid, Refusal,
    cast::{to_f32, to_usize},
    is_fast_side,
};
use tem00_speckle::{PupilField, SpeckleError, incoherent_fractions};

use self::{
    bandwidth::{Bandwidth, PolychromaticLight, Pupil},
    strip::Strip,
};
use crate::{
    ImagedLine, Setup, TriangulationError,
    setup::{LensedLine, LineProfile, PixelSpread, SPECKLE_SIZES, within},
};

/// Minimum number of samples of a speckle along each axis.
///
/// A pixel is a sum over its samples. To second order the sum passes frequencies f too well by the
/// factor `1 + (π f s)²/6`, with the spacing s: at 6 samples, 2 % of amplitude for the average
/// frequency of speckle in pixels smaller than a speckle, and less in larger pixels.
const SAMPLES_PER_SPECKLE: f64 = 6.0;

/// The maximum number of samples of a pattern.
const MAXIMUM_SAMPLES: usize = 1 << 25;

/// Dark distance between the images of a pattern that repeats, in speckle sizes; the disc of
/// defocus is added.
const DARK: f64 = 8.0;

/// Parameters of a [`LineImage`]. Lengths are in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineImageData {
    /// The numbers of columns and rows.
    pub size: [usize; 2],
    /// The full width of the line between the points of 1/e², before the lens blurs it.
    pub width: f64,
    /// The diameter of the disc of defocus along the columns, 0 in focus.
    pub blur: f64,
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

/// Images of a laser line on a rough surface, fast: the light of a thin strip of independent
/// scatterers behind a round pupil.
///
/// ```text
/// A(x, y) = ∫∫ √G(v − c(u)) n(u, v) p(x − u, y − v) du dv      p the transform of the pupil
/// n(x, y) = N/a² ∫∫ |A|² dx dy                                 over the sensitive square, of the
///                                                              side a
/// ```
///
/// G is the Gaussian line about its position c(u) and n normal white noise. The lens blurs the line
/// and lets its light interfere at once, so that lines of any width have the speckle of waves: for
/// wide ones a pattern times the blurred line, for thin ones grains that are the image of the line
/// itself. Out of focus the pupil has the phase π b ρ²/h, with ρ in its diameters and the disc of
/// defocus b: grains of a line narrower than b grow across it.
///
/// # Validity
///
/// Fully developed speckle of a surface that is equally far out of focus everywhere. Each pixel is
/// a sum over whole samples, of which a speckle has six at least. Speckle that the tilt of the
/// sensor stretches along the columns is matched by unequal numbers of samples along and across,
/// which leaves at most 2 % of its size. The position of the line changes little over a speckle
/// along the rows.
#[derive(Clone, Debug)]
pub struct LineImage {
    data: LineImageData,
    samples: [usize; 2],
    /// Fractions of the speckled light in patterns whose intensities add.
    fractions: Vec<f64>,
    /// The fraction of the light without speckle.
    even: f64,
    /// The numbers of pixels after which the image repeats.
    period: [usize; 2],
    /// The speckle size in samples.
    speckle: f64,
    /// Treatment of the laser's linewidth.
    bandwidth: Option<Bandwidth>,
    /// The spread of the line by light from below the surface.
    spread: PixelSpread,
}

impl LineImage {
    /// Creates an image generator.
    ///
    /// # Errors
    ///
    /// Returns an error if a quantity is outside its range, or if the image would have more than
    /// 2²⁵ samples.
    pub fn new(data: LineImageData) -> Result<Self, TriangulationError> {
        check(&data)?;
        let samples = samples_per_pixel(data.speckle_size);
        let [sx, sy] = [0, 1].map(|axis| data.speckle_size[axis] * samples[axis] as f64);
        let speckle = (sx * sy).sqrt();
        let blur = [0.0, data.blur];
        let dark = [0, 1].map(|axis| DARK * speckle / samples[axis] as f64 + blur[axis]);
        let period = [0, 1].map(|axis| pattern_side(data.size[axis], dark[axis]));
        let [wide, high] = [0, 1].map(|axis| period[axis].saturating_mul(samples[axis]));
        if wide.saturating_mul(high) > MAXIMUM_SAMPLES {
            let allowed = "so large that at most 2^25 samples resolve the speckle of the image";
            return Err(Refusal::new("speckle_size", data.speckle_size[0], allowed).into());
        }
        Ok(Self {
            data,
            samples,
            fractions: fractions(&data, &[1.0])?,
            even: 0.0,
            period,
            speckle,
            bandwidth: None,
            spread: PixelSpread::default(),
        })
    }

    /// Creates the generator of images of the line of a set-up on the reference plane, of `size` =
    /// [columns, rows], in the light of its laser.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn of_setup(setup: &Setup, size: [usize; 2]) -> Result<Self, TriangulationError> {
        Self::of_line(setup, setup.line(), size)
    }

    /// Creates the generator of images of the line of a set-up on a flat surface at another height.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new).
    pub fn of_line(
        setup: &Setup,
        line: &ImagedLine,
        size: [usize; 2],
    ) -> Result<Self, TriangulationError> {
        let surface = &setup.description().surface;
        let mut image = Self::new(LineImageData {
            size,
            width: line.projected_thickness,
            blur: line.blur,
            column_electrons: line.column_electrons,
            speckle_size: line.speckle_size,
            sensitive_side: line.sensitive_height,
            patterns: surface.patterns,
            polarisation: surface.polarisation,
        })?;
        image.spread = line.pixel_spread();
        if let Some(light) = PolychromaticLight::of_setup(setup) {
            image.fractions = fractions(&image.data, &light.modes)?;
            image.even = light.even;
            image.bandwidth = light.bandwidth;
        }
        Ok(image)
    }

    /// Returns the parameters that the generator was created from.
    pub const fn data(&self) -> &LineImageData {
        &self.data
    }

    /// Returns the mean numbers of electrons, without speckle. `centre` gives the position of the
    /// line along the column at a position along the rows, both in pixels.
    pub fn mean(&self, centre: impl Fn(f64) -> f64 + Sync) -> Grid<f32> {
        let data = &self.data;
        let [columns, rows] = data.size;
        let line = LensedLine {
            width: data.width,
            blur: data.blur,
            speckle_size: data.speckle_size[1],
            pixel: data.sensitive_side,
        };
        let profile = LineProfile::new(&line, &self.spread, rows as f64);
        let centres: Vec<f64> = (0..columns).map(|x| centre(x as f64 + 0.5)).collect();
        let mut image = Grid::filled(columns, rows, 0.0_f32);
        image.for_each_row_mut(|y, pixels| {
            for (pixel, centre) in pixels.iter_mut().zip(&centres) {
                *pixel = to_f32(data.column_electrons * profile.at(y as f64 + 0.5 - centre));
            }
        });
        image
    }

    /// Returns the mean numbers of electrons with the speckle of a seed.
    ///
    /// # Errors
    ///
    /// None for images that [`new`](Self::new) accepted.
    pub fn speckled(
        &self,
        seed: u64,
        centre: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Grid<f32>, TriangulationError> {
        let even = to_f32(self.even);
        let image = if even > 0.0 {
            self.mean(&centre).map(|electrons| even * electrons)
        } else {
            self.dark()
        };
        let strip = self.strip();
        let positions = strip.positions(centre);
        let per_pixel = self.data.column_electrons / self.period[1] as f64;
        self.add_speckled(image, |stream, tilt| {
            let (pupil, lit) = strip.pupil(&positions, seed, stream, tilt);
            (pupil, lit * per_pixel)
        })
    }

    /// Returns light where it leaves a part that lets light in, from where it enters: below each
    /// column as on a plate. The image is one without blur, in several parts of each pixel.
    #[must_use]
    pub fn spread(&self, light: Grid<f32>) -> Grid<f32> {
        match self.spread.is_none() {
            true => light,
            false => self
                .spread
                .of_light(&light, light.height() / self.data.size[1]),
        }
    }

    /// Returns the mean numbers of electrons that a surface of any shape frees behind the lens,
    /// with the speckle of a seed.
    ///
    /// `light` has the electrons of the image that a lens without blur would make, in several parts
    /// of each pixel along both axes; a speckle needs [two](Self::parts_of_pixel). All of the
    /// surface counts as equally far out of focus.
    ///
    /// # Errors
    ///
    /// Returns an error unless the sides of `light` are the same multiple of the image's.
    pub fn speckled_light(
        &self,
        seed: u64,
        light: &Grid<f32>,
    ) -> Result<Grid<f32>, TriangulationError> {
        let [columns, rows] = self.data.size;
        let parts = light.width() / columns;
        if parts == 0 || [light.width(), light.height()] != [parts * columns, parts * rows] {
            let allowed = "as large as the image, times the same whole number along both sides";
            let times = light.width() as f64 / columns as f64;
            return Err(Refusal::new("light", times, allowed).into());
        }
        let strip = self.strip();
        let mut image = self.dark();
        if self.even > 0.0 {
            let scale = self.even * (parts * parts) as f64;
            self.add_pixels(&mut image, &strip.blurred(light, parts), [parts; 2], scale);
        }
        self.add_speckled(image, |stream, tilt| {
            strip.pupil_of_light(light, parts, (seed, stream), tilt)
        })
    }

    /// Returns the number of parts of a pixel, along each axis, in which
    /// [`speckled_light`](Self::speckled_light) needs its light: two in a speckle.
    pub fn parts_of_pixel(&self) -> usize {
        let [along, across] = self.data.speckle_size;
        to_usize((2.0 / along.min(across)).ceil())
    }

    fn dark(&self) -> Grid<f32> {
        let [columns, rows] = self.data.size;
        Grid::filled(columns, rows, 0.0)
    }

    fn strip(&self) -> Strip<'_> {
        Strip {
            width: self.data.width,
            spread: &self.spread,
            defocus: self.data.blur / self.data.speckle_size[1],
            size: self.data.size.map(|side| side as f64),
            period: self.period.map(|side| side as f64),
            speckle_size: [0, 1].map(|axis| self.speckle / self.samples[axis] as f64),
            first_sample: self.samples.map(|samples| 0.5 / samples as f64),
            widest_tilt: self.bandwidth.as_ref().map_or(0.0, Bandwidth::widest_tilt),
        }
    }

    /// Adds the speckled part of an image, of the amplitudes that `pupil` makes for the number of a
    /// random stream and a tilt.
    fn add_speckled(
        &self,
        mut image: Grid<f32>,
        pupil: impl Fn(u64, f64) -> Pupil,
    ) -> Result<Grid<f32>, TriangulationError> {
        let samples = [0, 1].map(|axis| self.period[axis] * self.samples[axis]);
        for (fraction, part) in self.fractions.iter().zip(0..) {
            let pupils = match &self.bandwidth {
                None => vec![pupil(part, 0.0)],
                Some(bandwidth) => bandwidth.pupils(part, &pupil),
            };
            let fraction = (1.0 - self.even) * fraction / pupils.len() as f64;
            for (pupil, electrons) in pupils {
                let field = PupilField::from_samples(pupil, samples, self.speckle)?;
                // The pattern is 1 in the mean over its period.
                let scale = fraction * electrons;
                self.add_pixels(&mut image, field.pattern().values(), self.samples, scale);
            }
        }
        Ok(image)
    }

    /// Adds the mean of a pattern, of `nx` × `ny` samples in a pixel, over the sensitive part of
    /// each pixel, times `scale`.
    fn add_pixels(
        &self,
        image: &mut Grid<f32>,
        pattern: &Grid<f32>,
        [nx, ny]: [usize; 2],
        scale: f64,
    ) {
        let side = self.data.sensitive_side;
        let [across, along] = [nx, ny].map(|samples| cells(samples, side));
        image.for_each_row_mut(|y, pixels| {
            for (j, height) in along.iter().enumerate() {
                let row = pattern.row(y * ny + j);
                for (pixel, samples) in pixels.iter_mut().zip(row.chunks_exact(nx)) {
                    let sum = samples.iter().zip(&across);
                    let sum: f64 = sum.map(|(&i, width)| f64::from(i) * width).sum();
                    *pixel += to_f32(scale / (side * side) * sum * height);
                }
            }
        });
    }
}

fn fractions(data: &LineImageData, modes: &[f64]) -> Result<Vec<f64>, SpeckleError> {
    incoherent_fractions(data.patterns as usize, data.polarisation, modes)
}

/// Returns the fraction of each sample of a pixel that lies within its sensitive part.
fn cells(samples: usize, side: f64) -> Vec<f64> {
    let [low, high] = [0.5 - 0.5 * side, 0.5 + 0.5 * side];
    let edge = |index: usize| (index as f64 / samples as f64).clamp(low, high);
    (0..samples).map(|i| edge(i + 1) - edge(i)).collect()
}

/// Returns the numbers of samples per pixel along the rows and the columns for which a speckle has
/// about as many along both.
fn samples_per_pixel([along, across]: [f64; 2]) -> [usize; 2] {
    let min = (SAMPLES_PER_SPECKLE / along.min(across)).ceil().max(1.0);
    let ratio = across / along;
    let mismatch = |ny: f64| {
        let nx = (ny * ratio).round().max(1.0);
        ((ny * ratio / nx).ln().abs(), nx, ny)
    };
    let candidates = (0..8).map(|more| mismatch(min + f64::from(more)));
    let matched = candidates.reduce(|best, next| if next.0 < best.0 - 1e-9 { next } else { best });
    let (_, nx, ny) = matched.unwrap_or((0.0, min, min));
    [nx, ny].map(to_usize)
}

/// Returns the side of a pattern of `needed` pixels, and `dark` pixels next to them, that is fast
/// to transform: the smallest number without prime factors above 5.
fn pattern_side(needed: usize, dark: f64) -> usize {
    let min = needed.saturating_add(to_usize(dark.ceil()));
    (min..).find(|&side| is_fast_side(side)).unwrap_or(min)
}

fn check(d: &LineImageData) -> Result<(), TriangulationError> {
    const SPECKLE: &str = "from 1/16 to 64 pixels";
    let [columns, rows] = d.size;
    let (pixels, max) = (columns.saturating_mul(rows) as f64, MAXIMUM_SAMPLES as f64);
    let [along, across] = d.speckle_size;
    let electrons = d.column_electrons;
    let patterns = d.patterns.into();
    for (name, value, range, allowed) in [
        ("size", pixels, (1.0, max), "from 1 to 2^25 pixels"),
        ("width", d.width, (0.01, 1e5), "from 0.01 to 1e5 pixels"),
        ("blur", d.blur, (0.0, 1e5), "from 0 to 1e5 pixels"),
        ("column_electrons", electrons, (0.0, 1e12), "from 0 to 1e12"),
        ("speckle_size", along, SPECKLE_SIZES, SPECKLE),
        ("speckle_size", across, SPECKLE_SIZES, SPECKLE),
        (
            "sensitive_side",
            d.sensitive_side,
            (0.01, 1.0),
            "from 0.01 to 1 pixel",
        ),
        ("patterns", patterns, (1.0, 64.0), "from 1 to 64"),
        ("polarisation", d.polarisation, (0.0, 1.0), "from 0 to 1"),
    ] {
        within(name, value, range, allowed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
