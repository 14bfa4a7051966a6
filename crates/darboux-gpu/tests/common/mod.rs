//! Packs meshes into buffers of any layout, runs `Average` and `Lengyel` on them and reads the results.
//! Shared by all test files.

#![allow(dead_code, reason = "every test file uses only a part")]

pub mod bound;
pub mod plan_bound;
pub mod plans;
pub mod scalar;

use std::io::Write;
use std::sync::OnceLock;

use darboux::Method;
use darboux_gpu::{
    Average, AverageOfMesh, Destination, FrameLayout, Gpu, MeshBuffers, MikkTSpace, Search, VertexLayout,
};
use darboux_tests::{FaceSizes, OwnedMesh};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages, IndexFormat};

/// The devices of all adapters. Without adapters, prints once that tests are skipped, or fails in continuous
/// integration.
pub fn gpus() -> &'static [Gpu] {
    static GPUS: OnceLock<Vec<Gpu>> = OnceLock::new();
    GPUS.get_or_init(|| {
        pollster::block_on(Gpu::open_all()).unwrap_or_else(|error| {
            assert!(std::env::var_os("CI").is_none(), "{error}");
            writeln!(std::io::stdout(), "skipped: no adapter (Debian: mesa-vulkan-drivers, libvulkan1)")
                .expect("standard output");
            Vec::new()
        })
    })
}

/// MikkTSpace on every adapter, compiled once.
pub fn kernels() -> &'static [MikkTSpace] {
    static KERNELS: OnceLock<Vec<MikkTSpace>> = OnceLock::new();
    KERNELS.get_or_init(|| gpus().iter().map(|gpu| MikkTSpace::new(gpu).expect("valid shaders")).collect())
}

/// The initial value of words that a test expects to be written or unchanged.
pub const UNTOUCHED: u32 = 0xdead_beef;

/// The words of a mesh, and their layout.
#[derive(Clone)]
pub struct Packed {
    pub vertices: Vec<u32>,
    pub layout: VertexLayout,
    pub vertex_count: u32,
    pub indices: Vec<u32>,
}

/// A typical vertex of 14 floats: position, UV, normal, tangent, bitangent.
pub const ENGINE: VertexLayout = VertexLayout { stride: 56, position: 0, uv: 12, normal: 20 };
/// The tangent and bitangent of [`ENGINE`].
pub const ENGINE_FRAME: FrameLayout = FrameLayout { tangent: 32, bitangent: Some(44), sign: None };
/// Frames in a separate buffer: tangent, sign, bitangent.
pub const APART: FrameLayout = FrameLayout { tangent: 0, bitangent: Some(16), sign: Some(12) };
pub const APART_STRIDE: u32 = 28;

/// Packs a mesh. Faces with more than three corners become triangle fans.
pub fn pack(mesh: &OwnedMesh, layout: VertexLayout) -> Packed {
    let count = mesh.positions.len();
    let stride = layout.stride as usize / 4;
    let starts = [layout.position, layout.normal, layout.uv].map(|offset| offset as usize / 4);
    let end = starts.into_iter().max().expect("three") + 3;
    let mut vertices = vec![UNTOUCHED; stride * count + end];
    for v in 0..count {
        let (position, normal, uv) = mesh.vertex(v);
        for (start, values) in starts.iter().zip([&position[..], &normal[..], &uv[..]]) {
            for (k, value) in values.iter().enumerate() {
                vertices[start + stride * v + k] = value.to_bits();
            }
        }
    }
    let indices = triangles(mesh).concat();
    Packed { vertices, layout, vertex_count: count as u32, indices }
}

pub fn triangles(mesh: &OwnedMesh) -> Vec<Vec<u32>> {
    let around_first = |face: Vec<u32>| {
        let ends: Vec<[u32; 2]> =
            face.iter().skip(1).zip(face.iter().skip(2)).map(|(a, b)| [*a, *b]).collect();
        ends.into_iter().map(move |[a, b]| vec![face[0], a, b])
    };
    mesh.face_list().into_iter().flat_map(around_first).collect()
}

/// The mesh as indexed triangles.
pub fn triangulated(mesh: &OwnedMesh) -> OwnedMesh {
    let faces = triangles(mesh);
    let mut mesh = mesh.clone().with_face_list(&faces);
    mesh.faces = FaceSizes::Triangles;
    mesh
}

/// Where frames are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    InPlace(FrameLayout),
    Apart,
}

/// The words of the destination after a run, and the counts.
#[derive(Debug, PartialEq)]
pub struct Found {
    pub words: Vec<u32>,
    pub counts: [u32; 3],
}

/// A buffer with these words.
pub fn buffer(gpu: &Gpu, words: &[u32], usage: BufferUsages) -> Buffer {
    let contents = bytes(words);
    gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage })
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Runs the method `Average` once with 32-bit indices.
pub fn run(gpu: &Gpu, search: Search, packed: &Packed, place: Place) -> Found {
    run_method(gpu, (Method::Average, search), packed, place)
}

/// Runs `Average` or `Lengyel` once with 32-bit indices.
pub fn run_method(gpu: &Gpu, method: (Method, Search), packed: &Packed, place: Place) -> Found {
    let usage = BufferUsages::STORAGE;
    let indices = buffer(gpu, if packed.indices.is_empty() { &[0] } else { &packed.indices }, usage);
    let count = packed.indices.len() as u32;
    run_with(gpu, method, packed, (&indices, IndexFormat::Uint32, 0, count), place)
}

/// Runs with any indices: their buffer, format, first index and count.
pub fn run_with(
    gpu: &Gpu,
    method: (Method, Search),
    packed: &Packed,
    (indices, index_format, first_index, index_count): (&Buffer, IndexFormat, u32, u32),
    place: Place,
) -> Found {
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    let vertices = buffer(gpu, &packed.vertices, usage);
    let frames = buffer(gpu, &vec![UNTOUCHED; (packed.vertex_count * APART_STRIDE / 4 + 1) as usize], usage);
    let mesh = MeshBuffers {
        vertices: &vertices,
        layout: packed.layout,
        vertex_count: packed.vertex_count,
        indices,
        index_format,
        first_index,
        index_count,
    };
    let (destination, written) = match place {
        Place::InPlace(layout) => (Destination::Vertices(layout), &vertices),
        Place::Apart => {
            (Destination::Buffer { buffer: &frames, stride: APART_STRIDE, layout: APART }, &frames)
        }
    };
    let average =
        compiled(gpu, method).of_mesh(&mesh, &destination).unwrap_or_else(|error| panic!("{error}"));
    read(gpu, &average, written)
}

/// A method, compiled once per adapter and search.
fn compiled(gpu: &Gpu, (method, search): (Method, Search)) -> Average {
    static COMPILED: OnceLock<Vec<[[Average; 2]; 2]>> = OnceLock::new();
    let all = |gpu: &Gpu| {
        [Average::new, Average::lengyel]
            .map(|of| [Search::BruteForce, Search::Adjacency].map(|search| of(&gpu.device, search)))
    };
    let compiled = COMPILED.get_or_init(|| gpus().iter().map(all).collect());
    let at = gpus().iter().position(|other| other.device == gpu.device).expect("an adapter of the list");
    compiled[at][usize::from(method == Method::Lengyel)][usize::from(search == Search::Adjacency)].clone()
}

fn read(gpu: &Gpu, average: &AverageOfMesh, written: &Buffer) -> Found {
    let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let words = buffer(gpu, &vec![0; (written.size() / 4) as usize], usage);
    let counts = buffer(gpu, &[0; 3], usage);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    average.record(&mut encoder);
    encoder.copy_buffer_to_buffer(written, 0, &words, 0, None);
    encoder.copy_buffer_to_buffer(average.counts(), 0, &counts, 0, None);
    gpu.queue.submit([encoder.finish()]);
    let counts = words_of(gpu, &counts);
    Found { words: words_of(gpu, &words), counts: [counts[0], counts[1], counts[2]] }
}

/// Waits for all submitted work and returns the words of a mappable buffer.
pub fn words_of(gpu: &Gpu, buffer: &Buffer) -> Vec<u32> {
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that can be mapped"));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a working device");
    let bytes = buffer.get_mapped_range(..).expect("a mapped buffer");
    bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

/// The frame of a vertex: tangent, sign, bitangent.
pub type GpuFrame = ([f32; 3], f32, [f32; 3]);

/// The frames of a run with [`Place::Apart`].
pub fn frames(found: &Found) -> Vec<GpuFrame> {
    let frame = |words: &[u32; 7]| {
        let [x, y, z, sign, a, b, c] = words.map(f32::from_bits);
        ([x, y, z], sign, [a, b, c])
    };
    found.words.as_chunks().0.iter().map(frame).collect()
}
