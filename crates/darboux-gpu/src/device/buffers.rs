//! Creates buffers, and checks their sizes against the limits of the device.

use std::borrow::Cow;

use darboux::{Indices, Mesh};
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Limits};

use crate::error::GpuError;

/// A storage buffer of `words` words, filled with zeros, that shaders write.
pub fn storage_buffer(device: &Device, label: &str, words: u32) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size: 4 * u64::from(words),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

/// A storage buffer with these contents, which shaders read.
pub fn upload(device: &Device, label: &str, contents: &[u8]) -> Buffer {
    buffer_with_contents(device, label, contents, BufferUsages::STORAGE | BufferUsages::COPY_SRC)
}

/// A buffer with these contents, whose length is a multiple of 4.
pub fn buffer_with_contents(device: &Device, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    let size = contents.len() as u64;
    let descriptor = BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: true };
    let buffer = device.create_buffer(&descriptor);
    // If mapping failed, the error scope around this call reports why.
    if let Ok(mut words) = buffer.get_mapped_range_mut(..) {
        words.slice(..).copy_from_slice(contents);
    }
    buffer.unmap();
    buffer
}

/// The byte length of the largest buffer that the device can create and bind, and that 32-bit offsets can
/// address.
pub fn largest_buffer(limits: &Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(u64::from(u32::MAX))
}

/// Errors: [`GpuError::BufferTooLarge`] if a buffer of this byte length is larger than [`largest_buffer`].
pub fn check_size(device: &Device, what: &'static str, bytes: u64) -> Result<(), GpuError> {
    let limit = largest_buffer(&device.limits());
    if bytes > limit { Err(GpuError::BufferTooLarge { what, bytes, limit }) } else { Ok(()) }
}

/// The vertex of every corner of a mesh.
pub fn corner_indices<'a>(mesh: &Mesh<'a>) -> Cow<'a, [u32]> {
    match mesh.indices() {
        Indices::Unindexed => (0..mesh.corner_count() as u32).collect(),
        Indices::U16(list) => list.iter().map(|&index| index.into()).collect(),
        Indices::U32(list) => list.into(),
    }
}
