//! Draws the sides of a picture.

use bytemuck::Pod;
use darboux_gpu::Gpu;
use darboux_io::gltf::Appearance;
use darboux_io::image::linear_of_srgb;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferUsages, CommandEncoder,
    LoadOp, RenderPass, RenderPipeline, StoreOp, TextureFormat,
};

use crate::camera::Sight;
use crate::model::{Corner, Part, on_layout};
use crate::pipelines::{line_pipeline, surface_pipeline};
use crate::strokes::{MOST_STROKES, strokes};
use crate::target::Target;
use crate::textures::{Kind, Textures, sampler};
use crate::uniforms::{MaterialUniforms, PictureUniforms, Place, StrokesUniforms};
use crate::{RenderError, RenderOptions, Side, View};

/// Corners per buffer: 47 MB.
const PIECE: usize = 3 << 18;

/// Small files can ask for any number: their nodes place one mesh again and again.
const MOST_TRIANGLES: u64 = 1 << 28;

/// What of a model is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Its surface in the scene.
    Model,
    /// Its UV layout.
    Layout,
}

/// What a picture shows.
pub struct Show<'a> {
    pub left: Side<'a>,
    /// What is seen right of a part of the width.
    pub right: Option<(Side<'a>, f64)>,
    pub shape: Shape,
    pub size: [u32; 2],
    pub sight: Sight,
    pub options: &'a RenderOptions,
}

impl<'a> Show<'a> {
    /// What the surface is painted with.
    pub fn view(&self) -> View {
        match (self.shape, self.options.view) {
            (Shape::Layout, View::Shaded) => View::Sign,
            (_, view) => view,
        }
    }

    /// The sides, and the columns of pixels in which each is seen: from, and how many.
    fn sides(&self) -> Vec<(Side<'a>, [u32; 2])> {
        let width = self.size[0];
        let Some((right, part)) = self.right else { return vec![(self.left, [0, width])] };
        let middle = (f64::from(width) * part.clamp(0.0, 1.0)).round() as u32;
        let sides = [(self.left, [0, middle]), (right, [middle, width - middle])];
        sides.into_iter().filter(|(_, [_, columns])| *columns > 0).collect()
    }
}

/// A piece of a primitive, on the adapter.
struct Piece {
    corners: Buffer,
    count: u32,
    places: Buffer,
    place_count: u32,
    material: Option<usize>,
}

/// A side, on the adapter.
struct SideOnGpu {
    columns: [u32; 2],
    picture: BindGroup,
    pieces: Vec<Piece>,
    materials: Vec<Option<BindGroup>>,
    /// The material of pieces without one.
    plain: BindGroup,
    strokes: Option<Strokes>,
}

/// Lines, on the adapter.
struct Strokes {
    uniforms: BindGroup,
    lines: Buffer,
    count: u32,
}

/// Draws the picture; gives its pixels.
pub fn paint(gpu: &Gpu, show: &Show<'_>, warnings: &mut Vec<String>) -> Result<Vec<[u8; 3]>, RenderError> {
    let sides = show.sides();
    let triangles = sides.iter().map(|(side, _)| side.model.triangle_count()).fold(0, u64::saturating_add);
    if triangles > MOST_TRIANGLES {
        return Err(RenderError::TooMany { triangles, limit: MOST_TRIANGLES });
    }
    let format = match show.view() {
        View::Shaded => TextureFormat::Rgba8UnormSrgb,
        _ => TextureFormat::Rgba8Unorm,
    };
    let painter = Painter {
        gpu,
        show,
        format,
        surfaces: surface_pipeline(gpu, show.shape, show.view(), format),
        lines: line_pipeline(gpu, format),
    };
    let target = Target::new(gpu, show.size, format);
    let sides: Vec<SideOnGpu> =
        sides.iter().map(|(side, columns)| painter.side(side, *columns, warnings)).collect();
    let draw = |pass: &mut RenderPass<'_>| sides.iter().for_each(|side| painter.draw(pass, side));
    let [r, g, b] = color_in(show.options.background, format);
    let clear = wgpu::Color { r, g, b, a: 1.0 };
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
fn color_in(color: [u8; 3], format: TextureFormat) -> [f64; 3] {
    color.map(|channel| {
        let channel = f64::from(channel) / 255.0;
        match format {
            TextureFormat::Rgba8Unorm => channel,
            _ => linear_of_srgb(channel),
        }
    })
}

/// What draws on an adapter.
struct Painter<'a> {
    gpu: &'a Gpu,
    show: &'a Show<'a>,
    format: TextureFormat,
    surfaces: RenderPipeline,
    lines: RenderPipeline,
}

impl Painter<'_> {
    fn draw(&self, pass: &mut RenderPass<'_>, side: &SideOnGpu) {
        pass.set_scissor_rect(side.columns[0], 0, side.columns[1], self.show.size[1]);
        pass.set_pipeline(&self.surfaces);
        pass.set_bind_group(0, &side.picture, &[]);
        for piece in &side.pieces {
            let material = piece.material.and_then(|material| side.materials.get(material)?.as_ref());
            pass.set_bind_group(1, material.unwrap_or(&side.plain), &[]);
            pass.set_vertex_buffer(0, piece.corners.slice(..));
            pass.set_vertex_buffer(1, piece.places.slice(..));
            pass.draw(0..piece.count, 0..piece.place_count);
        }
        if let Some(strokes) = &side.strokes {
            pass.set_pipeline(&self.lines);
            pass.set_bind_group(0, &strokes.uniforms, &[]);
            pass.set_vertex_buffer(0, strokes.lines.slice(..));
            pass.draw(0..4, 0..strokes.count);
        }
    }

    fn side(&self, side: &Side<'_>, columns: [u32; 2], warnings: &mut Vec<String>) -> SideOnGpu {
        let Side { model, .. } = side;
        let mut textures = Textures::new(self.gpu, model.document);
        let is_used = |material| {
            let mut parts = model.parts.iter();
            self.show.view() == View::Shaded && parts.any(|part| part.material == Some(material))
        };
        let appearances = model.appearances.iter().enumerate();
        let materials = appearances.map(|(material, appearance)| {
            is_used(material).then(|| self.material(appearance, &mut textures))
        });
        let materials = materials.collect();
        let plain = self.material(&Appearance::default(), &mut textures);
        let (strokes, is_cut) = self.strokes(side);
        let told = model.warnings(self.show.shape).into_iter().chain(textures.warnings).chain(is_cut);
        for warning in told {
            // Both sides of one file have the same to say.
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let picture = self.uniform(&PictureUniforms::of(self.show, side));
        SideOnGpu {
            columns,
            picture: self.group(&self.surfaces, 0, &[picture.as_entire_binding()]),
            pieces: model.parts.iter().flat_map(|part| self.pieces(part)).collect(),
            materials,
            plain,
            strokes,
        }
    }

    /// The lines over a side, none where there are none; and what to say where these are not all.
    fn strokes(&self, side: &Side<'_>) -> (Option<Strokes>, Option<String>) {
        let Show { shape, size, sight, options, .. } = self.show;
        if *shape == Shape::Layout {
            return (None, None);
        }
        let color = |color| color_in(color, self.format).map(|channel| channel as f32);
        let (lines, are_all) = strokes(&side.model.parts, side.mistakes, sight, options, MOST_STROKES, color);
        let uniforms = self.uniform(&StrokesUniforms::of(sight, *size));
        let on_gpu = (!lines.is_empty()).then(|| Strokes {
            uniforms: self.group(&self.lines, 0, &[uniforms.as_entire_binding()]),
            lines: self.buffer(bytemuck::cast_slice(&lines), BufferUsages::VERTEX),
            count: lines.len() as u32,
        });
        let is_cut = (!are_all).then(|| {
            format!("has more than {MOST_STROKES} lines and seams, of which only so many are drawn; render a part of the scene")
        });
        (on_gpu, is_cut)
    }

    fn uniform(&self, value: &impl Pod) -> Buffer {
        self.buffer(bytemuck::bytes_of(value), BufferUsages::UNIFORM)
    }

    fn buffer(&self, contents: &[u8], usage: BufferUsages) -> Buffer {
        self.gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
    }

    fn group(&self, pipeline: &RenderPipeline, index: u32, resources: &[BindingResource<'_>]) -> BindGroup {
        let entries = (0..).zip(resources.iter().cloned());
        let entries: Vec<_> =
            entries.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        self.gpu.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(index),
            entries: &entries,
        })
    }

    fn material(&self, appearance: &Appearance, textures: &mut Textures<'_>) -> BindGroup {
        let [base, normal] =
            [(&appearance.base_texture, Kind::Color), (&appearance.normal_texture, Kind::Normal)]
                .map(|(used, kind)| (textures.view(used.as_ref(), kind), sampler(self.gpu, used.as_ref())));
        let uniforms = MaterialUniforms::of(appearance, normal.0.is_some());
        let [base_view, normal_view] = [
            base.0.unwrap_or_else(|| textures.neutral(Kind::Color)),
            normal.0.unwrap_or_else(|| textures.neutral(Kind::Normal)),
        ];
        self.group(
            &self.surfaces,
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

    fn pieces(&self, part: &Part) -> Vec<Piece> {
        let is_layout = self.show.shape == Shape::Layout;
        let laid_out = if is_layout { laid_out(part) } else { Vec::new() };
        let corners = if is_layout { &laid_out } else { &part.corners };
        let places: Vec<Place> = part
            .places
            .iter()
            // A layout shows a part once, with the directions of its first node.
            .take(if is_layout { 1 } else { usize::MAX })
            .map(|matrix| Place::of(matrix, &self.show.sight, self.show.shape))
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
