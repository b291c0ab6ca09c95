//! The values in a pupil, made on the card from their seed.

use num_complex::Complex;
use tem00_speckle::{Aperture, Phasors, PupilField, closed_form};
use wgpu::{Buffer, ComputePass, ComputePipeline};

use crate::{
    Gpu, GpuError,
    kernel::{dispatch, storage, to_u32, uniform, uploaded},
};

const KERNEL: &str = include_str!("../shaders/aperture.wgsl");

/// The box of an aperture on the card, for apertures of one shape.
#[derive(Clone)]
pub(crate) struct Values {
    /// The values, row after row.
    pub(crate) buffer: Buffer,
    pub(crate) extent: [usize; 2],
    seeded: Option<Seeded>,
}

/// Parameters of random phasors.
#[derive(Clone)]
struct Seeded {
    pipeline: ComputePipeline,
    spans: Buffer,
    factors: Buffer,
    weights: Buffer,
    /// The numbers of the kernel's uniform after the start.
    place: [u32; 8],
}

impl Values {
    /// Room for the values of apertures of `field` that differ from `aperture` in their place
    /// alone.
    pub(crate) fn new(
        gpu: &Gpu,
        field: &PupilField,
        aperture: &Aperture<'_>,
    ) -> Result<Self, GpuError> {
        let extent = aperture.extent();
        let seeded = seed_of(field).map(|seeded| Seeded::new(gpu, aperture, seeded));
        Ok(Self {
            buffer: storage(gpu, "the pupil", 8 * (extent[0] * extent[1]) as u64)?,
            extent,
            seeded: seeded.transpose()?,
        })
    }

    /// Returns whether the same memory takes the values of apertures of `field` that differ from
    /// `aperture` in their place alone; from now on it does.
    pub(crate) fn take(&mut self, gpu: &Gpu, field: &PupilField, aperture: &Aperture<'_>) -> bool {
        self.extent == aperture.extent()
            && match (&mut self.seeded, seed_of(field)) {
                (Some(kept), Some(seeded)) => kept.take(gpu, aperture, seeded),
                (kept, seeded) => kept.is_none() && seeded.is_none(),
            }
    }

    /// Returns whether the card makes the values; the library fills them in otherwise.
    pub(crate) const fn are_seeded(&self) -> bool {
        self.seeded.is_some()
    }

    /// Fills in the values of an aperture: in the pass, or at once by the library.
    pub(crate) fn fill(&self, gpu: &Gpu, pass: &mut ComputePass<'_>, aperture: &Aperture<'_>) {
        match &self.seeded {
            Some(seeded) => seeded.fill(gpu, pass, aperture, &self.buffer),
            None => {
                let [columns, rows] = self.extent;
                let mut values = vec![Complex::new(0.0, 0.0); columns * rows];
                for (y, row) in values.chunks_exact_mut(columns).enumerate() {
                    aperture.fill(0..columns, y, row);
                }
                let bytes = bytemuck::cast_slice(&values);
                gpu.queue().write_buffer(&self.buffer, 0, bytes);
            }
        }
    }
}

impl Seeded {
    fn new(gpu: &Gpu, aperture: &Aperture<'_>, seeded: (u64, Phasors)) -> Result<Self, GpuError> {
        let factors = uploaded(gpu, "the factors of the pupil", &factors(aperture))?;
        let weights = match aperture.transmission() {
            Some(weights) => uploaded(gpu, "the transmission", weights.values())?,
            None => factors.clone(),
        };
        Ok(Self {
            pipeline: gpu.pipeline("aperture", || {
                (format!("{}{KERNEL}{NO_STACK}", closed_form::WGSL), None)
            }),
            spans: uploaded(gpu, "the rows of the pupil", &spans(aperture))?,
            factors,
            weights,
            place: place(aperture, seeded),
        })
    }

    /// Returns whether the same memory takes phasors of another seed and aperture.
    fn take(&mut self, gpu: &Gpu, aperture: &Aperture<'_>, seeded: (u64, Phasors)) -> bool {
        let place = place(aperture, seeded);
        let [.., weighted] = self.place;
        if place[7] != weighted {
            return false;
        }
        let queue = gpu.queue();
        let write = |buffer, bytes: &[u8]| queue.write_buffer(buffer, 0, bytes);
        write(&self.spans, bytemuck::cast_slice(&spans(aperture)));
        write(&self.factors, bytemuck::cast_slice(&factors(aperture)));
        if let Some(weights) = aperture.transmission() {
            write(&self.weights, bytemuck::cast_slice(weights.values()));
        }
        self.place = place;
        true
    }

    fn fill(
        &self,
        gpu: &Gpu,
        pass: &mut ComputePass<'_>,
        aperture: &Aperture<'_>,
        values: &Buffer,
    ) {
        let start = aperture.start().map(low_bits);
        let place = uniform(gpu, &[&start[..], &self.place].concat());
        let buffers = [&place, &self.spans, &self.factors, &self.weights, values];
        let [columns, rows] = aperture.extent();
        // Blocks of 16, of which the first may be cut, in groups of 8 × 8.
        let groups = [(columns + 15).div_ceil(128), rows.div_ceil(8)];
        dispatch(gpu, pass, &self.pipeline, &buffers, groups);
    }
}

/// Returns the seed of phasors that the card makes: it counts them from the origin of the seed.
fn seed_of(field: &PupilField) -> Option<(u64, Phasors)> {
    let seeded = field.seed().zip(field.phasors());
    seeded.filter(|_| field.origin() == [0; 2])
}

/// Returns for each row from and to where the pupil is open, and from and to where closed in its
/// midst.
fn spans(aperture: &Aperture<'_>) -> Vec<u32> {
    let [_, rows] = aperture.extent();
    let spans = (0..rows).flat_map(|y| aperture.spans(y));
    let ends = spans.flat_map(|span| [to_u32(span.start), to_u32(span.end)]);
    ends.collect()
}

/// Returns the factors of the columns, then of the rows.
fn factors(aperture: &Aperture<'_>) -> Vec<Complex<f32>> {
    let ones = || {
        let one = Complex::new(1.0, 0.0);
        aperture.extent().map(|points| vec![one; points])
    };
    aperture.factors().cloned().unwrap_or_else(ones).concat()
}

/// Returns the numbers of the kernel's uniform after the start.
fn place(aperture: &Aperture<'_>, (seed, phasors): (u64, Phasors)) -> [u32; 8] {
    let [period_x, period_y] = aperture.period().map(low_bits);
    let [columns, rows] = aperture.extent().map(to_u32);
    let [low, high] = [
        low_bits(seed.cast_signed()),
        low_bits((seed >> 32).cast_signed()),
    ];
    let gaussian = u32::from(phasors == Phasors::Gaussian);
    let weighted = u32::from(aperture.transmission().is_some());
    [
        period_x, period_y, columns, rows, low, high, gaussian, weighted,
    ]
}

/// The hooks of a stack, for kernels that look nothing up.
pub(crate) const NO_STACK: &str = "
fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2<f32>(0.0); }
fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4<f32>(0.0); }
";

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the lower half is meant"
)]
const fn low_bits(n: i64) -> u32 {
    n as u32
}
