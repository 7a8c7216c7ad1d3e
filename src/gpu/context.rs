//! A device of our own, for pictures without a window.

use super::GpuError;

/// A Vulkan device and its queue.
#[derive(Debug, Clone)]
pub struct Context {
    /// Device.
    pub device: wgpu::Device,
    /// Queue.
    pub queue: wgpu::Queue,
    /// What the driver calls itself.
    pub adapter_name: String,
}

impl Context {
    /// Opens the best Vulkan device, a software one if there is no other.
    ///
    /// # Errors
    /// There is no Vulkan driver, or it refuses.
    pub fn headless() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| GpuError::NoDriver { reason: e.to_string() })?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("hairline"),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| GpuError::NoDriver { reason: e.to_string() })?;
        Ok(Self { device, queue, adapter_name: adapter.get_info().name })
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// The device was lost.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
            .map_err(|e| GpuError::Lost { reason: e.to_string() })
    }
}
