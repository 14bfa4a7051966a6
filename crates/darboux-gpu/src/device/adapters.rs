//! Lists the GPU adapters of this machine and opens devices, for callers that have no wgpu device of their
//! own.

use std::fmt;

use darboux::Context;
use wgpu::{
    Adapter, Backends, Buffer, CommandEncoder, Device, DeviceDescriptor, DeviceType, Features, Instance,
    InstanceDescriptor, Queue,
};

use crate::device::buffers::largest_buffer;
use crate::device::readback;
use crate::error::GpuError;

/// A device that was opened with all limits of its adapter.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The name of the adapter.
    pub name: String,
    /// The device.
    pub device: Device,
    /// Its queue.
    pub queue: Queue,
}

/// The properties that an adapter reports.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct AdapterSummary {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: AdapterKind,
    /// The graphics API: Vulkan, Metal or Dx12.
    pub backend: String,
    /// The name and version of its driver.
    pub driver: String,
    /// The byte length of the largest buffer that a shader can bind.
    pub largest_binding: u64,
}

/// The kind of an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AdapterKind {
    /// A GPU with its own memory.
    Discrete,
    /// A GPU that shares the memory of the CPU.
    Integrated,
    /// A virtual GPU, or a part of a GPU.
    Virtual,
    /// A software implementation that runs shaders on the CPU.
    Software,
    /// The adapter does not report its kind.
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
    /// Opens the adapter that wgpu prefers for high performance.
    ///
    /// Errors: there is no adapter, or it cannot create a device.
    pub async fn open() -> Result<Self, GpuError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = instance().request_adapter(&options).await.map_err(|_| GpuError::NoAdapter)?;
        Self::of(&adapter).await
    }

    /// Opens all hardware adapters, or all software adapters if there is no hardware adapter.
    ///
    /// Errors: there is no adapter, or one cannot create a device.
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

    /// Lists all adapters, including software ones, each with its device or the reason why it cannot create
    /// one.
    pub async fn list() -> Vec<(AdapterSummary, Result<Self, GpuError>)> {
        let mut found = Vec::new();
        for adapter in instance().enumerate_adapters(BACKENDS).await {
            found.push((AdapterSummary::of(&adapter), Self::of(&adapter).await));
        }
        found
    }

    /// The kind of its adapter.
    pub fn kind(&self) -> AdapterKind {
        self.device.adapter_info().device_type.into()
    }

    /// Runs `work` inside error scopes. Without them, wgpu panics when the device reports an error.
    ///
    /// Errors: those of `work`; the device is out of memory, or reported another error.
    pub fn with_error_scopes<T, E: From<GpuError>>(
        &self,
        work: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        readback::with_error_scopes(&self.device, || Ok(work()))?
    }

    /// Submits the commands of `record` and then returns the bytes of `buffer`, which has
    /// `BufferUsages::COPY_SRC`.
    ///
    /// Errors: the device is lost.
    pub fn read(
        &self,
        record: impl FnOnce(&mut CommandEncoder),
        buffer: &Buffer,
    ) -> Result<Vec<u8>, GpuError> {
        let context = &Context::new();
        let [copy] = readback::submit(&self.device, &self.queue, record, [buffer], context)?;
        copy.read(&self.device, context)
    }

    async fn of(adapter: &Adapter) -> Result<Self, GpuError> {
        let name = adapter.get_info().name;
        let descriptor = DeviceDescriptor {
            required_features: adapter.features() & TIMESTAMPS,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        match adapter.request_device(&descriptor).await {
            Ok((device, queue)) => Ok(Self { name, device, queue }),
            Err(error) => Err(GpuError::NoDevice { adapter: name, reason: error.to_string() }),
        }
    }
}

/// The features for measuring times on the device.
const TIMESTAMPS: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// All but OpenGL, which lacks what the compute shaders need.
const BACKENDS: Backends = Backends::PRIMARY;

fn instance() -> Instance {
    Instance::new(InstanceDescriptor {
        backends: BACKENDS,
        ..InstanceDescriptor::new_without_display_handle()
    })
}
