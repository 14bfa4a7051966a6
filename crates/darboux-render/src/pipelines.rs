//! The render pipelines of surfaces, lines and the ground.

use darboux_gpu::Gpu;
use wgpu::{
    BlendState, ColorTargetState, CompareFunction, Face, PrimitiveTopology, RenderPipeline, TextureFormat,
    VertexAttribute, VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

use crate::options::View;
use crate::subject::Subject;
use crate::target::{DEPTH, SAMPLES};
use crate::uniforms::Instance;
use crate::vertex::{Segment, SurfaceVertex};

const SURFACES: &str = concat!(
    include_str!("../shader_library/frame.wgsl"),
    include_str!("../shader_library/normal_map.wgsl"),
    include_str!("../shader_library/transform.wgsl"),
    include_str!("../shader_library/derivatives.wgsl"),
    include_str!("surface.wgsl"),
    include_str!("studio.wgsl"),
);
const LINES: &str = include_str!("lines.wgsl");
const GROUND: &str = include_str!("ground.wgsl");

/// The differences between the pipelines.
struct PipelineOptions<'a> {
    shader: &'static str,
    /// The entry points of the vertex and fragment shaders.
    entries: [&'static str; 2],
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    topology: PrimitiveTopology,
    has_depth: bool,
    /// Whether colours are blended by alpha.
    has_blending: bool,
    /// The faces that are not drawn.
    cull_mode: Option<Face>,
    /// Whether alpha determines the coverage of samples.
    alpha_to_coverage: bool,
}

/// The pipeline for triangles.
pub fn surface_pipeline(gpu: &Gpu, subject: Subject, view: View, format: TextureFormat) -> RenderPipeline {
    let vertex_attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x2, 14 => Float32x4, 6 => Float32];
    let instance_attributes = vertex_attr_array![
        7 => Float32x4, 8 => Float32x4, 9 => Float32x4, 10 => Float32x4, 11 => Float32x3, 12 => Float32x3, 13 => Float32x3
    ];
    let options = PipelineOptions {
        shader: SURFACES,
        entries: ["transform_corner", "shade"],
        buffers: &[
            layout(size_of::<SurfaceVertex>(), VertexStepMode::Vertex, &vertex_attributes),
            layout(size_of::<Instance>(), VertexStepMode::Instance, &instance_attributes),
        ],
        topology: PrimitiveTopology::TriangleList,
        has_depth: subject == Subject::Surface,
        has_blending: subject == Subject::UvLayout,
        cull_mode: None,
        alpha_to_coverage: view.is_lit(),
    };
    pipeline(gpu, &options, format)
}

/// The pipeline for lines. A line is a strip of two triangles.
pub fn line_pipeline(gpu: &Gpu, format: TextureFormat) -> RenderPipeline {
    let attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3];
    let options = PipelineOptions {
        shader: LINES,
        entries: ["transform_line", "color_line"],
        buffers: &[layout(size_of::<Segment>(), VertexStepMode::Instance, &attributes)],
        topology: PrimitiveTopology::TriangleStrip,
        has_depth: true,
        has_blending: false,
        cull_mode: None,
        alpha_to_coverage: false,
    };
    pipeline(gpu, &options, format)
}

/// The pipeline for the ground, a strip of two triangles that is seen from above only.
pub fn ground_pipeline(gpu: &Gpu, format: TextureFormat) -> RenderPipeline {
    let options = PipelineOptions {
        shader: GROUND,
        entries: ["transform_ground", "shade_ground"],
        buffers: &[],
        topology: PrimitiveTopology::TriangleStrip,
        has_depth: false,
        has_blending: false,
        cull_mode: Some(Face::Front),
        alpha_to_coverage: false,
    };
    pipeline(gpu, &options, format)
}

fn layout(
    stride: usize,
    step_mode: VertexStepMode,
    attributes: &[VertexAttribute],
) -> Option<VertexBufferLayout<'_>> {
    Some(VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
}

fn pipeline(gpu: &Gpu, options: &PipelineOptions<'_>, format: TextureFormat) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(options.shader.into());
    let label = Some(options.entries[0]);
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
    let blend = options.has_blending.then_some(BlendState::ALPHA_BLENDING);
    let compare = if options.has_depth { CompareFunction::Less } else { CompareFunction::Always };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(options.entries[0]),
            compilation_options: Default::default(),
            buffers: options.buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: options.topology,
            cull_mode: options.cull_mode,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(options.has_depth),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: SAMPLES,
            alpha_to_coverage_enabled: options.alpha_to_coverage,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(options.entries[1]),
            compilation_options: Default::default(),
            targets: &[Some(ColorTargetState { blend, ..format.into() })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
