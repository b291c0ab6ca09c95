//! The pruned two-dimensional Fourier transform: rows, then columns, in the memory of workgroups.

use tem00_speckle::{Aperture, PupilField, closed_form};
use wgpu::{BindGroup, Buffer, CommandEncoder, ComputePipeline, Limits};

use crate::{
    Gpu, GpuError,
    aperture::{NO_STACK, Values},
    kernel::{bind, dispatch, storage, to_u32, uniform},
};

const KERNEL: &str = include_str!("../shaders/transform.wgsl");

/// The radices, in the order in which they are tried.
const RADICES: [usize; 6] = [16, 8, 4, 2, 3, 5];

/// Points that a thread holds.
const HELD: usize = 16;

/// The largest number of threads in a workgroup, and the points below which it has more sequences.
const MAX_THREADS: usize = 256;
const MIN_POINTS: usize = 512;

/// Sequences of a workgroup that are one butterfly each.
const SINGLE: usize = 64;

/// Neighbouring sequences that fill the lines of a cache.
const NEIGHBOURS: usize = 8;

/// Workgroups along the first axis of an order.
const WIDE: usize = 1 << 15;

/// Output of the last pass.
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
#[derive(Clone)]
pub(crate) struct Transform {
    size: [usize; 2],
    values: Values,
    /// Passes before the last.
    passes: Vec<Order>,
    last: Pass,
    /// Input of the last pass.
    before: Buffer,
}

/// A pass with what it reads and writes.
#[derive(Clone)]
struct Order {
    pipeline: ComputePipeline,
    group: BindGroup,
    groups: [usize; 2],
}

/// A pass over all lines along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pass {
    /// Points of the sequences that a pass transforms, and sequences of a workgroup.
    points: usize,
    batch: usize,
    /// Points of a line, and how many of them are not zero.
    length: usize,
    filled: usize,
    /// The product of the points of the passes before.
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
        let mut plan = passes(size, aperture.extent(), memory(&gpu.device().limits()))?;
        let last = plan.pop().ok_or(GpuError::Size(size[1]))?;
        let values = Values::new(gpu, field, aperture)?;
        let mut before = values.buffer.clone();
        let mut orders = Vec::new();
        for pass in plan {
            let output = storage(gpu, "the transform", 8 * (pass.lines * pass.length) as u64)?;
            orders.push(pass.order(gpu, &before, &output));
            before = output;
        }
        Ok(Self {
            size,
            values,
            passes: orders,
            last,
            before,
        })
    }

    /// Plans the transform of other apertures: in the same memory, if they have the same shape.
    pub(crate) fn renew(
        &mut self,
        gpu: &Gpu,
        field: &PupilField,
        aperture: &Aperture<'_>,
    ) -> Result<(), GpuError> {
        if self.size != field.size() || !self.values.take(gpu, field, aperture) {
            *self = Self::new(gpu, field, aperture)?;
        }
        Ok(())
    }

    /// Transforms apertures into `output`, in as few submissions as their values allow.
    pub(crate) fn run<'a>(
        &self,
        gpu: &Gpu,
        apertures: impl IntoIterator<Item = (Aperture<'a>, Finish)>,
        output: &Buffer,
    ) {
        let start = || gpu.device().create_command_encoder(&<_>::default());
        let mut encoder = start();
        for (aperture, finish) in apertures {
            self.record(gpu, &mut encoder, (&aperture, finish), output);
            if !self.values.are_seeded() {
                let full = core::mem::replace(&mut encoder, start());
                gpu.queue().submit([full.finish()]);
            }
        }
        gpu.queue().submit([encoder.finish()]);
    }

    fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        (aperture, finish): (&Aperture<'_>, Finish),
        output: &Buffer,
    ) {
        let mut pass = encoder.begin_compute_pass(&<_>::default());
        self.values.fill(gpu, &mut pass, aperture);
        for order in &self.passes {
            pass.set_pipeline(&order.pipeline);
            pass.set_bind_group(0, &order.group, &[]);
            let [x, y] = order.groups.map(to_u32);
            pass.dispatch_workgroups(x, y, 1);
        }
        let plan = uniform(gpu, &self.last.finishing(self.size, aperture, finish));
        dispatch(
            gpu,
            &mut pass,
            &self.last.pipeline(gpu, finish),
            &[&plan, &self.before, output],
            self.last.groups(),
        );
    }
}

impl Pass {
    fn order(&self, gpu: &Gpu, before: &Buffer, after: &Buffer) -> Order {
        let pipeline = self.pipeline(gpu, Finish::Nothing);
        let plan = uniform(gpu, &self.numbers(0, 0.0, [0; 2], [1; 2]));
        let group = bind(
            gpu,
            &pipeline.get_bind_group_layout(0),
            &[&plan, before, after],
        );
        Order {
            pipeline,
            group,
            groups: self.groups(),
        }
    }

    /// The uniform of the last pass of all.
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

    /// Returns whether neighbouring sequences belong to neighbouring lines.
    const fn is_across(&self) -> bool {
        self.output[1] == 1
    }

    fn groups(&self) -> [usize; 2] {
        let sequences = self.lines * self.length / self.points;
        let groups = sequences.div_ceil(self.batch);
        let wide = groups.min(WIDE);
        [wide, groups.div_ceil(wide)]
    }

    fn pipeline(&self, gpu: &Gpu, finish: Finish) -> ComputePipeline {
        let (name, output, finished) = match finish {
            Finish::Nothing => ("values", "vec2<f32>", "return v;"),
            Finish::Amplitude { .. } => (
                "amplitude",
                "vec2<f32>",
                "let centring = tem00_centring(plan.corner, vec2<u32>(line, point), plan.size);
                return plan.scale * tem00_complex_product(v, centring);",
            ),
            Finish::Intensity => ("intensity", "f32", "return plan.scale * dot(v, v);"),
        };
        let Self { points, batch, .. } = *self;
        let along = !self.is_across() && self.length == points;
        let source = || {
            let text = format!(
                "{functions}{NO_STACK}{KERNEL}
                const POINTS = {points}u;
                const BATCH = {batch}u;
                const MEMORY = {memory}u;
                const ALONG = {along};
                @group(0) @binding(2) var<storage, read_write> after: array<{output}>;
                fn finished(v: vec2<f32>, line: u32, point: u32) -> {output} {{ {finished} }}
                {stages}",
                functions = closed_form::WGSL,
                memory = (points * batch).next_multiple_of(16),
                stages = stages(points, batch),
            );
            (text, None)
        };
        gpu.pipeline(&format!("{name}, {batch} times {points}, {along}"), source)
    }
}

/// The passes of the transform of a box of `extent` in an array of `size`: the rows of the box,
/// then all columns. `memory` is what a workgroup holds, in points.
fn passes(
    [width, height]: [usize; 2],
    [columns, rows]: [usize; 2],
    memory: usize,
) -> Result<Vec<Pass>, GpuError> {
    let mut passes = Vec::new();
    let mut done = 1;
    for points in split(width, memory)? {
        let first = done == 1;
        passes.push(Pass {
            points,
            batch: batch(points, memory, points < width),
            length: width,
            filled: if first { columns } else { width },
            done,
            lines: rows,
            input: [1, if first { columns } else { width }],
            output: [1, width],
        });
        done *= points;
    }
    done = 1;
    for points in split(height, memory.min(1 << 11))? {
        passes.push(Pass {
            points,
            batch: batch(points, memory, true),
            length: height,
            filled: if done == 1 { rows } else { height },
            done,
            lines: width,
            input: [width, 1],
            output: [width, 1],
        });
        done *= points;
    }
    Ok(passes)
}

/// The points that a workgroup of a device holds: 2048 at least, except in browsers.
///
/// Without a card, a browser takes four seconds to compile the kernels of long sequences, and then
/// runs them more slowly than those of one butterfly each.
fn memory(limits: &Limits) -> usize {
    if cfg!(target_arch = "wasm32") {
        return HELD;
    }
    let threads = limits
        .max_compute_invocations_per_workgroup
        .min(limits.max_compute_workgroup_size_x);
    let threads = (threads as usize).min(MAX_THREADS);
    (limits.max_compute_workgroup_storage_size as usize / 8).min(HELD * threads)
}

/// The sequences of a workgroup: enough for its threads and, where `neighbours` lie side by side,
/// for the lines of a cache.
fn batch(points: usize, memory: usize, neighbours: bool) -> usize {
    if RADICES.contains(&points) {
        // One butterfly needs no memory of the workgroup.
        return SINGLE;
    }
    let wanted = MIN_POINTS.div_ceil(points);
    let wanted = wanted.max(if neighbours { NEIGHBOURS } else { 1 });
    wanted.min(memory / points).max(1)
}

/// The factors of a length, as few as fit the memory.
fn split(length: usize, memory: usize) -> Result<Vec<usize>, GpuError> {
    let radices = radices(length)?;
    if memory <= HELD {
        return Ok(radices);
    }
    if length <= memory {
        return Ok(vec![length]);
    }
    let side = length.isqrt();
    let factor = (1..=side)
        .rev()
        .find(|&factor| length.is_multiple_of(factor));
    let factor = factor.unwrap_or(1);
    let factors = vec![length / factor, factor];
    if factors[0] > memory {
        return Err(GpuError::Size(length));
    }
    Ok(factors)
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

/// The kernel: the stages of `batch` sequences of `points`, each thread with butterflies of its
/// own.
///
/// Every index of a value is a constant, so that values stay in registers.
fn stages(points: usize, batch: usize) -> String {
    let threads = match RADICES.contains(&points) {
        true => batch,
        false => (points * batch).div_ceil(HELD),
    };
    let mut text = vec![format!(
        "@compute @workgroup_size({threads})
        fn transform(
            @builtin(workgroup_id) group: vec3<u32>,
            @builtin(num_workgroups) groups: vec3<u32>,
            @builtin(local_invocation_index) thread: u32,
        ) {{
            let first = (group.y * groups.x + group.x) * BATCH;"
    )];
    let mut done = 1;
    for radix in radices(points).unwrap_or_default() {
        let (is_first, is_last) = (done == 1, done * radix == points);
        let butterflies = points / radix;
        let all = butterflies * batch;
        let turns = 0..all.div_ceil(threads);
        text.push("{".to_owned());
        for k in turns.clone() {
            let values = (0..radix).map(|r| {
                let point = format!("own{k}.y + {}u", r * butterflies);
                match (is_first, r) {
                    (true, _) => format!("loaded(sequence{k}, {point})"),
                    (_, 0) => format!("memory[cell(own{k}.x, {point})]"),
                    _ => format!("tem00_complex_product(memory[cell(own{k}.x, {point})], w{r})"),
                }
            });
            let values = values.collect::<Vec<_>>().join(", ");
            text.push(format!(
                "let at{k} = thread + {}u;
                let own{k} = work(at{k}, {butterflies}u);
                let sequence{k} = sequence(first + own{k}.x);
                var v{k}: array<vec2<f32>, {radix}>;
                if at{k} < {all}u {{
                    {factors}
                    v{k} = tem00_dft{radix}(array<vec2<f32>, {radix}>({values}));
                }}",
                k * threads,
                factors = if is_first {
                    String::new()
                } else {
                    factors(&format!("own{k}.y"), done, radix)
                },
            ));
        }
        // What others read is read before it is overwritten, and written before it is read.
        if !is_first && !is_last {
            text.push("workgroupBarrier();".to_owned());
        }
        for k in turns {
            text.push(format!(
                "if at{k} < {all}u {{ let to = tem00_stockham(own{k}.y, 0u, {done}u, {radix}u);"
            ));
            text.extend((0..radix).map(|r| {
                let to = format!("to + {}u", r * done);
                match is_last {
                    true => format!("store(sequence{k}, {to}, v{k}[{r}]);"),
                    false => format!("memory[cell(own{k}.x, {to})] = v{k}[{r}];"),
                }
            }));
            text.push("}".to_owned());
        }
        if !is_last {
            text.push("workgroupBarrier();".to_owned());
        }
        text.push("}".to_owned());
        done *= radix;
    }
    text.push("}".to_owned());
    text.join("\n")
}

/// The factors `w1`, `w2` … of the values of a butterfly: powers of the first, each of two that are
/// half as high.
fn factors(own: &str, done: usize, radix: usize) -> String {
    let powers = (2..radix).map(|r| {
        let [low, high] = [r / 2, r - r / 2];
        format!("let w{r} = tem00_complex_product(w{low}, w{high});")
    });
    let first = format!("let w1 = tem00_twiddle({own}, 1u, {done}u, {radix}u);");
    [first].into_iter().chain(powers).collect()
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
