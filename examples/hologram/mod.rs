//! A hologram off the axis, and the field that it holds.

use std::{error::Error, f64::consts::PI, fs};

use num_complex::Complex;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00::numerics::{Fft2, Fft2Error, Grid};

/// In metres.
pub(crate) const WAVELENGTH: f64 = 633e-9;
/// From the object to the sensor, in metres.
pub(crate) const DISTANCE: f64 = 0.45;
/// The distance of two pixels of the sensor, in metres.
pub(crate) const PITCH: f64 = 5e-6;
/// The pixels along each side.
pub(crate) const SIDE: usize = 1024;

/// Where the object lies in the reconstructed image: columns and rows, zero frequency in the middle.
const WINDOW: [[f64; 2]; 2] = [[590.0, 1010.0], [650.0, 960.0]];
/// What the window tapers over, in pixels of the image.
const TAPER: f64 = 20.0;
/// The spread of the Gaussian whose blur is taken for the background, in pixels of the sensor.
const BLUR: f64 = 30.0;

/// Reads the middle of a bitmap of 8 bits per pixel, with rows from below and no compression.
pub(crate) fn read(path: &str) -> Result<Grid<f32>, Box<dyn Error>> {
    let bytes = fs::read(path).map_err(|error| format!("{path}: {error}"))?;
    middle(&bytes).ok_or_else(|| format!("{path}: no plain 8-bit BMP of 1024 × 1024 pixels").into())
}

fn middle(bytes: &[u8]) -> Option<Grid<f32>> {
    let word =
        |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let [start, width, height, compression] = [word(10)?, word(18)?, word(22)?, word(30)?];
    let bits = bytes.get(28..30)?;
    if !bytes.starts_with(b"BM") || bits != [8, 0] || compression != 0 {
        return None;
    }
    let (left, above) = (width.checked_sub(SIDE)? / 2, height.checked_sub(SIDE)? / 2);
    let stride = width.next_multiple_of(4);
    let pixels = bytes.get(start..)?.get(..stride.checked_mul(height)?)?;
    let pixel =
        |x: usize, y: usize| f32::from(pixels[(height - 1 - above - y) * stride + left + x]);
    Some(Grid::from_fn(SIDE, SIDE, pixel))
}

/// Makes the hologram of a rough plate in even light, with 8 bits per pixel.
///
/// On a lattice of two points per pixel of the image the plate scatters with random amplitudes. Its
/// light on the sensor meets a plane wave of fifty times its irradiance.
pub(crate) fn make(seed: u64) -> Result<Grid<f32>, Fft2Error> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut plate = Grid::filled(440, 340, Complex::ZERO);
    for scatterer in plate.values_mut() {
        let [u, v]: [f32; 2] = random.random();
        *scatterer = turns(v.into()) * (-(1.0 - u).ln()).sqrt();
    }
    let amplitude = (0.02 / plate.values().len() as f32).sqrt();
    let transform = Fft2::with_aperture(2 * SIDE, 2 * SIDE, plate.width(), plate.height())?;
    let spread = transform.forward(&plate, |_, _, value| value);
    // The plate covers the columns 660 to 880 and the rows 700 to 870 of the image.
    let corner = [660, 700].map(|first| (first - SIDE / 2) as f64 / SIDE as f64);
    let irradiance = |x: usize, y: usize| {
        let [kx, ky] = [x, y].map(|i| i as f64 - (SIDE / 2) as f64);
        let place = turns(-(kx * corner[0] + ky * corner[1]));
        let [i, j] = [x, y].map(|i| (i + 3 * SIDE / 2) % (2 * SIDE));
        let object = (spread[(i, j)] * place * chirp(x, y)).conj() * amplitude;
        (110.0 * (object + 1.0).norm_sqr()).round().min(255.0)
    };
    Ok(Grid::from_fn(SIDE, SIDE, irradiance))
}

/// Returns the object's light on the sensor, made plane: its Fourier transform is the image.
pub(crate) fn object_field(hologram: &Grid<f32>) -> Result<Grid<Complex<f32>>, Fft2Error> {
    let transform = Fft2::new(SIDE, SIDE)?;
    // The inverse transform is the conjugate of that of the conjugate, over the number of values.
    let inverse = |spectrum: &Grid<Complex<f32>>| {
        transform.forward(spectrum, |_, _, value| value.conj() / (SIDE * SIDE) as f32)
    };
    let waves = hologram.map(|&value| Complex::new(value, 0.0));
    let sharp = transform.forward(&waves, |x, y, value| {
        value.conj() * without_background(x, y)
    });
    let sharp = inverse(&sharp);
    let lit = Grid::from_fn(SIDE, SIDE, |x, y| sharp[(x, y)] * chirp(x, y));
    let image = transform.forward(&lit, |x, y, value| value.conj() * window(x, y));
    Ok(inverse(&image))
}

/// What the lens does that brings the object's distance to infinity: exp(iπ r² / (λ d)).
fn chirp(x: usize, y: usize) -> Complex<f32> {
    let [x, y] = [x, y].map(|i| (i as f64 - (SIDE / 2) as f64) * PITCH);
    turns((x * x + y * y) / (2.0 * WAVELENGTH * DISTANCE))
}

fn turns(turns: f64) -> Complex<f32> {
    let (sin, cos) = (2.0 * PI * turns).sin_cos();
    Complex::new(cos as f32, sin as f32)
}

/// The frequency with the number `k`, in cycles per side.
fn frequency(k: usize) -> f64 {
    let k = k as f64;
    if k < (SIDE / 2) as f64 {
        k
    } else {
        k - SIDE as f64
    }
}

fn without_background(x: usize, y: usize) -> f32 {
    let radius = frequency(x).hypot(frequency(y)) / SIDE as f64;
    -(-2.0 * (PI * BLUR * radius).powi(2)).exp_m1() as f32
}

fn window(x: usize, y: usize) -> f32 {
    let along = |k, [first, last]: [f64; 2]| {
        let place = frequency(k) + (SIDE / 2) as f64;
        let inside = (place - first).min(last - place) / TAPER;
        (0.5 * PI * inside.clamp(0.0, 1.0)).sin().powi(2)
    };
    (along(x, WINDOW[0]) * along(y, WINDOW[1])) as f32
}
