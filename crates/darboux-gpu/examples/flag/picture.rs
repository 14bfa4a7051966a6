//! The pipelines and textures of the example, and reading the picture back.

use darboux_gpu::Gpu;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePipeline, RenderPipeline, Texture, TextureFormat};

/// The size of the picture in pixels.
pub const WIDTH: u32 = 768;
pub const HEIGHT: u32 = 336;
/// The number of pictures per row and per column.
const PARTS: [u32; 2] = [3, 2];
const SAMPLES: u32 = 4;
const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
const PAPER: wgpu::Color = wgpu::Color { r: 0.86, g: 0.89, b: 0.92, a: 1.0 };

/// Moves and draws the vertices of flags.
pub struct Painter<'a> {
    gpu: &'a Gpu,
    wave: ComputePipeline,
    draw: RenderPipeline,
    indices: Buffer,
    index_count: u32,
    samples: Texture,
    depth: Texture,
    picture: Texture,
}

impl<'a> Painter<'a> {
    pub fn new(gpu: &'a Gpu, indices: &[u32]) -> Self {
        let wave = gpu.device.create_shader_module(wgpu::include_wgsl!("wave.wgsl"));
        let wave = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("wave"),
            layout: None,
            module: &wave,
            entry_point: Some("wave"),
            compilation_options: Default::default(),
            cache: None,
        });
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        Self {
            gpu,
            wave,
            draw: pipeline(gpu),
            indices: gpu.device.create_buffer_init(&BufferInitDescriptor {
                label: Some("indices"),
                contents: bytemuck::cast_slice(indices),
                usage: BufferUsages::INDEX,
            }),
            index_count: indices.len() as u32,
            samples: texture(gpu, COLOR, SAMPLES, usage),
            depth: texture(gpu, DEPTH, SAMPLES, usage),
            picture: texture(gpu, COLOR, 1, usage | wgpu::TextureUsages::COPY_SRC),
        }
    }

    /// Records the motion of the vertices to `time`.
    pub fn wave(&self, encoder: &mut CommandEncoder, time: f32, at_rest: &Buffer, vertices: &Buffer) {
        let device = &self.gpu.device;
        let time = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("time"),
            contents: bytemuck::bytes_of(&time),
            usage: BufferUsages::UNIFORM,
        });
        let entries: Vec<_> = [&time, at_rest, vertices]
            .into_iter()
            .zip(0..)
            .map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let layout = self.wave.get_bind_group_layout(0);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.wave);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((at_rest.size() as u32 / 12).div_ceil(64), 1, 1);
    }

    /// Records the drawing of a flag into one part of the picture. The first part clears the picture.
    pub fn draw(&self, encoder: &mut CommandEncoder, [column, row]: [u32; 2], vertices: &Buffer) {
        let is_first = [column, row] == [0, 0];
        let load = |clear: wgpu::LoadOp<wgpu::Color>| if is_first { clear } else { wgpu::LoadOp::Load };
        let [samples, depth, picture] = [&self.samples, &self.depth, &self.picture]
            .map(|texture| texture.create_view(&Default::default()));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("flag"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &samples,
                depth_slice: None,
                resolve_target: Some(&picture),
                ops: wgpu::Operations { load: load(wgpu::LoadOp::Clear(PAPER)), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        let [width, height] = [WIDTH / PARTS[0], HEIGHT / PARTS[1]];
        let [x, y, w, h] = [column * width, row * height, width, height].map(|pixels| pixels as f32);
        pass.set_viewport(x, y, w, h, 0.0, 1.0);
        pass.set_pipeline(&self.draw);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.index_count, 0, 0..1);
    }

    /// Submits the commands and reads the picture.
    pub fn finish(&self, mut encoder: CommandEncoder) -> Vec<u8> {
        let read = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pixels"),
            size: u64::from(4 * WIDTH * HEIGHT),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * WIDTH), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &read, layout },
            self.picture.size(),
        );
        self.gpu.queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that can be mapped"));
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a working device");
        let pixels = read.get_mapped_range(..).expect("a mapped buffer");
        pixels.to_vec()
    }
}

fn pipeline(gpu: &Gpu) -> RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::include_wgsl!("draw.wgsl"));
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Float32x4];
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("flag"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 48,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn texture(gpu: &Gpu, format: TextureFormat, sample_count: u32, usage: wgpu::TextureUsages) -> Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: WIDTH, height: HEIGHT, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
