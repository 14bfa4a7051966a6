//! Draws a model.

use bytemuck::{Pod, Zeroable};
use darboux_gpu::Gpu;
use darboux_io::gltf::{Alpha, Look};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferUsages, CommandEncoder,
    LoadOp, RenderPass, RenderPipeline, StoreOp, TextureFormat,
};

use crate::camera::Sight;
use crate::model::{Corner, Model, Part, on_layout};
use crate::target::{DEPTH, SAMPLES, Target};
use crate::textures::{Kind, Textures, sampler};
use crate::{HeatScale, RenderError, RenderOptions, View};

/// Corners per buffer: 47 MB.
const PIECE: usize = 3 << 18;

/// Small files can ask for any number: their nodes place one mesh again and again.
const MOST_TRIANGLES: u64 = 1 << 28;

const SHADER: &str = concat!(
    include_str!("../../../shaders/wgsl/frame.wgsl"),
    include_str!("../../../shaders/wgsl/normal_map.wgsl"),
    include_str!("../../../shaders/wgsl/transform.wgsl"),
    include_str!("draw.wgsl"),
);

const IDENTITY: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// The uniforms of draw.wgsl's `Picture`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PictureUniforms {
    projection: [[f32; 4]; 4],
    turn: [[f32; 4]; 3],
    distance: f32,
    view: u32,
    heat_ends: [f32; 2],
    ramp: [[f32; 4]; 9],
    flip: [f32; 4],
    none: [f32; 4],
}

/// The uniforms of draw.wgsl's `Material`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct MaterialUniforms {
    base_color: [f32; 4],
    normal_scale: f32,
    alpha_cutoff: f32,
    has_normal_map: u32,
    unused: u32,
}

/// draw.wgsl's `Place`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Place {
    eye: [[f32; 4]; 4],
    directions: [[f32; 3]; 3],
}

/// A piece of a primitive, on the adapter.
struct Piece {
    corners: Buffer,
    count: u32,
    places: Buffer,
    place_count: u32,
    material: Option<usize>,
}

/// Draws the picture; gives its pixels.
pub fn paint(
    gpu: &Gpu,
    model: &Model<'_>,
    sight: &Sight,
    options: &RenderOptions,
    warnings: &mut Vec<String>,
) -> Result<Vec<[u8; 3]>, RenderError> {
    let triangles = model.triangle_count();
    if triangles > MOST_TRIANGLES {
        return Err(RenderError::TooMany { triangles, limit: MOST_TRIANGLES });
    }
    let format = match options.view {
        View::Shaded => TextureFormat::Rgba8UnormSrgb,
        _ => TextureFormat::Rgba8Unorm,
    };
    let painter = Painter { gpu, pipeline: pipeline(gpu, options.view, format) };
    let target = Target::new(gpu, options.size, format);
    let picture = painter.group(0, &[painter.uniform(&picture_uniforms(sight, options)).as_entire_binding()]);
    let pieces: Vec<Piece> =
        model.parts.iter().flat_map(|part| painter.pieces(model, part, sight, options.view)).collect();
    let mut textures = Textures::new(gpu, model.document);
    let none = painter.material(&Look::default(), &mut textures);
    let used = |material| {
        options.view == View::Shaded && pieces.iter().any(|piece| piece.material == Some(material))
    };
    let looks = model.looks.iter().enumerate();
    let materials: Vec<Option<BindGroup>> =
        looks.map(|(material, look)| used(material).then(|| painter.material(look, &mut textures))).collect();
    warnings.append(&mut textures.warnings);
    let draw = |pass: &mut RenderPass<'_>| {
        pass.set_pipeline(&painter.pipeline);
        pass.set_bind_group(0, &picture, &[]);
        for piece in &pieces {
            let material = piece.material.and_then(|material| materials.get(material)?.as_ref());
            pass.set_bind_group(1, material.unwrap_or(&none), &[]);
            pass.set_vertex_buffer(0, piece.corners.slice(..));
            pass.set_vertex_buffer(1, piece.places.slice(..));
            pass.draw(0..piece.count, 0..piece.place_count);
        }
    };
    let clear = clear_color(options.background, format);
    Ok(target.read(|encoder| record(encoder, &target, clear, draw))?)
}

/// Records a pass into the target.
fn record(
    encoder: &mut CommandEncoder,
    target: &Target<'_>,
    clear: wgpu::Color,
    draw: impl FnOnce(&mut RenderPass<'_>),
) {
    let [samples, depth, picture] = [&target.samples, &target.depth, &target.picture]
        .map(|texture| texture.create_view(&Default::default()));
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &samples,
            depth_slice: None,
            resolve_target: Some(&picture),
            ops: wgpu::Operations { load: LoadOp::Clear(clear), store: StoreOp::Discard },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: Some(wgpu::Operations { load: LoadOp::Clear(1.0), store: StoreOp::Discard }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    draw(&mut pass);
}

/// A colour of sRGB as the target's format takes it.
fn clear_color(color: [u8; 3], format: TextureFormat) -> wgpu::Color {
    let [r, g, b] = color.map(|channel| {
        let channel = f64::from(channel) / 255.0;
        match format {
            TextureFormat::Rgba8Unorm => channel,
            // IEC 61966-2-1.
            _ if channel <= 0.04045 => channel / 12.92,
            _ => ((channel + 0.055) / 1.055).powf(2.4),
        }
    });
    wgpu::Color { r, g, b, a: 1.0 }
}

fn picture_uniforms(sight: &Sight, options: &RenderOptions) -> PictureUniforms {
    let HeatScale { ends, ramp, flip, none } = &options.heat;
    let color = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|channel| f32::from(channel) / 255.0);
    let turn = [0, 1, 2].map(|column| {
        let [x, y, z] = sight.turn.map(|row| row[column] as f32);
        [x, y, z, 0.0]
    });
    PictureUniforms {
        projection: sight.projection,
        turn,
        distance: sight.distance as f32,
        view: options.view as u32,
        heat_ends: *ends,
        ramp: ramp.map(color),
        flip: color(*flip),
        none: color(*none),
    }
}

/// What draws on an adapter.
struct Painter<'a> {
    gpu: &'a Gpu,
    pipeline: RenderPipeline,
}

impl Painter<'_> {
    fn uniform(&self, value: &impl Pod) -> Buffer {
        self.buffer(bytemuck::bytes_of(value), BufferUsages::UNIFORM)
    }

    fn buffer(&self, contents: &[u8], usage: BufferUsages) -> Buffer {
        self.gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
    }

    fn group(&self, index: u32, resources: &[BindingResource<'_>]) -> BindGroup {
        let entries = (0..).zip(resources.iter().cloned());
        let entries: Vec<_> =
            entries.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        self.gpu.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.get_bind_group_layout(index),
            entries: &entries,
        })
    }

    fn material(&self, look: &Look, textures: &mut Textures<'_>) -> BindGroup {
        let [base, normal] = [(&look.base_texture, Kind::Color), (&look.normal_texture, Kind::Normal)]
            .map(|(used, kind)| (textures.view(used.as_ref(), kind), sampler(self.gpu, used.as_ref())));
        let uniforms = MaterialUniforms {
            base_color: look.base_color,
            normal_scale: look.normal_scale,
            alpha_cutoff: match look.alpha {
                Alpha::Opaque => -1.0,
                Alpha::Mask(cutoff) => cutoff.clamp(0.0, 1.0),
                Alpha::Blend => 2.0,
            },
            has_normal_map: normal.0.is_some().into(),
            unused: 0,
        };
        let [base_view, normal_view] = [
            base.0.unwrap_or_else(|| textures.neutral(Kind::Color)),
            normal.0.unwrap_or_else(|| textures.neutral(Kind::Normal)),
        ];
        self.group(
            1,
            &[
                self.uniform(&uniforms).as_entire_binding(),
                BindingResource::TextureView(&base_view),
                BindingResource::Sampler(&base.1),
                BindingResource::TextureView(&normal_view),
                BindingResource::Sampler(&normal.1),
            ],
        )
    }

    fn pieces(&self, model: &Model<'_>, part: &Part, sight: &Sight, view: View) -> Vec<Piece> {
        let laid_out = if view == View::Uv { laid_out(part) } else { Vec::new() };
        let corners = if view == View::Uv { &laid_out } else { &part.corners };
        let places: Vec<Place> = model
            .places_of(part)
            .iter()
            // A layout shows a part once, with the directions of its first node.
            .take(if view == View::Uv { 1 } else { usize::MAX })
            .map(|matrix| place(matrix, sight, view))
            .collect();
        let places_buffer = self.buffer(bytemuck::cast_slice(&places), BufferUsages::VERTEX);
        let piece = |corners: &[Corner]| Piece {
            corners: self.buffer(bytemuck::cast_slice(corners), BufferUsages::VERTEX),
            count: corners.len() as u32,
            places: places_buffer.clone(),
            place_count: places.len() as u32,
            material: part.material,
        };
        corners.chunks(PIECE).map(piece).collect()
    }
}

/// The corners of the triangles that have UVs, where these are.
fn laid_out(part: &Part) -> Vec<Corner> {
    let triangles = part.corners.as_chunks::<3>().0.iter().zip(part.layout.as_chunks::<3>().0);
    let has_place = |uvs: &[[f32; 2]; 3]| uvs.as_flattened().iter().all(|x| x.is_finite());
    let placed = triangles
        .filter(|(_, uvs)| has_place(uvs))
        .flat_map(|(corners, uvs)| [0, 1, 2].map(|i| Corner { position: on_layout(uvs[i]), ..corners[i] }));
    placed.collect()
}

fn place(matrix: &[[f64; 4]; 4], sight: &Sight, view: View) -> Place {
    let largest = matrix[..3].as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    // Only their directions matter; so they fit 32 bits.
    let scale = if largest > 0.0 && largest.is_finite() { 1.0 / largest } else { 1.0 };
    Place {
        eye: sight.to_eye(if view == View::Uv { &IDENTITY } else { matrix }),
        directions: [0, 1, 2].map(|i| [0, 1, 2].map(|k| (matrix[i][k] * scale) as f32)),
    }
}

fn pipeline(gpu: &Gpu, view: View, format: TextureFormat) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module =
        gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("draw"), source });
    let of_corner = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32];
    let of_place = wgpu::vertex_attr_array![
        5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4, 9 => Float32x3, 10 => Float32x3, 11 => Float32x3
    ];
    let layout = |stride: usize, step_mode, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
    };
    let is_flat = view == View::Uv;
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("draw"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("place_corner"),
            compilation_options: Default::default(),
            buffers: &[
                layout(size_of::<Corner>(), wgpu::VertexStepMode::Vertex, &of_corner),
                layout(size_of::<Place>(), wgpu::VertexStepMode::Instance, &of_place),
            ],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(!is_flat),
            depth_compare: Some(if is_flat {
                wgpu::CompareFunction::Always
            } else {
                wgpu::CompareFunction::Less
            }),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: SAMPLES,
            alpha_to_coverage_enabled: view == View::Shaded,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("shade"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
