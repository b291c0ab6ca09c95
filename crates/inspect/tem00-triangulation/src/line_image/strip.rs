use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tem00_numerics::{
    Fft2, Grid,
    cast::{to_c32, to_f32, to_i64, to_usize},
    circle_point_at_turn,
};
use tem00_speckle::Complex;

use crate::setup::{PixelSpread, transfer};

/// Distance from its middle up to which a line has scatterers, in half-widths: 10⁻⁸ of the light
/// lie beyond.
const REACH: f64 = 3.0;

/// Steps of the table of the lens's transfer function.
const TRANSFER: u32 = 512;

/// A strip of a rough surface under a laser line, as the pupil of a camera sees it. Lengths are in
/// pixels of the image; the first of two is along the line.
pub(super) struct Strip<'a> {
    /// The full width of the line between the points of 1/e².
    pub(super) width: f64,
    /// The spread of the line by light from below the surface.
    pub(super) spread: &'a PixelSpread,
    /// The diameter of the disc of defocus, in speckle sizes.
    pub(super) defocus: f64,
    /// The size of the image.
    pub(super) size: [f64; 2],
    /// The size of the image with the darkness next to it, after which it repeats.
    pub(super) period: [f64; 2],
    pub(super) speckle_size: [f64; 2],
    /// The position of the first sample of the image.
    pub(super) first_sample: [f64; 2],
    /// The largest displacement of the pupil across the line, in its diameters.
    pub(super) widest_tilt: f64,
}

impl Strip<'_> {
    /// Returns the positions of the line where scatterers lie along it: no farther apart than a
    /// speckle.
    ///
    /// Next to the image the line continues as it ends, from either side up to the middle of the
    /// gap.
    pub(super) fn positions(&self, centre: impl Fn(f64) -> f64) -> Vec<f64> {
        let count = self.lattice(0);
        let step = self.period[0] / count as f64;
        let [end, _] = self.size;
        let along = |index: usize| {
            let position = self.first_sample[0] + index as f64 * step;
            if position < 0.5 * (end + self.period[0]) {
                position.min(end)
            } else {
                0.0
            }
        };
        (0..count).map(|index| centre(along(index))).collect()
    }

    /// Returns the odd number of lattice points that cover the pupil along an axis.
    fn lattice(&self, axis: usize) -> usize {
        let half = to_usize((0.5 * self.period[axis] / self.speckle_size[axis]).ceil());
        2 * half + 1
    }

    /// Returns the amplitude in the pupil, displaced by `tilt` diameters across the line, and the
    /// fraction of the light of the line that the period of the image holds.
    ///
    /// Scatterers are half a line or half a speckle apart across the line, from where a sum of
    /// normal amplitudes is the integral to 10⁻⁸. Scatterers beyond the darkness next to the image
    /// are left out.
    pub(super) fn pupil(
        &self,
        positions: &[f64],
        seed: u64,
        part: u64,
        tilt: f64,
    ) -> (Grid<Complex<f32>>, f64) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(1 << 63 | part);
        let across = self.across(positions);
        let rows = self.lattice(1);
        let waves = self.waves(rows, across.iter().map(|(distance, _)| *distance));
        let mut columns = Grid::filled(positions.len(), rows, Complex::new(0.0, 0.0));
        let mut power = 0.0;
        for (x, &position) in positions.iter().enumerate() {
            let lit: Vec<_> = across
                .iter()
                .map(|&(distance, irradiance)| {
                    let amplitude = if self.holds(position + distance) {
                        power += irradiance;
                        (0.5 * irradiance).sqrt()
                    } else {
                        0.0
                    };
                    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
                    let scattered = Complex::new(normal(), normal()) * amplitude;
                    if tilt == 0.0 {
                        return scattered;
                    }
                    let turns = tilt * (position + distance) / self.speckle_size[1];
                    scattered * at_turn(turns)
                })
                .collect();
            for (y, waves) in waves.chunks_exact(across.len().max(1)).enumerate() {
                let sum: Complex<f64> = waves.iter().zip(&lit).map(|(w, a)| w * a).sum();
                columns[(x, y)] = sum * self.wave(rows, y, position - self.first_sample[1]);
            }
        }
        let mut pupil = along(&columns);
        self.defocus(&mut pupil);
        (pupil, power / positions.len() as f64)
    }

    /// Returns the amplitude in the pupil, displaced by `tilt` diameters across the line, of a
    /// surface whose sharp image is `light` in parts of pixels, and the mean of that light per
    /// pixel of the period.
    ///
    /// A scatterer lies in the middle of each part.
    pub(super) fn pupil_of_light(
        &self,
        light: &Grid<f32>,
        parts: usize,
        (seed, stream): (u64, u64),
        tilt: f64,
    ) -> (Grid<Complex<f32>>, f64) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(1 << 63 | stream);
        let place = |index: usize| (index as f64 + 0.5) / parts as f64;
        let mut scattered = Grid::filled(light.width(), light.height(), Complex::default());
        let all = scattered.values_mut().iter_mut().zip(light.values());
        for (index, (amplitude, &electrons)) in all.enumerate().filter(|(_, (_, lit))| **lit > 0.0)
        {
            let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
            let turns = tilt * place(index / light.width()) / self.speckle_size[1];
            let wave = Complex::new(normal(), normal()) * at_turn(turns);
            let wave = wave * (0.5 * f64::from(electrons)).sqrt();
            *amplitude = to_c32(wave);
        }
        let electrons: f64 = light.values().iter().map(|&e| f64::from(e)).sum();
        let [wide, high] = self.period.map(|side| to_usize(side) * parts);
        let [columns, rows] = [self.lattice(0), self.lattice(1)];
        let mut pupil = Grid::filled(columns, rows, Complex::default());
        let Ok(transform) = Fft2::with_aperture(wide, high, light.width(), light.height()) else {
            return (pupil, 0.0);
        };
        let spectrum = transform
            .on_one_thread()
            .forward(&scattered, |_, _, value| value);
        // From the first sample of the image to the first scatterer, in periods.
        let start = [0, 1].map(|axis| (place(0) - self.first_sample[axis]) / self.period[axis]);
        pupil.for_each_row_mut(|y, amplitudes| {
            for (x, amplitude) in amplitudes.iter_mut().enumerate() {
                // The image is the transform of the pupil: this is the inverse one, of the other
                // sign.
                let at = (mirrored(x, columns, wide), mirrored(y, rows, high));
                let [fx, fy] = [(x, columns), (y, rows)].map(|(i, n)| i as f64 - (n / 2) as f64);
                let phase = at_turn(fx * start[0] + fy * start[1]);
                *amplitude = spectrum[at] * to_c32(phase);
            }
        });
        self.defocus(&mut pupil);
        (pupil, electrons / (self.period[0] * self.period[1]))
    }

    /// Returns light in parts of pixels as the lens blurs it without speckle, over the whole
    /// period.
    pub(super) fn blurred(&self, light: &Grid<f32>, parts: usize) -> Grid<f32> {
        let [wide, high] = self.period.map(|side| to_usize(side) * parts);
        let planned = Fft2::with_aperture(wide, high, light.width(), light.height());
        let (Ok(forward), Ok(back)) = (planned, Fft2::new(wide, high)) else {
            return light.clone();
        };
        let table = (0..=TRANSFER).map(|step| {
            let shift = f64::from(step) / f64::from(TRANSFER);
            transfer(shift, self.defocus * shift)
        });
        let table: Vec<f64> = table.collect();
        let lens = |kx: usize, ky: usize| {
            let shift = |k: usize, length: usize, axis: usize| {
                k.min(length - k) as f64 * self.speckle_size[axis] / self.period[axis]
            };
            let step = shift(kx, wide, 0).hypot(shift(ky, high, 1)) * f64::from(TRANSFER);
            let at = |index: usize| table.get(index).copied().unwrap_or(0.0);
            let below = to_usize(step);
            at(below) + (step - below as f64) * (at(below + 1) - at(below))
        };
        let all = (wide * high) as f64;
        let sharp = light.map(|&electrons| Complex::new(electrons, 0.0));
        // The transform of the conjugate is the inverse transform.
        let blurred = forward.on_one_thread().forward(&sharp, |kx, ky, value| {
            value.conj() * to_f32(lens(kx, ky) / all)
        });
        back.on_one_thread()
            .forward(&blurred, |_, _, value| value.re)
    }

    /// Multiplies by the phase of defocus, exp(iπ b ρ²/h) at ρ diameters from the middle of the
    /// pupil.
    fn defocus(&self, pupil: &mut Grid<Complex<f32>>) {
        if self.defocus == 0.0 {
            return;
        }
        let middle = [pupil.width() / 2, pupil.height() / 2];
        let place = |index: usize, axis: usize| {
            let frequency = index as f64 - middle[axis] as f64;
            frequency * self.speckle_size[axis] / self.period[axis]
        };
        pupil.for_each_row_mut(|y, amplitudes| {
            for (x, amplitude) in amplitudes.iter_mut().enumerate() {
                let squared = place(x, 0).powi(2) + place(y, 1).powi(2);
                *amplitude *= to_c32(at_turn(0.5 * self.defocus * squared));
            }
        });
    }

    /// Returns the distances of scatterers from the middle of the line, and their irradiances.
    fn across(&self, positions: &[f64]) -> Vec<(f64, f64)> {
        let radius = 0.5 * self.width;
        // A pupil that is displaced by more than a diameter sees finer fringes of them.
        let finest = self.speckle_size[1] / self.widest_tilt.max(1.0);
        let spacing = 0.5 * radius.min(finest);
        let range = |start: f64, f: fn(f64, f64) -> f64| positions.iter().copied().fold(start, f);
        let [low, high] = self.dark();
        let [near, far] = self.spread.ends();
        let from = (low - range(f64::NEG_INFINITY, f64::max)).max(near - REACH * radius);
        let to = (high - range(f64::INFINITY, f64::min)).min(far + REACH * radius);
        let [first, last] = [(from / spacing).ceil(), (to / spacing).floor()].map(to_i64);
        let peak = spacing / radius * core::f64::consts::FRAC_2_PI.sqrt();
        let scatterer = |index: i64| {
            let distance = index as f64 * spacing;
            if self.spread.is_none() {
                return (distance, peak * (-2.0 * (distance / radius).powi(2)).exp());
            }
            (distance, spacing * self.spread.irradiance(distance, radius))
        };
        (first..=last).map(scatterer).collect()
    }

    /// Returns the beginning and the end of the period of the image across the line.
    fn dark(&self) -> [f64; 2] {
        let margin = 0.5 * (self.period[1] - self.size[1]);
        [-margin, self.size[1] + margin]
    }

    fn holds(&self, position: f64) -> bool {
        let [low, high] = self.dark();
        (low..high).contains(&position)
    }

    /// Returns the wave of a scatterer at a distance across the line in a row of the pupil.
    fn wave(&self, rows: usize, row: usize, distance: f64) -> Complex<f64> {
        let frequency = row as f64 - (rows / 2) as f64;
        at_turn(frequency * distance / self.period[1])
    }

    fn waves(
        &self,
        rows: usize,
        distances: impl Iterator<Item = f64> + Clone,
    ) -> Vec<Complex<f64>> {
        let of_row = |row| {
            let distances = distances.clone();
            distances.map(move |distance| self.wave(rows, row, distance))
        };
        (0..rows).flat_map(of_row).collect()
    }
}

/// Returns the point of the unit circle at the angle 2π `turns`.
fn at_turn(turns: f64) -> Complex<f64> {
    let [re, im] = circle_point_at_turn(turns - turns.floor());
    Complex::new(re, im)
}

/// The index, in a transform of `length`, of the opposite of the frequency that stands at `index`
/// of a pupil of `side` points.
fn mirrored(index: usize, side: usize, length: usize) -> usize {
    (side / 2 + length - index) % length
}

/// Transforms each row, with the frequency zero in the middle: positions along the line become
/// those in the pupil.
fn along(columns: &Grid<Complex<f64>>) -> Grid<Complex<f32>> {
    let (width, height) = (columns.width(), columns.height());
    let mut pupil = Grid::filled(width, height, Complex::default());
    let Ok(transform) = Fft2::new(width, 1) else {
        return pupil;
    };
    let transform = transform.on_one_thread();
    for (row, amplitudes) in columns
        .rows()
        .zip(pupil.values_mut().chunks_exact_mut(width))
    {
        let of_row = Grid::from_fn(width, 1, |x, _| to_c32(row[x]));
        let spectrum = transform.forward(&of_row, |_, _, value| value);
        for (x, amplitude) in amplitudes.iter_mut().enumerate() {
            // The image is the transform of the pupil: this is the inverse one, of the other sign.
            *amplitude = spectrum[(mirrored(x, width, width), 0)];
        }
    }
    pupil
}
