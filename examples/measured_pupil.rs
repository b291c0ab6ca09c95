//! Does speckle behind a measured pupil field follow the same laws as synthetic speckle?
//!
//! ```sh
//! cargo run --release --example measured_pupil -- hologram.bmp
//! cargo run --release --example measured_pupil -- field.npy
//! ```
//!
//! The hologram of a rough object, taken off the axis, holds the complex field on the sensor. Round
//! pupils cut from it, and one Fourier transform, give the speckle that a lens of that aperture would
//! show. The file is one of 8 bits per pixel; the constants of `hologram/mod.rs` say how it was taken.
//! Without a file, the hologram of a flat plate is made up. A field on the sensor that another program
//! has reconstructed is read from a NumPy array of complex numbers.
//!
//! With so few speckles on the patches, the half width spreads by 0.7 % at 5 mm and by 1.7 % at 2 mm, and
//! the correlation by some 0.03. A hologram brings more: its light is uneven over the pupil, and that of a
//! small figure, 1024 pixels wide, gave half widths 2 to 5 % above theory.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]
#![expect(clippy::cast_possible_truncation, reason = "fields are kept in f32")]

mod flat;
mod hologram;
mod plot;

use std::{
    env,
    error::Error,
    fs::File,
    io::{self, BufReader},
    path::PathBuf,
};

use hologram::{DISTANCE, PITCH, SIDE, WAVELENGTH};
use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use tem00::{
    numerics::{Grid, disc_overlap},
    speckle::{Complex, NpyReader, PupilField},
    statistics::{
        AIRY_HALF_WIDTH, Boundary, Contrast, SpeckleSize, StatisticsError, pearson_correlation,
    },
};

/// The bytes that a field from a file may take.
const MEMORY_LIMIT: u64 = 1 << 28;
/// Apertures that leave room on the sensor to be displaced, in metres.
const DISPLACED: [f64; 3] = [2e-3, 3e-3, 4e-3];
/// Samples of a pattern per pixel of the image.
const FINENESS: usize = 4;
/// Evenly lit patches of the object: columns and rows of the image.
const PATCHES: [[[usize; 2]; 2]; 3] = [
    [[780, 830], [720, 780]],
    [[680, 735], [790, 850]],
    [[800, 860], [780, 840]],
];

/// The patches of the pattern behind the pupil displaced by `offset` diameters along x.
fn patches(field: &PupilField, offset: f64) -> Vec<Grid<f32>> {
    let pattern = field.pattern_at([offset, 0.0], 0.0);
    let cut = |[columns, rows]: [[usize; 2]; 2]| {
        let [width, height] = [columns, rows].map(|[first, last]| FINENESS * (last - first));
        let [left, top] = [columns, rows].map(|[first, _]| FINENESS * (first + SIDE / 2));
        Grid::from_fn(width, height, |x, y| {
            let [column, row] = [left + x, top + y].map(|i| i % (FINENESS * SIDE));
            pattern.values()[(column, row)]
        })
    };
    PATCHES.map(cut).into()
}

/// The patches as they would be in even light.
fn even(mut patches: Vec<Grid<f32>>, light: &[Grid<f32>]) -> Vec<Grid<f32>> {
    for (patch, light) in patches.iter_mut().zip(light) {
        let pairs = patch.values_mut().iter_mut().zip(light.values());
        pairs.for_each(|(value, light)| *value /= light);
    }
    patches
}

fn mean(
    values: impl Iterator<Item = Result<f64, StatisticsError>>,
) -> Result<f64, StatisticsError> {
    let sum: Result<f64, _> = values.sum();
    Ok(sum? / PATCHES.len() as f64)
}

/// The field on the sensor: of a file, or of a hologram that is made up.
fn samples(path: Option<&str>) -> Result<Grid<Complex<f32>>, Box<dyn Error>> {
    match path {
        Some(path) if path.ends_with(".npy") => {
            reconstructed(path).map_err(|error| format!("{path}: {error}").into())
        }
        Some(path) => Ok(hologram::object_field(&hologram::read(path)?)?),
        None => Ok(hologram::object_field(&hologram::make(1)?)?),
    }
}

fn reconstructed(path: &str) -> Result<Grid<Complex<f32>>, Box<dyn Error>> {
    let array = NpyReader::new(BufReader::new(File::open(path)?))?;
    // The pitch, the distance and the patches are those of the hologram.
    if array.shape() != [SIDE as u64; 2] {
        return Err(format!("{SIDE} × {SIDE} pixels are needed, not {:?}", array.shape()).into());
    }
    Ok(array.into_complex(MEMORY_LIMIT)?)
}

/// The mean contrast of the patches, and their mean speckle size in samples.
fn measure(patches: &[Grid<f32>]) -> Result<[f64; 2], StatisticsError> {
    let contrast_of = |patch: &Grid<f32>| Ok(Contrast::from_samples(patch.values())?.value());
    let size_of = |patch| Ok(SpeckleSize::from_image(patch, Boundary::Finite)?.mean());
    Ok([
        mean(patches.iter().map(contrast_of))?,
        mean(patches.iter().map(size_of))?,
    ])
}

/// The mean correlation of the patches behind pupils that are `shift` diameters apart.
fn correlation(
    field: &PupilField,
    shift: f64,
    light: &[Grid<f32>],
) -> Result<f64, StatisticsError> {
    let ends = [-0.5 * shift, 0.5 * shift];
    let [before, after] = ends.map(|offset| even(patches(field, offset), light));
    mean(
        before
            .iter()
            .zip(&after)
            .map(|(a, b)| pearson_correlation(a, b)),
    )
}

/// The measured correlations after each displacement, and the law of the round pupil.
fn draw(measured: Vec<(f64, f64)>) -> io::Result<PathBuf> {
    let shifts = (0..=125).map(|i| f64::from(i) / 100.0);
    let law = shifts.map(|shift| (shift, disc_overlap(shift).powi(2)));
    let plots: Vec<Plot> = vec![
        LinePlot::new()
            .with_data(law)
            .with_legend("squared overlap")
            .into(),
        ScatterPlot::new()
            .with_data(measured)
            .with_color("crimson")
            .with_legend("measured")
            .into(),
    ];
    let axes = [
        "displacement / diameter of the pupil",
        "correlation of the intensities",
    ];
    let title = "Speckle behind a pupil that moves over a measured field";
    plot::write("measured_pupil", title, axes, plots)
}

fn main() -> Result<(), Box<dyn Error>> {
    let samples = samples(env::args().nth(1).as_deref())?;
    let size = FINENESS * SIDE;
    let speckle_size = |diameter: f64| size as f64 * PITCH / diameter;
    let mut field = PupilField::from_samples(samples, [size; 2], speckle_size(5e-3))?;
    // The object is lit alike whatever the aperture; the finest speckle shows it best.
    let light: Vec<_> = patches(&field, 0.0).iter().map(flat::cubic_fit).collect();

    let micrometres = 1e6 * WAVELENGTH * DISTANCE / (size as f64 * PITCH);
    println!("aperture | contrast | theory | half width / µm | theory");
    for diameter in [5e-3, 4e-3, 3e-3, 2e-3] {
        field = field.with_speckle_size(speckle_size(diameter))?;
        let [contrast, h] = measure(&even(patches(&field, 0.0), &light))?;
        let [h, theory] = [h, field.speckle_size()].map(|h| AIRY_HALF_WIDTH * h * micrometres);
        let name = 1e3 * diameter;
        println!("{name:>5.0} mm | {contrast:>8.3} |      1 | {h:>15.1} | {theory:.1}");
    }

    println!("displacement / aperture |   2 mm |   3 mm |   4 mm | theory");
    let mut points = Vec::new();
    for shift in [0.125, 0.25, 0.5, 0.75, 1.0, 1.25] {
        print!("{shift:>23.3} |");
        for diameter in DISPLACED {
            // Beyond the sensor there is no field.
            if diameter * (1.0 + shift) > SIDE as f64 * PITCH {
                print!("      - |");
                continue;
            }
            field = field.with_speckle_size(speckle_size(diameter))?;
            let measured = correlation(&field, shift, &light)?;
            print!(" {measured:>6.3} |");
            points.push((shift, measured));
        }
        println!(" {:.3}", disc_overlap(shift).powi(2));
    }
    println!("{}", draw(points)?.display());
    Ok(())
}
