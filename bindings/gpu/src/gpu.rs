use wgpu::{
    DeviceDescriptor, Instance, InstanceDescriptor, MapMode, PollType, RequestAdapterOptions,
};

use crate::GpuError;

/// A device that computes, and its queue.
///
/// Clones share both.
#[derive(Clone, Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
}

impl Gpu {
    /// Opens the adapter that the system prefers, with all that it allows of buffers.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no adapter, not even one in software, or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let adapter =
            pollster::block_on(instance.request_adapter(&RequestAdapterOptions::default()))
                .map_err(|error| GpuError::NoAdapter(error.to_string()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&DeviceDescriptor {
            label: Some("tem00"),
            required_limits: adapter.limits(),
            ..DeviceDescriptor::default()
        }))
        .map_err(|error| GpuError::NoDevice(error.to_string()))?;
        Ok(Self {
            device,
            queue,
            name: adapter.get_info().name,
        })
    }

    /// Uses a device and a queue of the caller's, whose name is only for messages.
    pub const fn of(device: wgpu::Device, queue: wgpu::Queue, name: String) -> Self {
        Self {
            device,
            queue,
            name,
        }
    }

    /// Returns the device.
    pub const fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Returns the queue.
    pub const fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Returns the name of the adapter.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Waits for `buffer`, which can be mapped for reading, and returns its content.
    ///
    /// # Errors
    ///
    /// Returns an error if the device fails or is lost.
    pub fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer) -> Result<Vec<T>, GpuError> {
        let failed = |error: &dyn core::fmt::Display| GpuError::Device(error.to_string());
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(MapMode::Read, .., move |result| {
            // Nobody waits any more where sending fails.
            drop(sender.send(result));
        });
        self.device
            .poll(PollType::wait_indefinitely())
            .map_err(|error| failed(&error))?;
        receiver
            .recv()
            .map_err(|error| failed(&error))?
            .map_err(|error| failed(&error))?;
        let bytes = buffer
            .get_mapped_range(..)
            .map_err(|error| failed(&error))?;
        let values = bytemuck::pod_collect_to_vec(&bytes[..]);
        drop(bytes);
        buffer.unmap();
        Ok(values)
    }
}
