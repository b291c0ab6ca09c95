//! Makes a speckle pattern for every line of the input and answers with the milliseconds it took.
//!
//! A line is a task and a pattern size Q; the pupil's diameter is Q/2, the memory is used again:
//!
//! ```text
//! pattern 1024      the intensity, from the seed
//! fresh 1024        the same into new memory
//! field 1024        the complex amplitude
//! stack 1024        32 complex transforms of phasors at hand, each by one thread
//! ```

#![expect(clippy::print_stdout, reason = "the answers")]

use std::{
    collections::{HashMap, hash_map::Entry},
    error::Error,
    hint::black_box,
    io::stdin,
    time::Instant,
};

use rayon::prelude::*;
use tem00::{
    numerics::{Fft2, Fft2Scratch, Grid},
    speckle::{Complex, PupilField, SpeckleScratch},
};

const ZERO: Complex<f32> = Complex::new(0.0, 0.0);
const SLICES: usize = 32;

/// A field, and the memory that everything of its size is made in.
struct Workplace {
    field: PupilField,
    scratch: SpeckleScratch,
    intensity: Grid<f32>,
    amplitude: Grid<Complex<f32>>,
    transform: Fft2,
    aperture: Grid<Complex<f32>>,
    slices: Vec<Grid<Complex<f32>>>,
}

impl Workplace {
    fn new(size: usize) -> Result<Self, Box<dyn Error>> {
        let extent = size / 2 + 1;
        let transform = Fft2::with_aperture(size, size, extent, extent)?;
        Ok(Self {
            field: PupilField::new(size, size / 2, 1)?,
            scratch: SpeckleScratch::default(),
            intensity: Grid::filled(size, size, 0.0),
            amplitude: Grid::filled(size, size, ZERO),
            transform: transform.on_one_thread(),
            aperture: Grid::filled(extent, extent, Complex::new(1.0, 0.5)),
            slices: Vec::new(),
        })
    }

    fn perform(&mut self, task: &str) -> Result<(), Box<dyn Error>> {
        let (centre, scratch) = ([0.0; 2], &mut self.scratch);
        match task {
            "pattern" => self
                .field
                .pattern_into(centre, 0.0, &mut self.intensity, scratch),
            "field" => self
                .field
                .speckle_into(centre, 0.0, &mut self.amplitude, scratch),
            "fresh" => drop(black_box(self.field.pattern())),
            "stack" => self.transform_slices(),
            _ => return Err(format!("unknown task {task}").into()),
        }
        Ok(())
    }

    fn transform_slices(&mut self) {
        self.slices.resize(SLICES, self.amplitude.clone());
        let (transform, aperture) = (&self.transform, &self.aperture);
        self.slices
            .par_iter_mut()
            .for_each_init(Fft2Scratch::default, |scratch, slice| {
                transform.forward_into(aperture, slice, scratch, |_, _, value| value);
            });
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut workplaces = HashMap::new();
    for line in stdin().lines() {
        let line = line?;
        let (task, size) = line.split_once(' ').ok_or("a task and a size")?;
        let size = size.parse()?;
        let workplace = match workplaces.entry(size) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => new.insert(Workplace::new(size)?),
        };
        let start = Instant::now();
        workplace.perform(task)?;
        println!("{}", 1e3 * start.elapsed().as_secs_f64());
    }
    Ok(())
}
