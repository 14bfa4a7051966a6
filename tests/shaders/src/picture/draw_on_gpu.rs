//! Draws the plate on a GPU, with the functions of the library in a vertex and a fragment shader.

use darboux::encode::normal_to_octahedral;
use wgpu::VertexFormat::{
    self, Float32x2, Float32x3, Float32x4, Sint16x2, Sint16x4, Snorm8x4, Snorm16x4, Uint32,
};
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};
use wgpu::{BufferUsages, VertexAttribute, VertexBufferLayout, VertexStepMode};

use crate::adapters::{FORMAT, Gpu};
use crate::language::{Language, Stage, library};
use crate::picture::encoding::{Encoding, Plate, SIDE};
use crate::picture::plate::{MAP_WIDTH, TRIANGLES, code, normal_map, vertices};

/// Bytes per vertex: position, UV, normal, octahedral normal, and the longest code.
const STRIDE: u64 = 8 + 8 + 12 + 4 + 16;

/// Draws the plate of an encoding.
pub fn draw(gpu: &Gpu, encoding: Encoding) -> Plate {
    let (format, code_type, decoded) = fetched(encoding);
    let text = include_str!("plate.wgsl").replace("CODE", code_type).replace("VERTEX_FRAME", decoded);
    let text = library(Language::Wgsl, Stage::Fragment) + &text;
    let module = gpu.module(Language::Wgsl, Stage::Fragment, &text).expect("a shader of WGSL");
    let attributes = [(Float32x2, 0), (Float32x2, 8), (Float32x3, 16), (Sint16x2, 28), (format, 32)];
    let attribute =
        |(location, (format, offset))| VertexAttribute { shader_location: location, format, offset };
    let attributes: Vec<_> = (0..).zip(attributes).map(attribute).collect();
    let layout = VertexBufferLayout {
        array_stride: STRIDE,
        step_mode: VertexStepMode::Vertex,
        attributes: &attributes,
    };
    let pipeline = gpu.render_pipeline(&module, &[Some(layout)], &module);

    let contents = vertex_bytes(encoding);
    let buffer = BufferInitDescriptor { label: None, contents: &contents, usage: BufferUsages::VERTEX };
    let buffer = gpu.device.create_buffer_init(&buffer);
    let map = map_on(gpu).create_view(&Default::default());
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&map) }],
    });
    let target = gpu.target([SIDE as u32; 2]);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = gpu.begin_pass(&mut encoder, &target);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, buffer.slice(..));
    pass.draw(0..3 * TRIANGLES.len() as u32, 0..1);
    drop(pass);
    gpu.pixels(encoder, &target)
}

/// How an encoding's code is fetched, as what WGSL has it, and the vertex' frame of it.
fn fetched(encoding: Encoding) -> (VertexFormat, &'static str, &'static str) {
    match encoding {
        Encoding::Floats => (Float32x4, "vec4f", "VertexFrame(normal, code)"),
        Encoding::Snorm16 => (Snorm16x4, "vec4f", "VertexFrame(normal, code)"),
        Encoding::Snorm10 => (Uint32, "u32", "VertexFrame(normal, tangent_from_snorm10(code))"),
        Encoding::Snorm8 => (Snorm8x4, "vec4f", "VertexFrame(normal, code)"),
        Encoding::Octahedral => (
            Sint16x2,
            "vec2i",
            "VertexFrame(normal_from_octahedral(short_normal), tangent_from_octahedral(code))",
        ),
        Encoding::Diamond => (
            Uint32,
            "u32",
            "VertexFrame(normal_from_octahedral(short_normal), \
             tangent_from_diamond(normal_from_octahedral(short_normal), code))",
        ),
        Encoding::Quaternion => (Sint16x4, "vec4i", "frame_from_quaternion(code)"),
    }
}

/// The triangles' corners, one after the other.
fn vertex_bytes(encoding: Encoding) -> Vec<u8> {
    let vertices = vertices();
    let bytes = |corner: usize| {
        let vertex = &vertices[corner];
        let floats = [&vertex.position[..], &vertex.uv, &vertex.normal].concat();
        let mut bytes: Vec<u8> = floats.iter().flat_map(|float| float.to_le_bytes()).collect();
        bytes.extend(normal_to_octahedral(vertex.normal).iter().flat_map(|short| short.to_le_bytes()));
        bytes.extend(code(encoding, vertex));
        bytes.resize(STRIDE as usize, 0);
        bytes
    };
    TRIANGLES.into_iter().flatten().flat_map(bytes).collect()
}

fn map_on(gpu: &Gpu) -> wgpu::Texture {
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: MAP_WIDTH as u32, height: SIDE as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texels = normal_map().concat();
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, TextureDataOrder::LayerMajor, &texels)
}
