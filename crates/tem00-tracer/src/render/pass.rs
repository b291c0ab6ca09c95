//! The pass over the image: which pixels get samples, in what order, and when they have enough.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::DVec2;
use rayon::prelude::*;

use super::{Crop, RenderError, RenderOptions};
use crate::{
    FilterSampler, Frame,
    film::{Film, FilmLayout, PixelSums},
    integrator::{Batch, CameraSample, Integrator},
    sampler::{Stream, pixel_key},
};

/// The number of neighbouring pixels of a row that one thread works on at a time.
const STRIP: usize = 32;

/// The maximum number of samples that are traced together.
const BATCH: usize = 1024;

/// The maximum number of samples of a pixel that are drawn together.
const RUN: u32 = 64;

/// The maximum number of rounds of samples that a pixel gets for a target error, the first one included.
const MAX_ROUNDS: u32 = 64;

/// The radiance below which a pixel's error is compared with this radiance instead of its own, by the
/// mean radiance of the image.
const DARK: f64 = 0.1;

/// One pass over the image, or over a part of it.
pub(super) struct PathPass<'a, P> {
    pub integrator: &'a Integrator<'a>,
    pub options: &'a RenderOptions,
    pub filter: FilterSampler,
    pub frame: u32,
    pub area: Crop,
    /// True if light that is followed from the lasers will be added.
    pub light_traced: bool,
    pub progress: &'a P,
    pub cancel: &'a AtomicBool,
}

/// A pixel that is sampled.
struct Pixel {
    /// Column and row in the whole image.
    position: [usize; 2],
    sums: PixelSums,
}

impl<'a, P: Fn(u64) + Sync> PathPass<'a, P> {
    /// Renders all layers.
    pub(super) fn render(&self) -> Result<Frame, RenderError> {
        let wavelengths: Vec<f64> = self.integrator.laser_wavelengths().collect();
        let film = Mutex::new(Film::new(&FilmLayout {
            wavelengths: &wavelengths,
            area: self.area,
            strips: self.strips(),
            adaptive: self.options.target_error.is_some(),
            light_traced: self.light_traced,
        })?);
        self.first_round(&film)?;
        if let Some(target) = self.options.target_error {
            self.further_rounds(&film, target)?;
        }
        let film = film.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(film.into_frame())
    }

    /// Gives every pixel the same number of samples.
    fn first_round(&self, film: &Mutex<Film>) -> Result<(), RenderError> {
        let strips = (0..self.strips()).into_par_iter();
        strips.try_for_each_init(Batch::default, |batch, strip| {
            let mut pixels = self.strip(strip);
            self.add_round(0, &mut pixels, batch)?;
            let mut film = locked(film);
            film.count_rays(batch.take_ray_count());
            for pixel in &pixels {
                film.write_first(strip, self.in_area(pixel.position), &pixel.sums);
            }
            Ok(())
        })
    }

    /// Gives pixels more samples, round by round, until their relative error is below the target.
    fn further_rounds(&self, film: &Mutex<Film>, target: f64) -> Result<(), RenderError> {
        let dark = DARK * locked(film).mean_radiance();
        let is_done =
            |pixel: &Pixel| pixel.sums.error() <= target * pixel.sums.radiance().max(dark);
        let strips = (0..self.strips()).into_par_iter();
        strips.try_for_each_init(Batch::default, |batch, strip| {
            let mut pixels = self.strip(strip);
            for pixel in &mut pixels {
                pixel.sums = locked(film).read(self.in_area(pixel.position));
            }
            for round in 1..MAX_ROUNDS {
                pixels.retain(|pixel| !is_done(pixel));
                self.add_round(round, &mut pixels, batch)?;
                let mut film = locked(film);
                film.count_rays(batch.take_ray_count());
                for pixel in &pixels {
                    film.write(self.in_area(pixel.position), &pixel.sums);
                }
            }
            Ok(())
        })
    }

    /// Adds a round of samples to each of the pixels.
    fn add_round(
        &self,
        round: u32,
        pixels: &mut [Pixel],
        batch: &mut Batch<'a>,
    ) -> Result<(), RenderError> {
        batch.clear();
        for slot in 0..pixels.len() {
            let position = pixels[slot].position;
            let key = self.key(position);
            for index in (0..self.options.samples_per_pixel).step_by(RUN as usize) {
                if batch.samples.len() + RUN as usize > BATCH {
                    self.trace(batch, pixels)?;
                }
                self.add_samples(slot, position, Stream { key, round, index }, batch);
            }
        }
        self.trace(batch, pixels)
    }

    /// Traces the samples of a batch, adds them to their pixels, and forgets them.
    fn trace(&self, batch: &mut Batch<'a>, pixels: &mut [Pixel]) -> Result<(), RenderError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        self.integrator.trace(batch);
        for (sample, lasers) in batch.results(self.integrator.laser_count()) {
            pixels[sample.slot].sums.add(sample, lasers);
        }
        (self.progress)(batch.samples.len() as u64);
        batch.clear();
        Ok(())
    }

    /// Adds samples of a pixel, from that of the stream `first` on, at most a run.
    fn add_samples(&self, slot: usize, [x, y]: [usize; 2], first: Stream, batch: &mut Batch<'a>) {
        let end = first.index.saturating_add(RUN);
        let indices = first.index..end.min(self.options.samples_per_pixel);
        let mut positions = [[0.0; 2]; RUN as usize];
        let positions = &mut positions[..indices.len()];
        self.integrator.sequence().positions(first, positions);
        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        for (index, within) in indices.zip(&*positions) {
            let beside = self.filter.sample(*within);
            batch.pixels.push(centre + beside.offset);
            batch.samples.push(CameraSample {
                slot,
                stream: Stream { index, ..first },
                weight: beside.weight,
                lights: 0.0,
                seen: None,
            });
        }
        self.integrator.draw_lens(first, batch);
    }

    /// Every pixel of every frame has random numbers of its own, wherever the image is cropped.
    fn key(&self, [x, y]: [usize; 2]) -> u64 {
        pixel_key(self.options.seed, [self.frame.into(), x as u64, y as u64])
    }

    fn strips(&self) -> usize {
        self.area.width.div_ceil(STRIP) * self.area.height
    }

    /// Returns the pixels of a strip, without samples.
    fn strip(&self, strip: usize) -> Vec<Pixel> {
        let per_row = self.area.width.div_ceil(STRIP);
        let (row, first) = (strip / per_row, strip % per_row * STRIP);
        let columns = first..self.area.width.min(first + STRIP);
        let lasers = self.integrator.laser_count();
        let pixels = columns.map(|column| Pixel {
            position: [self.area.x + column, self.area.y + row],
            sums: PixelSums::new(lasers),
        });
        pixels.collect()
    }

    const fn in_area(&self, [x, y]: [usize; 2]) -> [usize; 2] {
        [x - self.area.x, y - self.area.y]
    }
}

/// A thread that panicked has not left the film half written: it writes only finished pixels.
fn locked(film: &Mutex<Film>) -> MutexGuard<'_, Film> {
    film.lock().unwrap_or_else(PoisonError::into_inner)
}
