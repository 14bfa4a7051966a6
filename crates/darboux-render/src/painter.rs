//! Draws both sides of a [`Drawing`] in one render pass.

use std::iter;

use darboux_gpu::{AdapterKind, Gpu};
use darboux_io::gltf::Material;
use wgpu::{
    BindGroup, BindingResource, Buffer, BufferUsages, CommandEncoder, LoadOp, RenderPass, RenderPipeline,
    StoreOp, TextureFormat,
};

use crate::drawing::{Drawing, Side};
use crate::error::RenderError;
use crate::ground_painter::GroundPainter;
use crate::lines::{MAX_SEGMENTS, segments};
use crate::material_textures::{NORMAL, textures_of};
use crate::part::{Part, layout_position};
use crate::pipelines::{line_pipeline, surface_pipeline};
use crate::resources::{buffer, color_in, group, uniform};
use crate::subject::Subject;
use crate::target::Target;
use crate::textures::{Textures, sampler};
use crate::uniforms::{Instance, LineUniforms, MaterialUniforms, PictureUniforms};
use crate::vertex::SurfaceVertex;

/// The most corners per vertex buffer, which take 79 MB.
const MAX_CHUNK_CORNERS: usize = 3 << 18;

/// The most triangles. Small files can ask for any number, because many nodes may show one mesh.
const MAX_TRIANGLES: u64 = 1 << 28;

/// The same for a software adapter, which keeps every triangle of a picture in memory: about 60 bytes each.
const MAX_SOFTWARE_TRIANGLES: u64 = 1 << 23;

/// The vertex buffers of some triangles of a part.
struct Chunk {
    corners: Buffer,
    corner_count: u32,
    instances: Buffer,
    instance_count: u32,
    material: Option<usize>,
}

/// The resources of a side on the device.
struct SideResources {
    /// The first column of pixels, and their number.
    columns: [u32; 2],
    picture: BindGroup,
    chunks: Vec<Chunk>,
    /// By the index of the material; none for materials that are not used.
    materials: Vec<Option<BindGroup>>,
    /// For parts without a material.
    default_material: BindGroup,
    lines: Option<LineResources>,
}

/// The resources of lines on the device.
struct LineResources {
    uniforms: BindGroup,
    segments: Buffer,
    count: u32,
}

/// Draws the drawing and returns its pixels. Adds to `warnings` what is missing.
pub fn paint(
    gpu: &Gpu,
    drawing: &Drawing<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<[u8; 3]>, RenderError> {
    let sides = drawing.sides();
    let triangles = sides.iter().map(|(side, _)| side.model.triangle_count()).fold(0, u64::saturating_add);
    let limit = match gpu.kind() {
        AdapterKind::Software => MAX_SOFTWARE_TRIANGLES,
        _ => MAX_TRIANGLES,
    };
    if triangles > limit {
        return Err(RenderError::TooManyTriangles { triangles, limit });
    }
    let format = match drawing.view() {
        view if view.is_lit() => TextureFormat::Rgba8UnormSrgb,
        _ => TextureFormat::Rgba8Unorm,
    };
    let painter = Painter {
        gpu,
        drawing,
        format,
        surfaces: surface_pipeline(gpu, drawing.subject, drawing.view(), format),
        lines: line_pipeline(gpu, format),
    };
    let target = Target::new(gpu, drawing.size, format);
    let sides: Vec<SideResources> =
        sides.iter().map(|(side, columns)| painter.side(side, *columns, warnings)).collect();
    let ground = GroundPainter::of(gpu, drawing, format, warnings);
    let draw = |pass: &mut RenderPass<'_>| {
        ground.iter().for_each(|ground| ground.draw(pass));
        sides.iter().for_each(|side| painter.draw(pass, side));
    };
    let [r, g, b] = color_in(drawing.options.background, format);
    let clear = wgpu::Color { r, g, b, a: 1.0 };
    Ok(target.read(|encoder| record(encoder, &target, clear, draw))?)
}

/// Records a render pass into the target.
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

/// The pipelines, and the drawing that they are for.
struct Painter<'a> {
    gpu: &'a Gpu,
    drawing: &'a Drawing<'a>,
    format: TextureFormat,
    surfaces: RenderPipeline,
    lines: RenderPipeline,
}

impl Painter<'_> {
    fn draw(&self, pass: &mut RenderPass<'_>, side: &SideResources) {
        pass.set_scissor_rect(side.columns[0], 0, side.columns[1], self.drawing.size[1]);
        pass.set_pipeline(&self.surfaces);
        pass.set_bind_group(0, &side.picture, &[]);
        for chunk in &side.chunks {
            let material = chunk.material.and_then(|material| side.materials.get(material)?.as_ref());
            pass.set_bind_group(1, material.unwrap_or(&side.default_material), &[]);
            pass.set_vertex_buffer(0, chunk.corners.slice(..));
            pass.set_vertex_buffer(1, chunk.instances.slice(..));
            pass.draw(0..chunk.corner_count, 0..chunk.instance_count);
        }
        if let Some(lines) = &side.lines {
            pass.set_pipeline(&self.lines);
            pass.set_bind_group(0, &lines.uniforms, &[]);
            pass.set_vertex_buffer(0, lines.segments.slice(..));
            pass.draw(0..4, 0..lines.count);
        }
    }

    fn side(&self, side: &Side<'_>, columns: [u32; 2], warnings: &mut Vec<String>) -> SideResources {
        let Side { model, .. } = side;
        let mut textures: Vec<Textures<'_>> =
            model.documents.iter().map(|document| Textures::new(self.gpu, document)).collect();
        let is_used = |index| {
            let mut parts = model.parts.iter();
            self.drawing.view().is_lit() && parts.any(|part| part.material == Some(index))
        };
        let materials = model.materials.iter().enumerate().map(|(index, (document, material))| {
            is_used(index).then(|| self.material(material, &mut textures[*document]))
        });
        let materials = materials.collect();
        let default_material = self.material(&Material::default(), &mut textures[0]);
        let (lines, line_warning) = self.line_resources(side);
        let of_textures = textures.into_iter().flat_map(|textures| textures.warnings);
        let side_warnings =
            model.warnings(self.drawing.subject).into_iter().chain(of_textures).chain(line_warning);
        for warning in side_warnings {
            // Two sides of one file have the same warnings.
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let picture = uniform(self.gpu, &PictureUniforms::of(self.drawing, side));
        SideResources {
            columns,
            picture: group(self.gpu, &self.surfaces, 0, &[picture.as_entire_binding()]),
            chunks: model.parts.iter().flat_map(|part| self.chunks(part)).collect(),
            materials,
            default_material,
            lines,
        }
    }

    /// The lines over a side, and a warning if they are not all.
    fn line_resources(&self, side: &Side<'_>) -> (Option<LineResources>, Option<String>) {
        let Drawing { subject, size, transform, options, .. } = self.drawing;
        if *subject == Subject::UvLayout {
            return (None, None);
        }
        let color = |color| color_in(color, self.format).map(|channel| channel as f32);
        let (lines, are_all) =
            segments(&side.model.parts, side.mistakes, transform, options, MAX_SEGMENTS, color);
        let uniforms = uniform(self.gpu, &LineUniforms::of(transform, *size));
        let resources = (!lines.is_empty()).then(|| LineResources {
            uniforms: group(self.gpu, &self.lines, 0, &[uniforms.as_entire_binding()]),
            segments: buffer(self.gpu, bytemuck::cast_slice(&lines), BufferUsages::VERTEX),
            count: lines.len() as u32,
        });
        let warning = (!are_all).then(|| {
            format!(
                "has more than {MAX_SEGMENTS} lines, of which only the first are drawn; render a part of \
                 the scene"
            )
        });
        (resources, warning)
    }

    fn material(&self, material: &Material, textures: &mut Textures<'_>) -> BindGroup {
        let uses = textures_of(material);
        let views = uses.map(|(used, kind)| textures.view(used, kind));
        let has_normal_map = views[NORMAL].is_some();
        let samplers = uses.map(|(used, _)| sampler(self.gpu, used));
        let views: Vec<_> = (views.into_iter().zip(uses))
            .map(|(view, (_, kind))| view.unwrap_or_else(|| textures.neutral(kind)))
            .collect();
        let uniforms =
            uniform(self.gpu, &MaterialUniforms::of(material, has_normal_map, self.drawing.options.view));
        let images = views.iter().zip(&samplers).flat_map(|(view, sampler)| {
            [BindingResource::TextureView(view), BindingResource::Sampler(sampler)]
        });
        let resources: Vec<_> = iter::once(uniforms.as_entire_binding()).chain(images).collect();
        group(self.gpu, &self.surfaces, 1, &resources)
    }

    fn chunks(&self, part: &Part) -> Vec<Chunk> {
        let is_layout = self.drawing.subject == Subject::UvLayout;
        let layout_corners = if is_layout { layout_corners(part) } else { Vec::new() };
        let corners = if is_layout { &layout_corners } else { &part.corners };
        let instances: Vec<Instance> = part
            .matrices
            .iter()
            // A layout shows a part once, with the directions of its first place.
            .take(if is_layout { 1 } else { usize::MAX })
            .map(|matrix| Instance::of(matrix, &self.drawing.transform, self.drawing.subject))
            .collect();
        let instance_buffer = buffer(self.gpu, bytemuck::cast_slice(&instances), BufferUsages::VERTEX);
        let chunk = |corners: &[SurfaceVertex]| Chunk {
            corners: buffer(self.gpu, bytemuck::cast_slice(corners), BufferUsages::VERTEX),
            corner_count: corners.len() as u32,
            instances: instance_buffer.clone(),
            instance_count: instances.len() as u32,
            material: part.material,
        };
        corners.chunks(MAX_CHUNK_CORNERS).map(chunk).collect()
    }
}

/// The corners of the triangles with finite UVs, at their positions in the layout.
fn layout_corners(part: &Part) -> Vec<SurfaceVertex> {
    let triangles = part.corners.as_chunks::<3>().0.iter().zip(part.tangent_uvs.as_chunks::<3>().0);
    let is_finite = |uvs: &[[f32; 2]; 3]| uvs.as_flattened().iter().all(|x| x.is_finite());
    let corners = triangles.filter(|(_, uvs)| is_finite(uvs)).flat_map(|(corners, uvs)| {
        [0, 1, 2].map(|i| SurfaceVertex { position: layout_position(uvs[i]), ..corners[i] })
    });
    corners.collect()
}
