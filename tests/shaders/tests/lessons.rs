//! Runs the shaders of `docs/learn` on every adapter.
//!
//! A page's blocks in one language are one shader. Functions are checked by a hidden block of the page that
//! defines `largest_error`, which calls them and returns the error. The pair of shaders of lesson 8 draws a
//! picture, and the kernel of lesson 10 runs on a mesh.

#[path = "../../../xtask/src/doc_blocks/blocks.rs"]
#[allow(dead_code, reason = "the parser of cargo xtask docs, of which this needs a part")]
mod blocks;

use std::path::PathBuf;

use darboux_shader_tests::{Gpu, Language, gpus};
use wgpu::naga::ShaderStage;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{BufferUsages, ShaderModule, ShaderModuleDescriptor, ShaderSource, VertexFormat};

/// Pages whose shaders have entry points of their own, and the tests below that run them.
const WITH_ENTRY_POINTS: [&str; 2] = ["8-shaders.md", "10-parallel.md"];

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/learn")
}

/// The blocks of a page in one language.
fn blocks_of(page: &str, language: &str) -> Vec<String> {
    let text = std::fs::read_to_string(folder().join(page)).expect("a page of the lessons");
    let page = blocks::parse(page, &text).expect("blocks with ends");
    page.blocks.into_iter().filter(|block| block.language == language).map(|block| block.text).collect()
}

fn module(gpu: &Gpu, source: ShaderSource) -> ShaderModule {
    gpu.device.create_shader_module(ShaderModuleDescriptor { label: None, source })
}

fn wgsl(gpu: &Gpu, text: &str) -> ShaderModule {
    module(gpu, ShaderSource::Wgsl(text.into()))
}

fn glsl(gpu: &Gpu, stage: ShaderStage, text: &str) -> ShaderModule {
    module(gpu, ShaderSource::Glsl { shader: text.into(), stage, defines: &[] })
}

/// Runs the only entry point of a compute shader with storage buffers, the last of which is written, and
/// returns that buffer.
fn computed(gpu: &Gpu, module: &ShaderModule, buffers: &[Vec<f32>], groups: u32) -> Vec<f32> {
    let words = |floats: &Vec<f32>| floats.iter().map(|float| float.to_bits()).collect::<Vec<u32>>();
    let last = buffers.last().expect("a buffer for the result");
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    let inputs: Vec<wgpu::Buffer> = buffers.iter().map(|floats| gpu.buffer(&words(floats), usage)).collect();
    let read = gpu.buffer(&words(last), BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let group = gpu.bind_group(&pipeline.get_bind_group_layout(0), &inputs.iter().collect::<Vec<_>>());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(groups, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&inputs[inputs.len() - 1], 0, &read, 0, None);
    gpu.queue.submit([encoder.finish()]);
    gpu.words(&read).into_iter().map(f32::from_bits).collect()
}

const WGSL_ENTRY: &str = "
@group(0) @binding(0) var<storage, read_write> lesson_error: array<f32>;
@compute @workgroup_size(1) fn lesson_main() { lesson_error[0] = largest_error(); }";

const GLSL_ENTRY: &str = "
layout(set = 0, binding = 0) buffer Lesson { float lesson_error[]; };
layout(local_size_x = 1) in;
void main() { lesson_error[0] = largest_error(); }";

#[test]
fn functions_give_what_the_lessons_say() {
    let mut checked = 0;
    for entry in std::fs::read_dir(folder()).expect("the lessons") {
        let page = entry.expect("a file").file_name().into_string().expect("a name in Unicode");
        if !page.ends_with(".md") || WITH_ENTRY_POINTS.contains(&page.as_str()) {
            continue;
        }
        for language in [Language::Wgsl, Language::Glsl] {
            let text = blocks_of(&page, language.name()).concat();
            if text.is_empty() {
                continue;
            }
            assert!(text.contains("largest_error"), "{page}: no hidden block checks the functions");
            for gpu in gpus() {
                let module = match language {
                    Language::Wgsl => wgsl(gpu, &(text.clone() + WGSL_ENTRY)),
                    _ => glsl(gpu, ShaderStage::Compute, &("#version 450\n".to_owned() + &text + GLSL_ENTRY)),
                };
                let error = computed(gpu, &module, &[vec![f32::NAN]], 1)[0];
                assert!(error < 1e-5, "{page}, {language:?} on {}: an error of {error}", gpu.name);
                checked += 1;
            }
        }
    }
    assert!(checked > 0 || gpus().is_empty());
}

/// What a vertex of the pair holds: position, normal, tangent with w, UV.
type Vertex = [f32; 12];

/// One texel, the matrix of the node by columns, the direction to the light, and the light that the pixel
/// must show.
struct Scene {
    texel: [u8; 4],
    sign: f32,
    columns: [[f32; 3]; 3],
    to_light: [f32; 3],
}

impl Scene {
    /// The lesson's lighting in double precision for a square in the plane z = 0 with the tangent x.
    fn light(&self) -> f64 {
        let [x, y, z] = self.columns.map(|column| column.map(f64::from));
        let side = if dot(x, cross(y, z)) < 0.0 { -1.0 } else { 1.0 };
        let n = unit(cross(x, y).map(|component| side * component));
        let along = dot(n, x);
        let t = unit(std::array::from_fn(|axis| x[axis] - along * n[axis]));
        let b = cross(n, t).map(|component| side * f64::from(self.sign) * component);
        let texel: [f64; 3] = std::array::from_fn(|axis| 2.0 * f64::from(self.texel[axis]) / 255.0 - 1.0);
        let leaning =
            unit(std::array::from_fn(|axis| texel[0] * t[axis] + texel[1] * b[axis] + texel[2] * n[axis]));
        dot(leaning, unit(self.to_light.map(f64::from))).max(0.0)
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    v.map(|component| component / dot(v, v).sqrt())
}

#[test]
fn the_pair_of_shaders_lights_as_the_lesson_says() {
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let skewed = [[0.8, 0.1, 0.2], [-0.3, 1.9, 0.1], [0.1, -0.2, 0.6]];
    let mirrored = [[-0.8, 0.1, 0.2], [-0.3, 1.9, 0.1], [0.1, -0.2, 0.6]];
    let [flat, to_t, to_b] = [[128, 128, 255, 255], [218, 128, 218, 255], [128, 200, 230, 255]];
    let light = [0.3, 0.5, 0.8];
    let scenes = [
        Scene { texel: flat, sign: 1.0, columns: one, to_light: light },
        Scene { texel: to_t, sign: 1.0, columns: one, to_light: light },
        Scene { texel: to_b, sign: 1.0, columns: one, to_light: light },
        Scene { texel: to_b, sign: -1.0, columns: one, to_light: light },
        Scene { texel: to_t, sign: 1.0, columns: skewed, to_light: light },
        Scene { texel: to_b, sign: 1.0, columns: skewed, to_light: light },
        Scene { texel: to_b, sign: 1.0, columns: mirrored, to_light: light },
        Scene { texel: to_b, sign: -1.0, columns: mirrored, to_light: light },
    ];
    let pair = blocks_of("8-shaders.md", "wgsl").concat();
    let glsl_pair = blocks_of("8-shaders.md", "glsl");
    assert_eq!(glsl_pair.len(), 2, "a vertex and a fragment shader");
    for gpu in gpus() {
        let both = wgsl(gpu, &pair);
        let vertex = glsl(gpu, ShaderStage::Vertex, &for_vulkan(&glsl_pair[0]));
        let fragment = glsl(gpu, ShaderStage::Fragment, &for_vulkan(&glsl_pair[1]));
        for (name, vertex, fragment) in [("WGSL", &both, &both), ("GLSL", &vertex, &fragment)] {
            for (number, scene) in scenes.iter().enumerate() {
                let (got, right) = (drawn(gpu, vertex, fragment, scene), 255.0 * scene.light());
                // One step of the target's rounding, and a tenth for the errors of the shader's operations.
                let is_near = (f64::from(got) - right).abs() <= 0.6;
                assert!(is_near, "scene {number}, {name} on {}: {got} instead of {right:.2}", gpu.name);
            }
        }
    }
}

/// A shader for OpenGL as one for Vulkan, which numbers its bindings and keeps textures and samplers apart.
fn for_vulkan(text: &str) -> String {
    text.replace("#version 410 core", "#version 450")
        .replace("layout(std140) uniform Scene", "layout(std140, set = 0, binding = 0) uniform Scene")
        .replace(
            "uniform sampler2D normal_map;",
            "layout(set = 0, binding = 1) uniform texture2D lesson_map; layout(set = 0, binding = 2) uniform sampler lesson_sampler;",
        )
        .replace("texture(normal_map,", "texture(sampler2D(lesson_map, lesson_sampler),")
}

/// The light at the middle of the square.
fn drawn(gpu: &Gpu, vertex: &ShaderModule, fragment: &ShaderModule, scene: &Scene) -> u8 {
    let formats = [
        (VertexFormat::Float32x3, 0),
        (VertexFormat::Float32x3, 12),
        (VertexFormat::Float32x4, 24),
        (VertexFormat::Float32x2, 40),
    ];
    let attribute =
        |(location, (format, offset))| wgpu::VertexAttribute { shader_location: location, format, offset };
    let attributes: Vec<_> = (0..).zip(formats).map(attribute).collect();
    let layout = wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    };
    let pipeline = gpu.render_pipeline(vertex, &[Some(layout)], fragment);
    let corner =
        |x: f32, y: f32| -> Vertex { [x, y, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, scene.sign, 0.5, 0.5] };
    let corners = [corner(-9.0, -9.0), corner(9.0, -9.0), corner(0.0, 9.0)];
    let words: Vec<u32> = corners.concat().iter().map(|float| float.to_bits()).collect();
    let vertices = gpu.buffer(&words, BufferUsages::VERTEX);
    let uniform = gpu.buffer(&uniform_words(scene), BufferUsages::UNIFORM);
    let map = one_texel(gpu, scene.texel).create_view(&Default::default());
    let sampler = gpu.device.create_sampler(&Default::default());
    let resources = [
        uniform.as_entire_binding(),
        wgpu::BindingResource::TextureView(&map),
        wgpu::BindingResource::Sampler(&sampler),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let target = gpu.target([8, 8]);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = gpu.begin_pass(&mut encoder, &target);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, vertices.slice(..));
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.pixels(encoder, &target)[4 * 8 + 4][0]
}

/// The node's matrix, a camera that keeps x and y and puts everything at one depth, and the light.
fn uniform_words(scene: &Scene) -> Vec<u32> {
    let [x, y, z] = scene.columns.map(|[x, y, z]| [x, y, z, 0.0]);
    let camera = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0; 4], [0.0, 0.0, 0.5, 1.0]];
    let [light_x, light_y, light_z] = scene.to_light;
    let model = [x, y, z, [0.0, 0.0, 0.0, 1.0]];
    let floats = [model.concat(), camera.concat(), vec![light_x, light_y, light_z, 0.0]].concat();
    floats.into_iter().map(f32::to_bits).collect()
}

fn one_texel(gpu: &Gpu, texel: [u8; 4]) -> wgpu::Texture {
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, TextureDataOrder::LayerMajor, &texel)
}

/// The mesh of the lesson's figure: four triangles, the last of which has no UV area.
#[test]
fn the_gathering_kernel_sums_each_vertex() {
    let words = |numbers: &[u32]| numbers.iter().map(|&number| f32::from_bits(number)).collect::<Vec<f32>>();
    let start = words(&[0, 3, 5, 8, 10, 12]);
    let lists = words(&[0, 1, 2, 0, 3, 0, 1, 3, 1, 2, 2, 3]);
    let directions = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0]];
    let normals = [[0.0, 0.0, 1.0, 0.0]; 5];
    let text = blocks_of("10-parallel.md", "wgsl").concat();
    for gpu in gpus() {
        let buffers =
            [start.clone(), lists.clone(), directions.concat(), normals.concat(), vec![f32::NAN; 20]];
        let got = computed(gpu, &wgsl(gpu, &text), &buffers, 1);
        let sums = [[2.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        for (vertex, [x, y]) in sums.into_iter().enumerate() {
            let size = f32::hypot(x, y);
            let right = [x / size, y / size, 0.0, 1.0];
            let tangent = &got[4 * vertex..4 * vertex + 4];
            let is_near = right.iter().zip(tangent).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(is_near, "vertex {vertex} on {}: {tangent:?} instead of {right:?}", gpu.name);
        }
    }
}
