use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, Poisson, StandardNormal};
use tem00_numerics::{Grid, cast::to_f32};

use crate::{
    LineImage, SensorDescription, Setup, TriangulationError, UncertaintySource,
    budget::first_order::NoiseFreeColumn,
};

/// The frames of one trial, with one source of noise each.
///
/// Noise of a single source is drawn here, apart from [`Sensor::expose`](crate::Sensor::expose), in
/// grey values that are not rounded.
pub(super) struct Frames<'a> {
    pub(super) setup: &'a Setup,
    pub(super) image: &'a LineImage,
    pub(super) column: NoiseFreeColumn,
    pub(super) seed: u64,
}

/// Purpose of random numbers of a trial: no two purposes share a stream.
#[derive(Clone, Copy)]
enum Purpose {
    Shot,
    Dark,
    Prnu,
    Dsnu,
    Rounded,
}

impl Frames<'_> {
    /// Returns the frames that are averaged, with the noise of one source: a single frame where all
    /// would be equal.
    pub(super) fn of(
        &self,
        source: UncertaintySource,
    ) -> Result<Vec<Grid<f32>>, TriangulationError> {
        let count = self.setup.description().average.frames;
        Ok(match source {
            UncertaintySource::Speckle => self.speckled()?,
            UncertaintySource::ShotNoise => (0..count).map(|i| self.shot(i)).collect(),
            UncertaintySource::DarkNoise => (0..count).map(|i| self.dark(i)).collect(),
            UncertaintySource::Prnu => vec![self.prnu()],
            UncertaintySource::Dsnu => vec![self.dsnu()],
            _ => {
                let rounded = |frame: Grid<f32>| frame.map(|value| value.round());
                self.unrounded().into_iter().map(rounded).collect()
            }
        })
    }

    /// Returns the frames with shot noise and dark noise whose rounding is simulated.
    pub(super) fn unrounded(&self) -> Vec<Grid<f32>> {
        let count = self.setup.description().average.frames;
        let dark = self.setup.sensor().dark_electrons();
        let frame = |index| {
            let mut random = self.random(Purpose::Rounded, index);
            self.frame(|electrons| {
                let read: f64 = StandardNormal.sample(&mut random);
                counted(electrons + dark, &mut random) - dark + self.sensor().dark_noise * read
            })
        };
        (0..count).map(frame).collect()
    }

    /// Returns the frames as the sensor exposes them, with everything at once.
    pub(super) fn exposed(&self) -> Result<Vec<Grid<f32>>, TriangulationError> {
        let sensor = self.setup.sensor().with_serial_number(self.seed);
        let count = self.setup.description().average.frames;
        let patterns = self.patterns()?;
        let frame = |index: u32| {
            let electrons = &patterns[(index as usize).min(patterns.len() - 1)];
            let frame = sensor.expose(electrons, self.seed.wrapping_add(u64::from(index) + 1))?;
            Ok(frame.grey_values())
        };
        (0..count).map(frame).collect()
    }

    /// Returns the electrons with speckle, for each frame that has its own.
    fn patterns(&self) -> Result<Vec<Grid<f32>>, TriangulationError> {
        let average = self.setup.description().average;
        let count = if average.independent_speckle {
            average.frames
        } else {
            1
        };
        let centre = self.column.centre;
        let pattern = |index: u32| {
            let seed = self.seed.wrapping_add(u64::from(index));
            self.image.speckled(seed, |_| centre)
        };
        (0..count).map(pattern).collect()
    }

    fn speckled(&self) -> Result<Vec<Grid<f32>>, TriangulationError> {
        let grey = |&electrons: &f32| to_f32(self.grey(f64::from(electrons)));
        let patterns = self.patterns()?;
        Ok(patterns.iter().map(|frame| frame.map(grey)).collect())
    }

    fn shot(&self, index: u32) -> Grid<f32> {
        let mut random = self.random(Purpose::Shot, index);
        self.frame(|electrons| counted(electrons, &mut random))
    }

    fn dark(&self, index: u32) -> Grid<f32> {
        let mut random = self.random(Purpose::Dark, index);
        let dark = self.setup.sensor().dark_electrons();
        self.frame(|electrons| {
            let read: f64 = StandardNormal.sample(&mut random);
            electrons + self.sensor().dark_noise * read + counted(dark, &mut random) - dark
        })
    }

    fn prnu(&self) -> Grid<f32> {
        let mut random = self.random(Purpose::Prnu, 0);
        self.frame(|electrons| {
            let response: f64 = StandardNormal.sample(&mut random);
            electrons * (1.0 + self.sensor().prnu * response)
        })
    }

    fn dsnu(&self) -> Grid<f32> {
        let mut random = self.random(Purpose::Dsnu, 0);
        self.frame(|electrons| {
            let offset: f64 = StandardNormal.sample(&mut random);
            electrons + self.sensor().dsnu * offset
        })
    }

    /// Returns a frame whose pixels hold the result of `electrons` for the mean electrons.
    fn frame(&self, mut electrons: impl FnMut(f64) -> f64) -> Grid<f32> {
        let [columns, rows] = self.image.data().size;
        let mut frame = Grid::filled(columns, rows, 0.0_f32);
        let pixels = frame.values_mut().chunks_mut(columns);
        for (row, &mean) in pixels.zip(&self.column.electrons) {
            for pixel in row {
                *pixel = to_f32(self.grey(electrons(mean)));
            }
        }
        frame
    }

    fn grey(&self, electrons: f64) -> f64 {
        let sensor = self.sensor();
        sensor.black_level + sensor.gain * (electrons + self.setup.sensor().dark_electrons())
    }

    const fn sensor(&self) -> &SensorDescription {
        self.setup.sensor().description()
    }

    fn random(&self, purpose: Purpose, index: u32) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream((u64::from(index) << 8) | purpose as u64);
        random
    }
}

/// Returns a Poisson distributed number of electrons.
fn counted(mean: f64, random: &mut ChaCha8Rng) -> f64 {
    // The Poisson distribution needs a positive mean; without light there are no electrons.
    Poisson::new(mean).map_or(0.0, |poisson| poisson.sample(random))
}
