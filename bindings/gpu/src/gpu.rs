use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use wgpu::{
    ComputePipeline, ComputePipelineDescriptor, DeviceDescriptor, ErrorFilter, Instance,
    InstanceDescriptor, MapMode, PipelineCompilationOptions, PipelineLayout, PollType,
    RequestAdapterOptions, ShaderModuleDescriptor, ShaderSource,
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
    /// The kernels that have been compiled, by their names.
    kernels: Arc<Mutex<HashMap<String, ComputePipeline>>>,
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
        Ok(Self::of(device, queue, adapter.get_info().name))
    }

    /// Uses a device and a queue of the caller's, whose name is only for messages.
    pub fn of(device: wgpu::Device, queue: wgpu::Queue, name: String) -> Self {
        Self {
            device,
            queue,
            name,
            kernels: Arc::default(),
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
    /// Returns an error if the device fails or is lost, and in a browser, where nothing can be
    /// waited for.
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
            .try_recv()
            .map_err(|_| failed(&"a browser waits for no buffer"))?
            .map_err(|error| failed(&error))?;
        let bytes = buffer
            .get_mapped_range(..)
            .map_err(|error| failed(&error))?;
        let values = bytemuck::pod_collect_to_vec(&bytes[..]);
        drop(bytes);
        buffer.unmap();
        Ok(values)
    }

    /// The kernel of this name, made of its text once; without a layout, all bindings in group 0.
    pub(crate) fn pipeline(
        &self,
        name: &str,
        source: impl FnOnce() -> (String, Option<PipelineLayout>),
    ) -> ComputePipeline {
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kernel) = kernels.get(name) {
            return kernel.clone();
        }
        let (text, layout) = source();
        let kernel = self.compiled(&text, layout.as_ref());
        kernels.insert(name.to_owned(), kernel.clone());
        kernel
    }

    fn compiled(&self, text: &str, layout: Option<&PipelineLayout>) -> ComputePipeline {
        let module = self.device.create_shader_module(ShaderModuleDescriptor {
            label: Some("tem00"),
            source: ShaderSource::Wgsl(text.into()),
        });
        self.device
            .create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some("tem00"),
                layout,
                module: &module,
                entry_point: None,
                compilation_options: PipelineCompilationOptions::default(),
                cache: None,
            })
    }

    /// Runs `orders` and returns errors of the device as errors instead of panics.
    pub(crate) fn guarded<T>(
        &self,
        orders: impl FnOnce() -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        // A browser tells of them later only, where the page has asked for uncaptured errors.
        if cfg!(target_arch = "wasm32") {
            return orders();
        }
        let scope = |filter| self.device.push_error_scope(filter);
        let scopes = [
            scope(ErrorFilter::Internal),
            scope(ErrorFilter::Validation),
            scope(ErrorFilter::OutOfMemory),
        ];
        let result = orders();
        let errors: Vec<_> = scopes
            .into_iter()
            .rev()
            .filter_map(|scope| pollster::block_on(scope.pop()))
            .collect();
        match errors.first() {
            Some(error) => result.and(Err(GpuError::Device(error.to_string()))),
            None => result,
        }
    }
}
