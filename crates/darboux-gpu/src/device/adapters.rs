//! Adapters and their devices, for callers that have none.

use std::fmt;

use wgpu::{
    Adapter, Backends, Buffer, CommandEncoder, Device, DeviceDescriptor, DeviceType, Features, Instance,
    InstanceDescriptor, Queue,
};

use crate::GpuError;
use crate::device::mesh_buffers::largest_buffer;
use crate::device::readback;

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

/// What an adapter says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: AdapterKind,
    /// The interface that it is reached by: Vulkan, Metal, Dx12.
    pub backend: String,
    /// Its driver and that driver's version.
    pub driver: String,
    /// The bytes that shaders can reach of one buffer.
    pub largest_binding: u64,
}

/// What an adapter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdapterKind {
    /// A GPU with memory of its own.
    Discrete,
    /// A GPU that shares the CPU's memory.
    Integrated,
    /// A part of a GPU, or one behind a virtual machine.
    Virtual,
    /// A CPU that runs shaders: for tests.
    Software,
    /// It does not say.
    Unknown,
}

impl fmt::Display for AdapterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Software => "software",
            Self::Unknown => "unknown",
        })
    }
}

impl From<DeviceType> for AdapterKind {
    fn from(device: DeviceType) -> Self {
        match device {
            DeviceType::DiscreteGpu => Self::Discrete,
            DeviceType::IntegratedGpu => Self::Integrated,
            DeviceType::VirtualGpu => Self::Virtual,
            DeviceType::Cpu => Self::Software,
            DeviceType::Other => Self::Unknown,
        }
    }
}

impl AdapterSummary {
    fn of(adapter: &Adapter) -> Self {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        Self {
            name: info.name,
            kind: info.device_type.into(),
            backend: info.backend.to_string(),
            driver: [info.driver, info.driver_info].join(" ").trim().to_owned(),
            largest_binding: largest_buffer(&limits),
        }
    }
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

    /// All adapters, software ones only where there are no others.
    ///
    /// Errors: there is none, or one gives no device.
    pub async fn open_all() -> Result<Vec<Self>, GpuError> {
        let mut adapters = instance().enumerate_adapters(BACKENDS).await;
        let is_software = |adapter: &Adapter| adapter.get_info().device_type == DeviceType::Cpu;
        if !adapters.iter().all(is_software) {
            adapters.retain(|adapter| !is_software(adapter));
        }
        let mut gpus = Vec::new();
        for adapter in &adapters {
            gpus.push(Self::of(adapter).await?);
        }
        if gpus.is_empty() { Err(GpuError::NoAdapter) } else { Ok(gpus) }
    }

    /// All adapters, software ones included, each with its device or why it gives none.
    pub async fn list() -> Vec<(AdapterSummary, Result<Self, GpuError>)> {
        let mut found = Vec::new();
        for adapter in instance().enumerate_adapters(BACKENDS).await {
            found.push((AdapterSummary::of(&adapter), Self::of(&adapter).await));
        }
        found
    }

    /// What its adapter is.
    pub fn kind(&self) -> AdapterKind {
        self.device.adapter_info().device_type.into()
    }

    /// Runs `work`, whose calls of the device would panic where the device refuses.
    ///
    /// Errors: those of `work`; the device has no memory left, or refused something.
    pub fn guarded<T, E: From<GpuError>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        readback::guarded(&self.device, || Ok(work()))?
    }

    /// Submits what `record` records; gives what is in `buffer` then, which allows to be copied from. Errors: the device is lost.
    pub fn read(
        &self,
        record: impl FnOnce(&mut CommandEncoder),
        buffer: &Buffer,
    ) -> Result<Vec<u8>, GpuError> {
        let [copy] = readback::submit(&self.device, &self.queue, record, [buffer]);
        copy.read(&self.device)
    }

    async fn of(adapter: &Adapter) -> Result<Self, GpuError> {
        let name = adapter.get_info().name;
        let descriptor = DeviceDescriptor {
            required_features: adapter.features() & CLOCK,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        match adapter.request_device(&descriptor).await {
            Ok((device, queue)) => Ok(Self { name, device, queue }),
            Err(error) => Err(GpuError::NoDevice { adapter: name, reason: error.to_string() }),
        }
    }
}

/// What measuring needs.
const CLOCK: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// Without OpenGL, whose compute shaders are few and old.
const BACKENDS: Backends = Backends::PRIMARY;

fn instance() -> Instance {
    Instance::new(InstanceDescriptor {
        backends: BACKENDS,
        ..InstanceDescriptor::new_without_display_handle()
    })
}
