//! The pruned two-dimensional Fourier transform: Stockham's, a stage of all lines at a time.

use tem00_speckle::{Aperture, PupilField, closed_form};
use wgpu::{BindGroup, Buffer, ComputePipeline};

use crate::{
    Gpu, GpuError,
    aperture::{NO_STACK, Values},
    kernel::{bind, dispatch, storage, to_u32, uniform},
};

const KERNEL: &str = include_str!("../shaders/transform.wgsl");

/// The radices, in the order in which they are tried.
const RADICES: [usize; 6] = [16, 8, 4, 2, 3, 5];

/// Threads of a workgroup.
const GROUP: usize = 64;

/// Output of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Finish {
    /// The values themselves.
    Nothing,
    /// The amplitude about zero frequency, as a slice of so many.
    Amplitude { slice: usize },
    /// The intensity.
    Intensity,
}

/// A transform with its memory.
pub(crate) struct Transform {
    size: [usize; 2],
    values: Values,
    /// Stages before the last.
    stages: Vec<Order>,
    last: Stage,
    /// Input of the last stage.
    before: Buffer,
}

/// A stage with what it reads and writes.
struct Order {
    pipeline: ComputePipeline,
    group: BindGroup,
    groups: [usize; 2],
}

/// A stage of the transform of all lines along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stage {
    radix: usize,
    /// Points of a line, and how many of them are not zero.
    length: usize,
    filled: usize,
    /// The product of the radices before.
    done: usize,
    lines: usize,
    /// Strides of points and lines in the input and in the output.
    input: [usize; 2],
    output: [usize; 2],
}

impl Transform {
    /// Plans the transform of apertures like `aperture`.
    pub(crate) fn new(
        gpu: &Gpu,
        field: &PupilField,
        aperture: &Aperture<'_>,
    ) -> Result<Self, GpuError> {
        let size = field.size();
        let (plan, last) = stages(size, aperture.extent())?;
        let values = Values::new(gpu, field, aperture)?;
        let bytes = 8 * (size[0] * size[1]) as u64;
        // Each is read while the other is written.
        let (mut before, mut after) = (values.buffer.clone(), None);
        let mut orders = Vec::new();
        for stage in plan {
            let output = match after.take() {
                Some(array) => array,
                None => storage(gpu, "the transform", bytes)?,
            };
            orders.push(stage.order(gpu, &before, &output));
            let read = core::mem::replace(&mut before, output);
            after = (orders.len() > 1).then_some(read);
        }
        Ok(Self {
            size,
            values,
            stages: orders,
            last,
            before,
        })
    }

    /// Transforms `aperture` into `output`.
    pub(crate) fn run(&self, gpu: &Gpu, aperture: &Aperture<'_>, finish: Finish, output: &Buffer) {
        let mut encoder = gpu.device().create_command_encoder(&<_>::default());
        let mut pass = encoder.begin_compute_pass(&<_>::default());
        self.values.fill(gpu, &mut pass, aperture);
        for order in &self.stages {
            pass.set_pipeline(&order.pipeline);
            pass.set_bind_group(0, &order.group, &[]);
            let [x, y] = order.groups.map(to_u32);
            pass.dispatch_workgroups(x, y, 1);
        }
        let stage = uniform(gpu, &self.last.finishing(self.size, aperture, finish));
        dispatch(
            gpu,
            &mut pass,
            &pipeline(gpu, self.last.radix, finish),
            &[&stage, &self.before, output],
            self.last.groups(),
        );
        drop(pass);
        gpu.queue().submit([encoder.finish()]);
    }
}

impl Stage {
    fn order(&self, gpu: &Gpu, before: &Buffer, after: &Buffer) -> Order {
        let pipeline = pipeline(gpu, self.radix, Finish::Nothing);
        let stage = uniform(gpu, &self.numbers(0, 0.0, [0; 2], [1; 2]));
        let group = bind(
            gpu,
            &pipeline.get_bind_group_layout(0),
            &[&stage, before, after],
        );
        Order {
            pipeline,
            group,
            groups: self.groups(),
        }
    }

    /// The uniform of the last stage of all.
    fn finishing(&self, size: [usize; 2], aperture: &Aperture<'_>, finish: Finish) -> [u32; 16] {
        let power = aperture.power();
        let (first, scale) = match finish {
            Finish::Nothing => (0, 1.0),
            Finish::Amplitude { slice } => (slice * size[0] * size[1], power.sqrt().recip()),
            Finish::Intensity => (0, power.recip()),
        };
        let corner = aperture.corner();
        let sides = size.map(to_u32);
        let corner = [0, 1].map(|axis| {
            let corner = corner[axis].rem_euclid(i64::from(sides[axis]));
            u32::try_from(corner).unwrap_or(0)
        });
        #[expect(
            clippy::cast_possible_truncation,
            reason = "amplitudes are stored as f32"
        )]
        self.numbers(first, scale as f32, corner, sides)
    }

    fn numbers(&self, first: usize, scale: f32, corner: [u32; 2], size: [u32; 2]) -> [u32; 16] {
        let [in_step, in_line] = self.input.map(to_u32);
        let [out_step, out_line] = self.output.map(to_u32);
        let [length, filled, done, lines, first] =
            [self.length, self.filled, self.done, self.lines, first].map(to_u32);
        [
            length,
            filled,
            done,
            lines,
            in_step,
            in_line,
            out_step,
            out_line,
            first,
            u32::from(self.is_across()),
            scale.to_bits(),
            0,
            corner[0],
            corner[1],
            size[0],
            size[1],
        ]
    }

    /// Returns whether neighbouring points belong to neighbouring lines.
    const fn is_across(&self) -> bool {
        self.output[1] == 1
    }

    fn groups(&self) -> [usize; 2] {
        let threads = self.length / self.radix;
        if self.is_across() {
            [self.lines.div_ceil(GROUP), threads]
        } else {
            [threads.div_ceil(GROUP), self.lines]
        }
    }
}

/// The stages of the transform of a box of `extent` in an array of `size`: the rows of the box,
/// then all columns. The last stands apart.
fn stages(
    [width, height]: [usize; 2],
    [columns, rows]: [usize; 2],
) -> Result<(Vec<Stage>, Stage), GpuError> {
    let mut stages = Vec::new();
    let mut done = 1;
    for radix in radices(width)? {
        let first = done == 1;
        stages.push(Stage {
            radix,
            length: width,
            filled: if first { columns } else { width },
            done,
            lines: rows,
            input: [1, if first { columns } else { width }],
            output: [1, width],
        });
        done *= radix;
    }
    done = 1;
    for radix in radices(height)? {
        stages.push(Stage {
            radix,
            length: height,
            filled: if done == 1 { rows } else { height },
            done,
            lines: width,
            input: [width, 1],
            output: [width, 1],
        });
        done *= radix;
    }
    let last = stages.pop().ok_or(GpuError::Size(height))?;
    Ok((stages, last))
}

/// The radices whose product is `length`.
fn radices(length: usize) -> Result<Vec<usize>, GpuError> {
    let (mut rest, mut found) = (length, Vec::new());
    for radix in RADICES {
        while rest > 0 && rest.is_multiple_of(radix) {
            found.push(radix);
            rest /= radix;
        }
    }
    if rest == 1 {
        Ok(found)
    } else {
        Err(GpuError::Size(length))
    }
}

fn pipeline(gpu: &Gpu, radix: usize, finish: Finish) -> ComputePipeline {
    let (name, output, finished) = match finish {
        Finish::Nothing => ("values", "vec2<f32>", "return v;"),
        Finish::Amplitude { .. } => (
            "amplitude",
            "vec2<f32>",
            "let centring = tem00_centring(stage.corner, vec2<u32>(line, point), stage.size);
            return stage.scale * tem00_complex_product(v, centring);",
        ),
        Finish::Intensity => ("intensity", "f32", "return stage.scale * dot(v, v);"),
    };
    let source = || {
        let text = format!(
        "{functions}{NO_STACK}{KERNEL}
        const RADIX = {radix}u;
        fn butterfly(v: array<vec2<f32>, RADIX>) -> array<vec2<f32>, RADIX> {{ return tem00_dft{radix}(v); }}
        @group(0) @binding(2) var<storage, read_write> after: array<{output}>;
        fn finished(v: vec2<f32>, line: u32, point: u32) -> {output} {{ {finished} }}",
        functions = closed_form::WGSL,
        );
        (text, None)
    };
    gpu.pipeline(&format!("{name}, radix {radix}"), source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_with_other_factors_are_refused() {
        for side in [16, 18, 250, 2048, 6250, 24_000, 32_768] {
            let product: usize = radices(side).unwrap().iter().product();
            assert_eq!(product, side);
        }
        for side in [0, 14, 22, 2047] {
            assert_eq!(radices(side), Err(GpuError::Size(side)));
        }
    }
}
