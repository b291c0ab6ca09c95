//! The pass over the image: which pixels get samples, in what order, and when they have enough.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::DVec2;
use tem00_numerics::Grid;
use tem00_numerics::parallel;
use tem00_tracer::{
    Crop, FilterSampler, Frame, RenderError, RenderOptions,
    film::{Film, FilmLayout, PixelSums, Sample},
};

use super::pilot::Pilot;
use crate::{
    integrator::{Batch, CameraSample, Integrator},
    sampler::{Stream, pixel_key},
};

/// The number of neighbouring pixels of a row that one thread works on at a time.
const STRIP: usize = 32;

/// The maximum number of samples that are traced together.
const BATCH: usize = 1024;

/// The maximum number of samples of a pixel that are drawn together.
const RUN: u32 = 64;

/// Pass over the image, or over a part of it.
pub(super) struct PathPass<'a> {
    pub integrator: &'a Integrator<'a>,
    pub options: &'a RenderOptions,
    /// The possible sample counts of a pixel.
    pub counts: Vec<u32>,
    pub filter: FilterSampler,
    pub frame: u32,
    pub area: Crop,
    /// True if light that is followed from the lasers will be added.
    pub light_traced: bool,
    pub progress: &'a (dyn Fn(u64) + Sync),
    pub cancel: &'a AtomicBool,
}

/// A pixel that is sampled.
struct Pixel {
    /// Column and row in the whole image.
    position: [usize; 2],
    sums: PixelSums,
}

/// Working memory of a thread, kept from strip to strip.
#[derive(Default)]
struct Memory<'a> {
    batch: Batch<'a>,
    pixels: Vec<Pixel>,
}

impl<'a> PathPass<'a> {
    /// Renders all layers.
    pub(super) fn render(&self) -> Result<Frame, RenderError> {
        let wavelengths: Vec<f64> = self.integrator.laser_wavelengths().collect();
        let has_pilot = self.counts.len() > 1;
        let film = Mutex::new(Film::new(&FilmLayout {
            wavelengths: &wavelengths,
            area: self.area,
            strips: self.strips(),
            has_pilot,
            light_traced: self.light_traced,
        })?);
        let levels = has_pilot.then(|| self.levels(&film)).transpose()?;
        let level_at = |position: [usize; 2]| {
            let at = self.in_area(position).into();
            Some(levels.as_ref().map_or(0, |levels| levels[at]))
        };
        self.for_each_strip(self.options.seed, level_at, |strip, pixels, rays| {
            let mut film = locked(&film);
            film.count_rays(rays);
            for pixel in pixels {
                film.write(strip, self.in_area(pixel.position), &pixel.sums);
            }
        })?;
        let film = film.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(film.into_frame())
    }

    /// Returns the index of each pixel's sample count, from a pilot with its own samples.
    fn levels(&self, film: &Mutex<Film>) -> Result<Grid<u8>, RenderError> {
        let pilot = Mutex::new(Pilot::new(self.area.width, self.area.height));
        self.for_each_strip(
            !self.options.seed,
            |position| Pilot::looks_at(self.options, position).then_some(0),
            |_, pixels, rays| {
                locked(film).count_rays(rays);
                let mut pilot = locked(&pilot);
                for pixel in pixels {
                    pilot.write(self.in_area(pixel.position), &pixel.sums);
                }
            },
        )?;
        let pilot = pilot.into_inner().unwrap_or_else(PoisonError::into_inner);
        let levels = pilot.levels(self.options, &self.counts);
        // Samples that no pixel gets count as done.
        let pixels = levels.values();
        let samples = |level: &u8| u64::from(self.counts[usize::from(*level)]);
        let asked: u64 = pixels.iter().map(samples).sum();
        (self.progress)(pilot.left(self.options).saturating_sub(asked));
        Ok(levels)
    }

    /// Traces the samples of all pixels that have a level, strip by strip, and hands over the
    /// results with the number of rays.
    fn for_each_strip(
        &self,
        seed: u64,
        level: impl Fn([usize; 2]) -> Option<u8> + Sync,
        done: impl Fn(usize, &[Pixel], u64) + Sync,
    ) -> Result<(), RenderError> {
        let strips = parallel::map_with(self.strips(), |state: &mut Memory<'a>, strip| {
            let Memory { batch, pixels } = state;
            self.start_strip(strip, pixels);
            batch.clear();
            for slot in 0..pixels.len() {
                let position = pixels[slot].position;
                let Some(level) = level(position) else {
                    continue;
                };
                let first = Stream {
                    key: self.key(seed, position),
                    level,
                    index: 0,
                };
                for index in (0..self.count(first)).step_by(RUN as usize) {
                    if batch.samples.len() + RUN as usize > BATCH {
                        self.trace(batch, pixels)?;
                    }
                    self.add_samples(slot, position, Stream { index, ..first }, batch);
                }
            }
            self.trace(batch, pixels)?;
            done(strip, pixels, batch.take_ray_count());
            Ok(())
        });
        strips.into_iter().collect()
    }

    /// Returns the number of samples of a pixel.
    fn count(&self, stream: Stream) -> u32 {
        self.counts[usize::from(stream.level)]
    }

    /// Traces the samples of a batch, adds them to their pixels, and forgets them.
    fn trace(&self, batch: &mut Batch<'a>, pixels: &mut [Pixel]) -> Result<(), RenderError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        self.integrator.trace(batch);
        for (sample, lasers) in batch.results(self.integrator.laser_count()) {
            pixels[sample.slot].sums.add(&sample.found, lasers);
        }
        (self.progress)(batch.samples.len() as u64);
        batch.clear();
        Ok(())
    }

    /// Adds samples of a pixel, starting with the sample of the stream `first`, at most one run.
    fn add_samples(&self, slot: usize, [x, y]: [usize; 2], first: Stream, batch: &mut Batch<'a>) {
        let end = first.index.saturating_add(RUN);
        let indices = first.index..end.min(self.count(first));
        let mut positions = [[0.0; 2]; RUN as usize];
        let positions = &mut positions[..indices.len()];
        self.integrator.sequence(first).positions(first, positions);
        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        for (index, within) in indices.zip(&*positions) {
            let beside = self.filter.sample(*within);
            batch.pixels.push(centre + beside.offset);
            batch.samples.push(CameraSample {
                slot,
                stream: Stream { index, ..first },
                found: Sample {
                    weight: beside.weight,
                    lights: 0.0,
                    seen: None,
                },
            });
        }
        self.integrator.draw_lens(first, batch);
    }

    /// Every pixel of every frame has its own random numbers, wherever the image is cropped.
    fn key(&self, seed: u64, [x, y]: [usize; 2]) -> u64 {
        pixel_key(seed, [self.frame.into(), x as u64, y as u64])
    }

    fn strips(&self) -> usize {
        self.area.width.div_ceil(STRIP) * self.area.height
    }

    /// Makes `pixels` those of a strip, without samples.
    fn start_strip(&self, strip: usize, pixels: &mut Vec<Pixel>) {
        let per_row = self.area.width.div_ceil(STRIP);
        let (row, first) = (strip / per_row, strip % per_row * STRIP);
        let width = STRIP.min(self.area.width - first);
        let lasers = self.integrator.laser_count();
        pixels.resize_with(width, || Pixel {
            position: [0; 2],
            sums: PixelSums::new(lasers),
        });
        for (column, pixel) in (first..).zip(pixels) {
            pixel.position = [self.area.x + column, self.area.y + row];
            pixel.sums.clear();
        }
    }

    const fn in_area(&self, [x, y]: [usize; 2]) -> [usize; 2] {
        [x - self.area.x, y - self.area.y]
    }
}

/// A thread that panicked leaves nothing half written, because only finished pixels are written.
fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
