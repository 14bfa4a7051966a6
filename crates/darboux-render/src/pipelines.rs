//! How surfaces and lines are drawn.

use darboux_gpu::Gpu;
use wgpu::{
    BlendState, ColorTargetState, CompareFunction, PrimitiveTopology, RenderPipeline, TextureFormat,
    VertexAttribute, VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

use crate::View;
use crate::model::Corner;
use crate::painter::Shape;
use crate::strokes::Stroke;
use crate::target::{DEPTH, SAMPLES};
use crate::uniforms::Place;

const SURFACES: &str = concat!(
    include_str!("../../../shaders/wgsl/frame.wgsl"),
    include_str!("../../../shaders/wgsl/normal_map.wgsl"),
    include_str!("../../../shaders/wgsl/transform.wgsl"),
    include_str!("../../../shaders/wgsl/derivatives.wgsl"),
    include_str!("draw.wgsl"),
);
const LINES: &str = include_str!("strokes.wgsl");

/// In what pipelines differ.
struct Plan<'a> {
    shader: &'static str,
    /// The functions of vertices and of pixels.
    entries: [&'static str; 2],
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    topology: PrimitiveTopology,
    /// Whether what is nearer to the eye hides the rest; else what is under it shows through, by alpha.
    has_depth: bool,
    /// Whether alpha covers a part of the samples.
    is_covering: bool,
}

/// Draws triangles.
pub fn surface_pipeline(gpu: &Gpu, shape: Shape, view: View, format: TextureFormat) -> RenderPipeline {
    let of_corner =
        vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32];
    let of_place = vertex_attr_array![
        5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4, 9 => Float32x3, 10 => Float32x3, 11 => Float32x3
    ];
    let plan = Plan {
        shader: SURFACES,
        entries: ["place_corner", "shade"],
        buffers: &[
            layout(size_of::<Corner>(), VertexStepMode::Vertex, &of_corner),
            layout(size_of::<Place>(), VertexStepMode::Instance, &of_place),
        ],
        topology: PrimitiveTopology::TriangleList,
        has_depth: shape == Shape::Model,
        is_covering: view == View::Shaded,
    };
    pipeline(gpu, &plan, format)
}

/// Draws lines, each of four corners.
pub fn line_pipeline(gpu: &Gpu, format: TextureFormat) -> RenderPipeline {
    let of_stroke = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3];
    let plan = Plan {
        shader: LINES,
        entries: ["place_stroke", "color_stroke"],
        buffers: &[layout(size_of::<Stroke>(), VertexStepMode::Instance, &of_stroke)],
        topology: PrimitiveTopology::TriangleStrip,
        has_depth: true,
        is_covering: false,
    };
    pipeline(gpu, &plan, format)
}

fn layout(
    stride: usize,
    step_mode: VertexStepMode,
    attributes: &[VertexAttribute],
) -> Option<VertexBufferLayout<'_>> {
    Some(VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
}

fn pipeline(gpu: &Gpu, plan: &Plan<'_>, format: TextureFormat) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(plan.shader.into());
    let label = Some(plan.entries[0]);
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
    let blend = (!plan.has_depth).then_some(BlendState::ALPHA_BLENDING);
    let compare = if plan.has_depth { CompareFunction::Less } else { CompareFunction::Always };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(plan.entries[0]),
            compilation_options: Default::default(),
            buffers: plan.buffers,
        },
        primitive: wgpu::PrimitiveState { topology: plan.topology, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(plan.has_depth),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: SAMPLES,
            alpha_to_coverage_enabled: plan.is_covering,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(plan.entries[1]),
            compilation_options: Default::default(),
            targets: &[Some(ColorTargetState { blend, ..format.into() })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
