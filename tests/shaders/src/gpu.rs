//! Adapters: all that Vulkan has here, software ones included.

use std::sync::OnceLock;

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Backends, BufferUsages, Instance, InstanceDescriptor, ShaderModule, ShaderModuleDescriptor};

use crate::language::{Language, Stage, cannot_run};

/// A device of an adapter.
pub struct Gpu {
    /// The adapter, in words.
    pub name: String,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// Every adapter's device. Where there are none, says so once, and fails in continuous integration.
pub fn gpus() -> &'static [Gpu] {
    static GPUS: OnceLock<Vec<Gpu>> = OnceLock::new();
    GPUS.get_or_init(|| {
        let gpus = pollster::block_on(open_all());
        if gpus.is_empty() {
            cannot_run("no Vulkan adapter (Debian: mesa-vulkan-drivers, libvulkan1)");
        }
        gpus
    })
}

async fn open_all() -> Vec<Gpu> {
    let descriptor =
        InstanceDescriptor { backends: Backends::VULKAN, ..InstanceDescriptor::new_without_display_handle() };
    let instance = Instance::new(descriptor);
    let mut gpus = Vec::new();
    for adapter in instance.enumerate_adapters(Backends::VULKAN).await {
        let name = adapter.get_info().name;
        let (device, queue) = adapter
            .request_device(&Default::default())
            .await
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        gpus.push(Gpu { name, device, queue });
    }
    gpus
}

impl Gpu {
    /// The module of a whole shader; none where its compiler is not there.
    pub fn module(&self, language: Language, stage: Stage, text: &str) -> Option<ShaderModule> {
        let source = language.source(stage, text)?;
        Some(
            self.device.create_shader_module(ShaderModuleDescriptor { label: Some(language.name()), source }),
        )
    }

    /// A buffer with these words in it.
    pub fn buffer(&self, words: &[u32], usage: BufferUsages) -> wgpu::Buffer {
        let contents: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage })
    }

    /// The words of a buffer that can be mapped, once all submitted work is done.
    pub fn words(&self, buffer: &wgpu::Buffer) -> Vec<u32> {
        buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that can be mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that goes on");
        let bytes = buffer.get_mapped_range(..).expect("a mapped buffer");
        bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
    }
}
