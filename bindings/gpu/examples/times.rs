//! How long do a pattern and the look-ups of an image take on the card, beside the library?
//!
//! ```sh
//! cargo run --release -p tem00-gpu --example times
//! ```

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

use std::{
    error::Error,
    time::{Duration, Instant},
};

use tem00_gpu::{Gpu, GpuPattern, GpuStack, wgpu};
use tem00_speckle::{PupilField, SlicePath, SpeckleStack, StackOptions};

const SIZES: [usize; 3] = [1024, 2048, 4096];
const PATH: SlicePath = SlicePath::Circle { half_period: 4 };
const IMAGE: [u32; 2] = [1920, 1080];

/// Samples of the pattern between pixels, and the slice between slices: for both sides the same.
const PITCH: f32 = 0.8;
const SLICE: f32 = 2.375;

/// The fastest of the runs of one second, once the kernels are compiled.
fn fastest<E>(mut run: impl FnMut() -> Result<(), E>) -> Result<Duration, E> {
    run()?;
    let begin = Instant::now();
    let mut fastest = Duration::MAX;
    while begin.elapsed() < Duration::from_secs(1) {
        let start = Instant::now();
        run()?;
        fastest = fastest.min(start.elapsed());
    }
    Ok(fastest)
}

/// A pass that looks up every pixel of an image, whose result stays on the card.
struct Pass {
    pipeline: wgpu::ComputePipeline,
    image: wgpu::BindGroup,
}

impl Pass {
    fn new(gpu: &Gpu) -> Self {
        let [width, height] = IMAGE;
        let text = format!(
            "{stack}
            @group(1) @binding(0) var<storage, read_write> image: array<f32>;
            @compute @workgroup_size(8, 8)
            fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
                if id.x < {width}u && id.y < {height}u {{
                    let at = {PITCH} * vec2<f32>(id.xy);
                    image[id.y * {width}u + id.x] = \
                        tem00_stack_intensity(tem00_stack, at.x, at.y, {SLICE});
                }}
            }}",
            stack = GpuStack::wgsl(0),
        );
        let device = gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let image_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: false },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&GpuStack::bind_group_layout(gpu)), Some(&image_layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: None,
            compilation_options: <_>::default(),
            cache: None,
        });
        let image = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * width * height),
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let image = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &image_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: image.as_entire_binding(),
            }],
        });
        Self { pipeline, image }
    }

    fn run(&self, gpu: &Gpu, stack: &wgpu::BindGroup) -> Result<(), wgpu::PollError> {
        let mut encoder = gpu.device().create_command_encoder(&<_>::default());
        let mut pass = encoder.begin_compute_pass(&<_>::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, stack, &[]);
        pass.set_bind_group(1, &self.image, &[]);
        pass.dispatch_workgroups(IMAGE[0].div_ceil(8), IMAGE[1].div_ceil(8), 1);
        drop(pass);
        gpu.queue().submit([encoder.finish()]);
        wait(gpu)
    }
}

fn wait(gpu: &Gpu) -> Result<(), wgpu::PollError> {
    gpu.device()
        .poll(wgpu::PollType::wait_indefinitely())
        .map(drop)
}

fn new_memory(gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
    gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Clears the first number of a buffer: an order that takes no time but its own.
fn clear(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<(), wgpu::PollError> {
    let mut encoder = gpu.device().create_command_encoder(&<_>::default());
    encoder.clear_buffer(buffer, 0, Some(4));
    gpu.queue().submit([encoder.finish()]);
    wait(gpu)
}

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new()?;
    println!("{}", gpu.name());
    let nothing = fastest(|| clear(&gpu, &new_memory(&gpu, 4)))?;
    let memory = fastest(|| clear(&gpu, &new_memory(&gpu, 128 << 20)))?;
    println!("4 bytes of new memory: {nothing:.2?}, 128 MiB: {memory:.2?}");
    for size in SIZES {
        let field = PupilField::new(size, size / 2, 7)?;
        let mut pattern = GpuPattern::generate(&gpu, &field, [0.0; 2], 0.0)?;
        let card = fastest(|| -> Result<(), Box<dyn Error>> {
            pattern.refill(&field, [0.0; 2], 0.0)?;
            Ok(wait(&gpu)?)
        })?;
        let library = fastest(|| {
            field.pattern();
            Ok::<_, Box<dyn Error>>(())
        })?;
        report(&format!("pattern of {size}²"), card, library);
    }

    let field = PupilField::new(SIZES[0], SIZES[0] / 2, 7)?;
    let path = SlicePath::Circle { half_period: 16 };
    let mut stack = GpuStack::generate(&gpu, &field, path)?;
    let card = fastest(|| -> Result<(), Box<dyn Error>> {
        stack.refill(&field, path, StackOptions::default())?;
        Ok(wait(&gpu)?)
    })?;
    let library = fastest(|| SpeckleStack::generate(&field, path).map(drop))?;
    report("stack of 32 slices of 1024²", card, library);

    let library_stack = SpeckleStack::generate(&field, PATH)?;
    let stack = GpuStack::upload(&gpu, &library_stack)?;
    let pass = Pass::new(&gpu);
    let card = fastest(|| pass.run(&gpu, stack.bind_group()))?;
    let place = |n: u32| f64::from(PITCH * n as f32);
    let [x, y]: [Vec<_>; 2] = [0, 1].map(|axis| {
        let pixels = (0..IMAGE[0] * IMAGE[1]).map(|i| [i % IMAGE[0], i / IMAGE[0]]);
        pixels.map(|pixel| place(pixel[axis])).collect()
    });
    let u = vec![f64::from(SLICE); x.len()];
    let mut intensity = vec![0.0; x.len()];
    let library = fastest(|| {
        library_stack.intensity_batch(&x, &y, &u, &mut intensity);
        Ok::<_, Box<dyn Error>>(())
    })?;
    report("look-ups of 1920 × 1080, between slices", card, library);
    Ok(())
}

fn report(what: &str, card: Duration, library: Duration) {
    let ratio = library.as_secs_f64() / card.as_secs_f64();
    println!("{what}: {card:.2?}, library {library:.2?}, ratio {ratio:.3}");
}
