//! Look-ups in a pass of somebody else's, on their device.

use tem00_gpu::{
    Gpu, GpuStack,
    wgpu::{
        self, Color, ColorTargetState, ColorWrites, Extent3d, FragmentState, LoadOp,
        MultisampleState, Operations, PipelineLayoutDescriptor, PrimitiveState,
        RenderPassColorAttachment, RenderPassDescriptor, RenderPipelineDescriptor,
        ShaderModuleDescriptor, ShaderSource, StoreOp, TextureDescriptor, TextureDimension,
        TextureFormat, TextureUsages, VertexState,
    },
};
use tem00_speckle::{PupilField, SlicePath};

/// Pixels of the image; a row is as long as copies ask for.
const IMAGE: [u32; 2] = [64, 48];

/// A pixel shows the pattern at its place, scaled and shifted.
const SHADER: &str = "
    @vertex
    fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
        return vec4<f32>(f32(4u * (index & 1u)) - 1.0, f32(2u * (index & 2u)) - 1.0, 0.0, 1.0);
    }
    @fragment
    fn shade(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
        return tem00_stack_intensity(tem00_stack, 1.75 * at.x - 40.0, 0.625 * at.y, 0.0625 * at.x);
    }
";

/// Draws one triangle over the image and returns its pixels.
fn drawn(gpu: &Gpu, stack: &GpuStack) -> Vec<f32> {
    let device = gpu.device();
    let [width, height] = IMAGE;
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::R32Float,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&<_>::default());
    let pipeline = pipeline(gpu);
    let mut encoder = device.create_command_encoder(&<_>::default());
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        color_attachments: &[Some(RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations {
                load: LoadOp::Clear(Color::BLACK),
                store: StoreOp::Store,
            },
        })],
        ..<_>::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(1, stack.bind_group(), &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * width * height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * width),
        rows_per_image: None,
    };
    let destination = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, size);
    gpu.queue().submit([encoder.finish()]);
    gpu.read(&buffer).expect("pixels")
}

/// The stack is group 1; group 0 is left to the renderer, which here has nothing to bind.
fn pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let device = gpu.device();
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: None,
        source: ShaderSource::Wgsl((GpuStack::wgsl(1) + SHADER).into()),
    });
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[None, Some(&GpuStack::bind_group_layout(gpu))],
        immediate_size: 0,
    });
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: VertexState {
            module: &module,
            entry_point: None,
            compilation_options: <_>::default(),
            buffers: &[],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: None,
        multisample: MultisampleState::default(),
        fragment: Some(FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: <_>::default(),
            targets: &[Some(ColorTargetState {
                format: TextureFormat::R32Float,
                blend: None,
                write_mask: ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[test]
fn a_pass_of_a_renderer_shows_the_pattern() {
    // The renderer's own device and queue, opened as it likes.
    let theirs = Gpu::new().expect("an adapter");
    let gpu = Gpu::of(
        theirs.device().clone(),
        theirs.queue().clone(),
        "theirs".into(),
    );
    let field = PupilField::new(120, 48, 6).expect("a field");
    let stack = GpuStack::generate(&gpu, &field, SlicePath::Circle { half_period: 4 });
    let stack = stack.expect("a stack");
    let pixels = drawn(&gpu, &stack);
    let points: Vec<_> = (0..IMAGE[0] * IMAGE[1])
        .map(|i| [i % IMAGE[0], i / IMAGE[0]].map(|n| n as f32 + 0.5))
        .map(|[x, y]| [1.75 * x - 40.0, 0.625 * y, 0.0625 * x])
        .collect();
    let expected = stack.intensities(&points).expect("intensities");
    for (i, (got, expected)) in pixels.iter().zip(expected).enumerate() {
        assert!(
            (got - expected).abs() < 2e-5,
            "pixel {i}: {got}, not {expected}"
        );
    }
}
