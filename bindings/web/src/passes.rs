//! The two passes: the part's light on a film, and the film on the canvas.

use tem00_gpu::{Gpu, GpuStack};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, Buffer, BufferBindingType,
    BufferDescriptor, BufferUsages, Color, CommandEncoder, FragmentState, LoadOp, Operations,
    PipelineCompilationOptions, PipelineLayoutDescriptor, RenderPassColorAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderModuleDescriptor,
    ShaderSource, ShaderStages, StoreOp, Texture, TextureDescriptor, TextureDimension,
    TextureFormat, TextureUsages, TextureView, VertexState,
};

use crate::{
    code::{FUNCTIONS, code},
    optics::SENSOR,
    scene,
    speckle::Speckle,
};

const FILM: TextureFormat = TextureFormat::Rgba32Float;

/// Rows of a film in a buffer begin at multiples of 256 bytes, as those of this width do.
const ROW_BYTES: u32 = 16 * SENSOR[0];
const _: () = assert!(ROW_BYTES.is_multiple_of(256), "rows are read as they lie");

/// Pipelines and what they read and write.
#[derive(Debug)]
pub struct Passes {
    scene: Buffer,
    film: Texture,
    onto_film: RenderPipeline,
    onto_screen: RenderPipeline,
    scene_of_film: BindGroup,
    scene_of_screen: BindGroup,
}

impl Passes {
    /// Compiles both passes, for a screen of this format.
    pub fn new(gpu: &Gpu, screen: TextureFormat) -> Self {
        let device = gpu.device();
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("page"),
            source: ShaderSource::Wgsl(
                [
                    FUNCTIONS.concat().as_str(),
                    &GpuStack::wgsl(1),
                    code!(include_str!("../shaders/page.wgsl")),
                    code!(include_str!("../shaders/screen.wgsl")),
                ]
                .join("\n")
                .into(),
            ),
        });
        let layout_of_scene = scene_layout(device);
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("film"),
            bind_group_layouts: &[
                Some(&layout_of_scene),
                Some(&GpuStack::bind_group_layout(gpu)),
            ],
            immediate_size: 0,
        });
        let pipeline = |entry, layout, format: TextureFormat| {
            device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(entry),
                layout,
                vertex: VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(FragmentState {
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: PipelineCompilationOptions::default(),
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let onto_film = pipeline("film", Some(&layout), FILM);
        let onto_screen = pipeline("screen", None, screen);
        let scene = device.create_buffer(&BufferDescriptor {
            label: Some("scene"),
            size: 16 * scene::COUNT,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let film = film(device);
        let view = film.create_view(&wgpu::TextureViewDescriptor::default());
        let scene_of_film = device.create_bind_group(&BindGroupDescriptor {
            label: Some("scene"),
            layout: &layout_of_scene,
            entries: &[entry(0, scene.as_entire_binding())],
        });
        let scene_of_screen = device.create_bind_group(&BindGroupDescriptor {
            label: Some("scene and film"),
            layout: &onto_screen.get_bind_group_layout(0),
            entries: &[
                entry(0, scene.as_entire_binding()),
                entry(1, BindingResource::TextureView(&view)),
            ],
        });
        Self {
            scene,
            film,
            onto_film,
            onto_screen,
            scene_of_film,
            scene_of_screen,
        }
    }

    /// Hands the scene to both passes.
    pub fn show(&self, gpu: &Gpu, scene: &[[f32; 4]]) {
        gpu.queue()
            .write_buffer(&self.scene, 0, bytemuck::cast_slice(scene));
    }

    /// Draws the film.
    pub fn expose(&self, encoder: &mut CommandEncoder, speckle: &Speckle) {
        let view = self
            .film
            .create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = begin(encoder, &view);
        pass.set_pipeline(&self.onto_film);
        pass.set_bind_group(0, &self.scene_of_film, &[]);
        pass.set_bind_group(1, speckle.stack.bind_group(), &[]);
        pass.draw(0..3, 0..1);
    }

    /// Draws the film on a screen.
    pub fn project(&self, encoder: &mut CommandEncoder, screen: &TextureView) {
        let mut pass = begin(encoder, screen);
        pass.set_pipeline(&self.onto_screen);
        pass.set_bind_group(0, &self.scene_of_screen, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Copies the film into a buffer that can be read.
    pub fn copy(&self, gpu: &Gpu, encoder: &mut CommandEncoder) -> Buffer {
        let [width, height] = SENSOR;
        let buffer = gpu.device().create_buffer(&BufferDescriptor {
            label: Some("film, to be read"),
            size: u64::from(ROW_BYTES) * u64::from(height),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            self.film.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(ROW_BYTES),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
        );
        buffer
    }
}

fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

fn scene_layout(device: &wgpu::Device) -> BindGroupLayout {
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

fn film(device: &wgpu::Device) -> Texture {
    let [width, height] = SENSOR;
    device.create_texture(&TextureDescriptor {
        label: Some("film"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: FILM,
        usage: TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn begin<'a>(encoder: &'a mut CommandEncoder, target: &TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: Operations {
                load: LoadOp::Clear(Color::BLACK),
                store: StoreOp::Store,
            },
        })],
        ..RenderPassDescriptor::default()
    })
}
