//! Kernels from text, their buffers, and orders to them.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferDescriptor, BufferUsages,
    ComputePass, ComputePipeline,
    util::{BufferInitDescriptor, DeviceExt},
};

use crate::{Gpu, GpuError};

/// The buffers of a group, bound in their order.
pub(crate) fn bind(gpu: &Gpu, layout: &wgpu::BindGroupLayout, buffers: &[&Buffer]) -> BindGroup {
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    gpu.device().create_bind_group(&BindGroupDescriptor {
        label: Some("tem00"),
        layout,
        entries: &entries,
    })
}

/// Orders `groups` workgroups of a kernel whose only group are these buffers.
pub(crate) fn dispatch(
    gpu: &Gpu,
    pass: &mut ComputePass<'_>,
    pipeline: &ComputePipeline,
    buffers: &[&Buffer],
    [x, y]: [usize; 2],
) {
    let group = bind(gpu, &pipeline.get_bind_group_layout(0), buffers);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(to_u32(x), to_u32(y), 1);
}

/// A storage buffer that can be copied from and to.
pub(crate) fn storage(gpu: &Gpu, what: &'static str, bytes: u64) -> Result<Buffer, GpuError> {
    let limits = gpu.device().limits();
    let allowed = limits
        .max_buffer_size
        .min(limits.max_storage_buffer_binding_size);
    if bytes > allowed {
        let needed = bytes;
        return Err(GpuError::TooLarge {
            what,
            needed,
            allowed,
        });
    }
    Ok(empty(
        gpu,
        bytes,
        BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
    ))
}

/// A storage buffer with these numbers.
pub(crate) fn uploaded<T: bytemuck::Pod>(
    gpu: &Gpu,
    what: &'static str,
    values: &[T],
) -> Result<Buffer, GpuError> {
    let buffer = storage(gpu, what, size_of_val(values) as u64)?;
    gpu.queue()
        .write_buffer(&buffer, 0, bytemuck::cast_slice(values));
    Ok(buffer)
}

/// A uniform of these numbers, those of `f32` by their bits.
pub(crate) fn uniform(gpu: &Gpu, numbers: &[u32]) -> Buffer {
    gpu.device().create_buffer_init(&BufferInitDescriptor {
        label: Some("tem00"),
        contents: bytemuck::cast_slice(numbers),
        usage: BufferUsages::UNIFORM,
    })
}

/// Copies the first `bytes` of a buffer from the device and returns them as numbers.
pub(crate) fn download<T: bytemuck::Pod>(
    gpu: &Gpu,
    buffer: &Buffer,
    bytes: u64,
) -> Result<Vec<T>, GpuError> {
    let copy = empty(gpu, bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let mut encoder = gpu.device().create_command_encoder(&<_>::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
    gpu.queue().submit([encoder.finish()]);
    gpu.read(&copy)
}

fn empty(gpu: &Gpu, bytes: u64, usage: BufferUsages) -> Buffer {
    gpu.device().create_buffer(&BufferDescriptor {
        label: Some("tem00"),
        size: bytes,
        usage,
        mapped_at_creation: false,
    })
}

/// A count that the limits of patterns and stacks keep below 2³².
pub(crate) fn to_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
