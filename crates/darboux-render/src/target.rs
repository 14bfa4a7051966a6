//! The textures that are drawn into, and reading the picture back.

use darboux_gpu::{Gpu, GpuError};
use wgpu::{BufferDescriptor, BufferUsages, CommandEncoder, Extent3d, Texture, TextureFormat, TextureUsages};

use crate::error::RenderError;

pub const SAMPLES: u32 = 4;
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The most pixels of a picture. With samples and depth they take 1.2 GB.
const MAX_PIXELS: u64 = 1 << 25;

/// Errors: the adapter cannot draw this size.
pub fn check_size(gpu: &Gpu, size: [u32; 2]) -> Result<(), RenderError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if size.iter().all(|&side| (1..=limit).contains(&side)) && pixels <= MAX_PIXELS {
        return Ok(());
    }
    Err(RenderError::UnsupportedSize { size, limit, most: MAX_PIXELS, adapter: gpu.name.clone() })
}

/// The multisampled colour and depth textures, and the resolved picture.
pub struct Target<'a> {
    gpu: &'a Gpu,
    size: [u32; 2],
    pub samples: Texture,
    pub depth: Texture,
    pub picture: Texture,
}

impl<'a> Target<'a> {
    pub fn new(gpu: &'a Gpu, size: [u32; 2], format: TextureFormat) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT;
        Self {
            gpu,
            size,
            samples: texture(gpu, size, format, SAMPLES, usage),
            depth: texture(gpu, size, DEPTH, SAMPLES, usage),
            picture: texture(gpu, size, format, 1, usage | TextureUsages::COPY_SRC),
        }
    }

    /// Submits the commands of `record` and returns the pixels of the picture.
    pub fn read(&self, record: impl FnOnce(&mut CommandEncoder)) -> Result<Vec<[u8; 3]>, GpuError> {
        let [width, height] = self.size;
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.gpu.device.create_buffer(&BufferDescriptor {
            label: Some("pixels"),
            size: u64::from(row) * u64::from(height),
            usage: BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let record_copy = |encoder: &mut CommandEncoder| {
            record(encoder);
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
            let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(self.picture.as_image_copy(), destination, self.picture.size());
        };
        let bytes = self.gpu.read(record_copy, &buffer)?;
        let rows = bytes.chunks_exact(row as usize).map(|row| row.as_chunks::<4>().0);
        Ok(rows.flat_map(|row| row.iter().take(width as usize).map(|&[r, g, b, _]| [r, g, b])).collect())
    }
}

fn texture(
    gpu: &Gpu,
    [width, height]: [u32; 2],
    format: TextureFormat,
    sample_count: u32,
    usage: TextureUsages,
) -> Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
