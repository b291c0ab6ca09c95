//! The factors of a plane that has moved under a laser, on the card and by the library.
//!
//! ```sh
//! cargo run --release -p tem00-gpu --example factors
//! ```

use std::error::Error;

use tem00_gpu::{
    Gpu, GpuError, GpuStack,
    wgpu::{self, BufferUsages, util::DeviceExt as _},
};
use tem00_shading::{Camera, CameraDescription, DVec3, Laser, Pose, Speckle};

/// The factors of hits, each a point and its normal, in a frame of the library's rows.
pub(crate) fn on_card(
    gpu: &Gpu,
    stack: &GpuStack,
    frame: &[[f32; 4]; 14],
    hits: &[[[f32; 4]; 2]],
) -> Result<Vec<f32>, GpuError> {
    let device = gpu.device();
    let text = [
        tem00_decorrelation::closed_form::WGSL,
        tem00_shading::WGSL,
        &GpuStack::wgsl(0),
        include_str!("factors.wgsl"),
    ];
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.concat().into()),
    });
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        })
    };
    let factors = vec![0_f32; hits.len()];
    let buffers = [
        buffer(bytemuck::cast_slice(frame), BufferUsages::UNIFORM),
        buffer(bytemuck::cast_slice(hits), BufferUsages::STORAGE),
        buffer(
            bytemuck::cast_slice(&factors),
            BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        ),
    ];
    let copy = buffer(
        bytemuck::cast_slice(&factors),
        BufferUsages::MAP_READ | BufferUsages::COPY_DST,
    );
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            entry(0, wgpu::BufferBindingType::Uniform),
            entry(1, storage(true)),
            entry(2, storage(false)),
        ],
    });
    let both = [Some(&GpuStack::bind_group_layout(gpu)), Some(&layout)];
    let layouts = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &both,
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layouts),
        module: &module,
        entry_point: None,
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let entries: Vec<_> = (0..)
        .zip(&buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, stack.bind_group(), &[]);
    pass.set_bind_group(1, &group, &[]);
    pass.dispatch_workgroups(
        u32::try_from(hits.len().div_ceil(64)).unwrap_or(u32::MAX),
        1,
        1,
    );
    drop(pass);
    encoder.copy_buffer_to_buffer(&buffers[2], 0, &copy, 0, copy.size());
    gpu.queue().submit([encoder.finish()]);
    gpu.read(&copy)
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let camera = Camera::new(CameraDescription {
        position: DVec3::new(0.1, 0.0, 0.3),
        resolution: [64, 48],
        ..CameraDescription::default()
    })?;
    let laser = Laser::spot(650e-9, 0.2e-3).placed(DVec3::Z * 0.5, DVec3::ZERO, DVec3::X)?;
    let motion = Pose::along(DVec3::X * 1e-4)?.into();
    let speckle = Speckle::new(&camera, &laser, 1).for_motions([motion]);

    // On the card: the stack once, and the rows of each frame.
    let gpu = Gpu::new()?;
    let kernel = speckle.clone().for_kernel()?;
    let stack = GpuStack::generate(&gpu, kernel.field(), kernel.path())?;
    let hits: Vec<_> = (0..4096_u16)
        .map(|i| [i % 64, i / 64].map(|n| 1e-5 * f32::from(n) - 3e-4))
        .map(|[x, y]| [[x, y, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
        .collect();
    let factors = on_card(&gpu, &stack, &kernel.rows(&motion)?, &hits)?;

    // By the library.
    let frame = speckle.prepare()?.frame(&motion)?;
    for ([[x, y, ..], _], factor) in hits.into_iter().zip(factors) {
        let expected = frame.factor(DVec3::new(x.into(), y.into(), 0.0), DVec3::Z);
        if (f64::from(factor) - expected).abs() > 2e-3 {
            return Err(format!("at {x}, {y} the factor is {factor}, not {expected}").into());
        }
    }
    Ok(())
}
