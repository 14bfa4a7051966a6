//! Adapters and their devices, for callers that have none.

use wgpu::{Adapter, Backends, Device, DeviceDescriptor, Instance, InstanceDescriptor, Queue};

use crate::GpuError;

/// A device with all that its adapter allows.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The adapter, in words.
    pub name: String,
    /// The device.
    pub device: Device,
    /// Its queue.
    pub queue: Queue,
}

impl Gpu {
    /// The adapter that wgpu takes for the fastest.
    ///
    /// Errors: there is none, or it gives no device.
    pub async fn open() -> Result<Self, GpuError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = instance().request_adapter(&options).await.map_err(|_| GpuError::NoAdapter)?;
        Self::of(&adapter).await
    }

    /// All adapters, software ones included.
    ///
    /// Errors: there is none, or one gives no device.
    pub async fn open_all() -> Result<Vec<Self>, GpuError> {
        let mut gpus = Vec::new();
        for adapter in instance().enumerate_adapters(BACKENDS).await {
            gpus.push(Self::of(&adapter).await?);
        }
        if gpus.is_empty() { Err(GpuError::NoAdapter) } else { Ok(gpus) }
    }

    async fn of(adapter: &Adapter) -> Result<Self, GpuError> {
        let name = adapter.get_info().name;
        let descriptor = DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() };
        match adapter.request_device(&descriptor).await {
            Ok((device, queue)) => Ok(Self { name, device, queue }),
            Err(error) => Err(GpuError::NoDevice { adapter: name, reason: error.to_string() }),
        }
    }
}

/// Without OpenGL, whose compute shaders are few and old.
const BACKENDS: Backends = Backends::PRIMARY;

fn instance() -> Instance {
    Instance::new(InstanceDescriptor {
        backends: BACKENDS,
        ..InstanceDescriptor::new_without_display_handle()
    })
}
