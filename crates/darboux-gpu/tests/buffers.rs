//! Tests index buffers of every format, and the errors for wrong buffers.

mod common;

use common::{APART, ENGINE, ENGINE_FRAME, Place, buffer, gpus, pack, run, run_with, triangulated};
use darboux::Method;
use darboux_gpu::{Average, Destination, FrameLayout, Gpu, MeshBuffers, Search, VertexLayout};
use darboux_tests::families;
use wgpu::{Buffer, BufferUsages, IndexFormat};

#[test]
fn indices_of_16_bits_anywhere_in_a_buffer_give_the_same_bits() {
    let packed = pack(&triangulated(&families::grid(7, 5, false, true)), ENGINE);
    for gpu in gpus() {
        let expected = run(gpu, Search::Adjacency, &packed, Place::Apart);
        for first in [0, 1, 2, 5] {
            let mut halves = vec![0xffff; first];
            halves.extend(packed.indices.iter().map(|&index| index as u16));
            halves.resize(halves.len().next_multiple_of(2), 0xffff);
            let words = halves.as_chunks().0.iter().map(|[a, b]| u32::from(*a) | u32::from(*b) << 16);
            let indices = buffer(gpu, &words.collect::<Vec<_>>(), BufferUsages::STORAGE);
            for search in [Search::Adjacency, Search::BruteForce] {
                let form = (&indices, IndexFormat::Uint16, first as u32, packed.indices.len() as u32);
                assert_eq!(
                    run_with(gpu, (Method::Average, search), &packed, form, Place::Apart),
                    expected,
                    "from {first}"
                );
            }
        }
    }
}

#[test]
fn a_part_of_a_longer_list_is_a_mesh() {
    let packed = pack(&triangulated(&families::grid(7, 5, false, true)), ENGINE);
    let mut part = packed.clone();
    part.indices = packed.indices[12..42].to_vec();
    for gpu in gpus() {
        let indices = buffer(gpu, &packed.indices, BufferUsages::STORAGE);
        let form = (&indices, IndexFormat::Uint32, 12, 30);
        let found = run_with(gpu, (Method::Average, Search::Adjacency), &packed, form, Place::Apart);
        assert_eq!(found, run(gpu, Search::Adjacency, &part, Place::Apart));
    }
}

#[test]
fn an_empty_mesh_changes_nothing() {
    let mut packed = pack(&triangulated(&families::strip(2)), ENGINE);
    packed.indices.clear();
    for gpu in gpus() {
        let found = run(gpu, Search::Adjacency, &packed, Place::InPlace(ENGINE_FRAME));
        assert!(found.words == packed.vertices);
        assert_eq!(found.counts, [0; 3]);
    }
}

/// Buffers of ten vertices and two triangles.
struct Given {
    vertices: Buffer,
    indices: Buffer,
    frames: Buffer,
}

fn given(gpu: &Gpu, usage: BufferUsages) -> Given {
    let words = |count: usize| buffer(gpu, &vec![0; count], usage);
    Given { vertices: words(140), indices: words(6), frames: words(70) }
}

fn mesh(given: &Given) -> MeshBuffers<'_> {
    MeshBuffers {
        vertices: &given.vertices,
        layout: ENGINE,
        vertex_count: 10,
        indices: &given.indices,
        index_format: IndexFormat::Uint32,
        first_index: 0,
        index_count: 6,
    }
}

fn error_of(gpu: &Gpu, mesh: MeshBuffers<'_>, destination: Destination<'_>) -> String {
    let average = Average::new(&gpu.device, Search::BruteForce);
    match average.of_mesh(&mesh, &destination) {
        Ok(_) => "none".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn wrong_layouts_are_errors() {
    for gpu in gpus() {
        let given = given(gpu, BufferUsages::STORAGE);
        let plain = mesh(&given);
        let in_vertices = |layout| Destination::Vertices(layout);
        let with = |layout| error_of(gpu, MeshBuffers { layout, ..plain }, in_vertices(ENGINE_FRAME));
        assert_eq!(with(ENGINE), "none");
        assert_eq!(
            with(VertexLayout { stride: 58, ..ENGINE }),
            "the stride or offset of the vertices is 58 bytes: use a multiple of 4"
        );
        assert_eq!(
            with(VertexLayout { uv: 13, ..ENGINE }),
            "the stride or offset of the UVs is 13 bytes: use a multiple of 4"
        );
        assert_eq!(
            with(VertexLayout { position: 52, ..ENGINE }),
            "the vertices need a buffer of 568 bytes, but this one has 560"
        );
        let to = |layout| error_of(gpu, plain, in_vertices(layout));
        let onto = |what: &str, offset: u32| {
            format!(
                "the {what} at byte {offset} of every 56 overlap another attribute or the next element: use another offset or a larger stride"
            )
        };
        assert_eq!(to(FrameLayout { tangent: 24, ..ENGINE_FRAME }), onto("tangents", 24));
        assert_eq!(to(FrameLayout { bitangent: Some(40), ..ENGINE_FRAME }), onto("bitangents", 40));
        assert_eq!(to(FrameLayout { sign: Some(36), ..ENGINE_FRAME }), onto("signs", 36));
        assert_eq!(
            to(FrameLayout { tangent: 48, bitangent: None, sign: None }),
            "the vertices need a buffer of 564 bytes, but this one has 560"
        );
        let apart = |stride, layout| {
            error_of(gpu, plain, Destination::Buffer { buffer: &given.frames, stride, layout })
        };
        assert_eq!(apart(28, APART), "none");
        assert!(apart(16, APART).starts_with("the bitangents at byte 16 of every 16 overlap"));
        assert!(apart(0, APART).starts_with("the tangents at byte 0 of every 0 overlap"));
        assert_eq!(apart(32, APART), "the frames need a buffer of 316 bytes, but this one has 280");
    }
}

#[test]
fn wrong_buffers_are_errors() {
    for gpu in gpus() {
        let given_here = given(gpu, BufferUsages::STORAGE);
        let plain = mesh(&given_here);
        let frames = Destination::Vertices(ENGINE_FRAME);
        let with = |mesh| error_of(gpu, mesh, frames);
        assert_eq!(
            with(MeshBuffers { index_count: 5, ..plain }),
            "5 indices are not a multiple of 3: pass three per triangle"
        );
        let late = MeshBuffers { first_index: 1, ..plain };
        assert_eq!(with(late), "the indices need a buffer of 28 bytes, but this one has 24");
        let last = MeshBuffers { first_index: u32::MAX, ..plain };
        assert!(with(last).starts_with("the indices need a buffer of"));
        let many = MeshBuffers { index_count: 3 << 29, ..plain };
        assert!(with(many).starts_with("1610612736 corners are more than the limit of 1073741823"));
        let most = MeshBuffers { vertex_count: u32::MAX, ..plain };
        assert!(with(most).starts_with("the vertices need a buffer of"));
        let shared = MeshBuffers { indices: plain.vertices, ..plain };
        assert!(with(shared).starts_with("the indices and the vertices are in one buffer"));
        let to = |buffer| error_of(gpu, plain, Destination::Buffer { buffer, stride: 28, layout: APART });
        assert!(to(plain.vertices).ends_with("use Destination::Vertices"));
        assert!(to(plain.indices).starts_with("the frames and the indices are in one buffer"));
        let closed = given(gpu, BufferUsages::VERTEX | BufferUsages::INDEX);
        let vertices = MeshBuffers { vertices: &closed.vertices, ..plain };
        assert_eq!(
            with(vertices),
            "the buffer of vertices was created without BufferUsages::STORAGE: add that usage"
        );
    }
}

#[test]
fn buffers_past_the_limits_are_errors() {
    for gpu in gpus() {
        let size = gpu.device.limits().max_buffer_size;
        let limit = gpu.device.limits().max_storage_buffer_binding_size.min(u64::from(u32::MAX));
        // The test needs a buffer that is too large to bind, but not too large to create.
        if limit >= size || limit > 1 << 28 {
            continue;
        }
        let large = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: limit + 4,
            usage: BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let given = given(gpu, BufferUsages::STORAGE);
        let mesh = MeshBuffers { vertices: &large, ..mesh(&given) };
        let found = error_of(gpu, mesh, Destination::Vertices(ENGINE_FRAME));
        assert!(found.contains("the device binds at most"), "{found}");
    }
}
