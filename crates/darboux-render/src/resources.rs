//! Makes buffers and bind groups, and converts colours.

use bytemuck::Pod;
use darboux_gpu::Gpu;
use darboux_io::image::srgb_to_linear;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferUsages, RenderPipeline,
    TextureFormat,
};

pub fn uniform(gpu: &Gpu, value: &impl Pod) -> Buffer {
    buffer(gpu, bytemuck::bytes_of(value), BufferUsages::UNIFORM)
}

pub fn buffer(gpu: &Gpu, contents: &[u8], usage: BufferUsages) -> Buffer {
    gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
}

/// A group of a pipeline with resources in the order of their bindings.
pub fn group(
    gpu: &Gpu,
    pipeline: &RenderPipeline,
    index: u32,
    resources: &[BindingResource<'_>],
) -> BindGroup {
    let entries = (0..).zip(resources.iter().cloned());
    let entries: Vec<_> = entries.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(index),
        entries: &entries,
    })
}

/// An sRGB colour in a target's format.
pub fn color_in(color: [u8; 3], format: TextureFormat) -> [f64; 3] {
    color.map(|channel| {
        let channel = f64::from(channel) / 255.0;
        match format {
            TextureFormat::Rgba8Unorm => channel,
            _ => srgb_to_linear(channel),
        }
    })
}
