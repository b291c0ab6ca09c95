use core::fmt;

use tem00_speckle::{
    Aperture, PupilField, SliceLaw, SlicePath, SpeckleStack, StackOptions, StackSource, closed_form,
};
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType,
    Buffer, BufferBindingType, ComputePipeline, PipelineLayout, PipelineLayoutDescriptor,
    ShaderStages,
};

use crate::{
    Gpu, GpuError,
    kernel::{bind, download, storage, to_u32, uniform, uploaded},
    transform::{Finish, Transform},
};

/// Points of a batch that one order looks up: 48 MiB of coordinates.
const BATCH: usize = 1 << 22;

/// Threads of a workgroup.
const GROUP: usize = 64;

/// A stack of speckle on the card, for look-ups there.
///
/// It has the coefficients and the laws of a [`SpeckleStack`]: uploaded, or generated on the card
/// from the seed, where both agree to the rounding of `f32`.
///
/// # Examples
///
/// ```no_run
/// use tem00_gpu::{Gpu, GpuStack};
/// use tem00_speckle::{PupilField, SlicePath};
///
/// let gpu = Gpu::new()?;
/// let field = PupilField::new(512, 256, 7)?;
/// let path = SlicePath::Straight { half_period: 16, length: 2 };
/// let stack = GpuStack::generate(&gpu, &field, path)?;
///
/// // x and y in samples, u in slices.
/// let intensities = stack.intensities(&[[3.5, 60.25, 0.0], [3.5, 60.25, 1.5]])?;
/// assert_eq!(intensities.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # In a pass of your own
///
/// A shader begins with [`wgsl`](Self::wgsl), its pipeline has
/// [`bind_group_layout`](Self::bind_group_layout) at that group, and its pass sets
/// [`bind_group`](Self::bind_group) there. [`Gpu::of`] takes the device and the queue of the
/// renderer.
#[derive(Clone)]
pub struct GpuStack {
    gpu: Gpu,
    size: [usize; 2],
    slices: usize,
    coefficients: Buffer,
    laws: Buffer,
    group: BindGroup,
    look_up: ComputePipeline,
    /// What has generated the slices here.
    transform: Option<Transform>,
}

impl fmt::Debug for GpuStack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GpuStack")
            .field("gpu", &self.gpu.name())
            .field("size", &self.size)
            .field("slices", &self.slices)
            .finish_non_exhaustive()
    }
}

impl GpuStack {
    /// Generates the slices of `field` along `path` on the card.
    ///
    /// # Errors
    ///
    /// As [`generate_with`](Self::generate_with).
    pub fn generate(gpu: &Gpu, field: &PupilField, path: SlicePath) -> Result<Self, GpuError> {
        Self::generate_with(gpu, field, path, StackOptions::default())
    }

    /// Generates the slices of `field` along `path` on the card.
    ///
    /// # Errors
    ///
    /// Returns an error if the half period of `path` is zero or too large, if its length is, if the
    /// slices take more than the memory limit or than a buffer of the device, if a side of the
    /// pattern has a prime factor above 5, or if the device fails.
    pub fn generate_with(
        gpu: &Gpu,
        field: &PupilField,
        path: SlicePath,
        options: StackOptions,
    ) -> Result<Self, GpuError> {
        let source = StackSource::new(field, path, options)?;
        let field = source.field();
        gpu.guarded(|| {
            let coefficients = storage(gpu, "the stack", path.memory_bytes(field.size()))?;
            let transform = Transform::new(gpu, field, &source.slice(0))?;
            transform.run(gpu, slices(&source, path), &coefficients);
            let mut stack = Self::assemble(gpu, coefficients, field.size(), &source.laws())?;
            stack.transform = Some(transform);
            Ok(stack)
        })
    }

    /// Generates other slices in the same buffers, which [`bind_group`](Self::bind_group) keeps,
    /// and where the pupil fills the same box with the same memory for the transform. A stack of
    /// another size, and one that was uploaded, gets buffers of its own.
    ///
    /// # Errors
    ///
    /// As [`generate_with`](Self::generate_with).
    pub fn refill(
        &mut self,
        field: &PupilField,
        path: SlicePath,
        options: StackOptions,
    ) -> Result<(), GpuError> {
        let source = StackSource::new(field, path, options)?;
        let closed = source.field();
        let is_same = [closed.size(), [path.slice_count(); 2]] == [self.size, [self.slices; 2]];
        let Some(transform) = self.transform.as_mut().filter(|_| is_same) else {
            *self = Self::generate_with(&self.gpu, field, path, options)?;
            return Ok(());
        };
        let gpu = &self.gpu;
        gpu.guarded(|| {
            transform.renew(gpu, closed, &source.slice(0))?;
            transform.run(gpu, slices(&source, path), &self.coefficients);
            let rows = rows(&source.laws(), self.size);
            let bytes = bytemuck::cast_slice(rows.as_flattened());
            gpu.queue().write_buffer(&self.laws, 0, bytes);
            Ok(())
        })
    }

    /// Uploads a stack of the library.
    ///
    /// # Errors
    ///
    /// Returns an error if the slices take more than a buffer of the device, or if the device
    /// fails.
    pub fn upload(gpu: &Gpu, stack: &SpeckleStack) -> Result<Self, GpuError> {
        let [width, height] = stack.size();
        gpu.guarded(|| {
            let coefficients = storage(gpu, "the stack", stack.memory_bytes())?;
            for slice in 0..stack.slice_count() {
                let values = stack.coefficients(slice).values();
                let first = 8 * (slice * width * height) as u64;
                gpu.queue()
                    .write_buffer(&coefficients, first, bytemuck::cast_slice(values));
            }
            let laws = (0..stack.slice_count()).map(|slice| stack.slice_law(slice));
            Self::assemble(gpu, coefficients, stack.size(), &laws.collect::<Vec<_>>())
        })
    }

    fn assemble(
        gpu: &Gpu,
        coefficients: Buffer,
        size: [usize; 2],
        laws: &[SliceLaw],
    ) -> Result<Self, GpuError> {
        let slices = laws.len();
        let laws = rows(laws, size);
        let laws = uploaded(gpu, "the laws of the slices", laws.as_flattened())?;
        let sides = [size[0], size[1], slices, 0].map(to_u32);
        let layout = Self::bind_group_layout(gpu);
        let group = bind(gpu, &layout, &[&uniform(gpu, &sides), &coefficients, &laws]);
        Ok(Self {
            gpu: gpu.clone(),
            size,
            slices,
            coefficients,
            laws,
            group,
            look_up: gpu.pipeline("look-up", || look_up_source(gpu)),
            transform: None,
        })
    }

    /// Returns the functions of `tem00_speckle::closed_form::WGSL` with the stack that they read,
    /// `tem00_stack`, bound as this group: what a shader of your own begins with.
    pub fn wgsl(group: u32) -> String {
        let bindings = include_str!("../shaders/stack.wgsl").replace("GROUP", &group.to_string());
        format!("{}\n{bindings}", closed_form::WGSL)
    }
    /// Returns the layout of [`bind_group`](Self::bind_group), for compute and fragment shaders: a
    /// uniform and two storage buffers that are read.
    pub fn bind_group_layout(gpu: &Gpu) -> BindGroupLayout {
        let read = BufferBindingType::Storage { read_only: true };
        gpu.device()
            .create_bind_group_layout(&BindGroupLayoutDescriptor {
                label: Some("tem00 stack"),
                entries: &[
                    entry(0, BufferBindingType::Uniform),
                    entry(1, read),
                    entry(2, read),
                ],
            })
    }

    /// Returns the stack as the group that [`wgsl`](Self::wgsl) declares.
    pub const fn bind_group(&self) -> &BindGroup {
        &self.group
    }

    /// Returns the periods in the plane, in samples: the width and the height.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the number of slices, which is the period in u.
    pub const fn slice_count(&self) -> usize {
        self.slices
    }

    /// Looks up the intensities, with mean 1, at points (x, y, u): x and y in samples and u in
    /// slices, all finite and below 2³¹.
    ///
    /// # Errors
    ///
    /// Returns an error if the device fails.
    pub fn intensities(&self, points: &[[f32; 3]]) -> Result<Vec<f32>, GpuError> {
        let mut intensities = Vec::with_capacity(points.len());
        for batch in points.chunks(BATCH) {
            intensities.extend(self.gpu.guarded(|| self.batch(batch))?);
        }
        Ok(intensities)
    }

    fn batch(&self, points: &[[f32; 3]]) -> Result<Vec<f32>, GpuError> {
        let gpu = &self.gpu;
        let bytes = size_of_val(points) as u64 / 3;
        let points_there = uploaded(gpu, "the points", points.as_flattened())?;
        let intensities = storage(gpu, "the intensities", bytes)?;
        let layout = self.look_up.get_bind_group_layout(1);
        let group = bind(gpu, &layout, &[&points_there, &intensities]);
        let mut encoder = gpu.device().create_command_encoder(&<_>::default());
        let mut pass = encoder.begin_compute_pass(&<_>::default());
        pass.set_pipeline(&self.look_up);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(1, &group, &[]);
        let groups = points.len().div_ceil(GROUP);
        let wide = groups.min(1 << 12);
        pass.dispatch_workgroups(to_u32(wide), to_u32(groups.div_ceil(wide)), 1);
        drop(pass);
        gpu.queue().submit([encoder.finish()]);
        download(gpu, &intensities, bytes)
    }
}

/// Returns the slices of a stack, each with its finish.
fn slices(source: &StackSource, path: SlicePath) -> impl Iterator<Item = (Aperture<'_>, Finish)> {
    let slices = 0..path.slice_count();
    slices.map(|slice| (source.slice(slice), Finish::Amplitude { slice }))
}

/// Returns the rows of the laws of slices, as the shader reads them.
fn rows(laws: &[SliceLaw], size: [usize; 2]) -> Vec<[[f32; 4]; 14]> {
    laws.iter().map(|law| law.rows(size)).collect()
}

/// The kernel of batches.
fn look_up_source(gpu: &Gpu) -> (String, Option<PipelineLayout>) {
    let text = GpuStack::wgsl(0) + include_str!("../shaders/look_up.wgsl");
    let points = gpu
        .device()
        .create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("tem00 points"),
            entries: &[
                entry(0, BufferBindingType::Storage { read_only: true }),
                entry(1, BufferBindingType::Storage { read_only: false }),
            ],
        });
    let layout = gpu
        .device()
        .create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("tem00 look-up"),
            bind_group_layouts: &[Some(&GpuStack::bind_group_layout(gpu)), Some(&points)],
            immediate_size: 0,
        });
    (text, Some(layout))
}

const fn entry(binding: u32, ty: BufferBindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE.union(ShaderStages::FRAGMENT),
        ty: BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}
