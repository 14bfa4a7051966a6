//! Opens all Vulkan adapters of this machine, including software ones, and wraps the wgpu calls of the tests.

use std::sync::OnceLock;

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Backends, BufferUsages, Instance, InstanceDescriptor, ShaderModule, ShaderModuleDescriptor};

use crate::language::{Language, Stage, skip_tests};

/// The format of render targets.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// An adapter and its device.
pub struct Gpu {
    /// The name of the adapter.
    pub name: String,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// The devices of all adapters. Without adapters, prints once that tests are skipped, or fails in continuous
/// integration.
pub fn gpus() -> &'static [Gpu] {
    static GPUS: OnceLock<Vec<Gpu>> = OnceLock::new();
    GPUS.get_or_init(|| {
        let gpus = pollster::block_on(open_all());
        if gpus.is_empty() {
            skip_tests("no Vulkan adapter (Debian: mesa-vulkan-drivers, libvulkan1)");
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
    /// Compiles a shader; none if the compiler of the language is not installed.
    pub fn module(&self, language: Language, stage: Stage, text: &str) -> Option<ShaderModule> {
        let source = language.source(stage, text)?;
        Some(
            self.device.create_shader_module(ShaderModuleDescriptor { label: Some(language.name()), source }),
        )
    }

    /// A buffer with these words.
    pub fn buffer(&self, words: &[u32], usage: BufferUsages) -> wgpu::Buffer {
        let contents: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage })
    }

    /// Waits for all submitted work and returns the words of a mappable buffer.
    pub fn words(&self, buffer: &wgpu::Buffer) -> Vec<u32> {
        buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that can be mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("a working device");
        let bytes = buffer.get_mapped_range(..).expect("a mapped buffer");
        bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
    }

    /// A bind group of buffers, at the bindings 0, 1, ...
    pub fn bind_group(&self, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// A pipeline that draws triangles into a [`Gpu::target`]. Each module has one entry point.
    pub fn render_pipeline(
        &self,
        vertex: &ShaderModule,
        buffers: &[Option<wgpu::VertexBufferLayout>],
        fragment: &ShaderModule,
    ) -> wgpu::RenderPipeline {
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: vertex,
                entry_point: None,
                compilation_options: Default::default(),
                buffers,
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: fragment,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// A render target with four bytes per pixel.
    pub fn target(&self, [width, height]: [u32; 2]) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Begins a pass that clears the target and draws into it.
    pub fn begin_pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        target: &wgpu::Texture,
    ) -> wgpu::RenderPass<'a> {
        let attachment = wgpu::RenderPassColorAttachment {
            view: &target.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: Default::default(),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..Default::default()
        })
    }

    /// Submits the commands and reads the pixels of the target, row by row.
    pub fn pixels(&self, mut encoder: wgpu::CommandEncoder, target: &wgpu::Texture) -> Vec<[u8; 4]> {
        let (width, height) = (target.width(), target.height());
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let read = self
            .buffer(&vec![0; (row * height / 4) as usize], BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &read, layout };
        encoder.copy_texture_to_buffer(target.as_image_copy(), destination, target.size());
        self.queue.submit([encoder.finish()]);
        let words = self.words(&read);
        let rows = words.chunks((row / 4) as usize);
        rows.flat_map(|row| &row[..width as usize]).map(|word| word.to_le_bytes()).collect()
    }
}
