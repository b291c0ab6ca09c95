//! Makes a speckle pattern for every line of the input and answers with the milliseconds it took.
//!
//! A line is a task and a pattern size Q; the pupil's diameter is Q/2:
//!
//! ```text
//! pattern 1024      the intensity, from the seed, into memory that is used again
//! fresh 1024        the same into new memory
//! field 1024        the complex amplitude, into memory that is used again
//! stack 1024        a stack of 32 slices, in new memory
//! peak 1024         no time: the most memory the process has had, in MiB (Linux)
//! ```

#![expect(clippy::print_stdout, reason = "the answers")]

use std::{
    collections::{HashMap, hash_map::Entry},
    error::Error,
    fs::read_to_string,
    hint::black_box,
    io::stdin,
    time::Instant,
};

use tem00::{
    numerics::Grid,
    speckle::{Complex, PupilField, SlicePath, SpeckleScratch, SpeckleStack},
};

const SLICES: SlicePath = SlicePath::Circle { half_period: 16 };

/// A field, and the memory that everything of its size is made in.
struct Workplace {
    field: PupilField,
    scratch: SpeckleScratch,
    intensity: Grid<f32>,
    amplitude: Grid<Complex<f32>>,
}

impl Workplace {
    fn new(size: usize) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            field: PupilField::new(size, size / 2, 1)?,
            scratch: SpeckleScratch::default(),
            intensity: Grid::filled(size, size, 0.0),
            amplitude: Grid::filled(size, size, Complex::new(0.0, 0.0)),
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
            "stack" => drop(black_box(SpeckleStack::generate(&self.field, SLICES)?)),
            _ => return Err(format!("unknown task {task}").into()),
        }
        Ok(())
    }
}

/// The most memory this process has had, in MiB.
fn peak() -> Result<f64, Box<dyn Error>> {
    let status = read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next());
    Ok(kibibytes.ok_or("no VmHWM")?.parse::<f64>()? / 1_024.0)
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
        if task == "peak" {
            println!("{}", peak()?);
            continue;
        }
        let start = Instant::now();
        workplace.perform(task)?;
        println!("{}", 1e3 * start.elapsed().as_secs_f64());
    }
    Ok(())
}
