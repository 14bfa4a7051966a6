//! Tests plans with buffers of any layout, and the errors for wrong buffers and meshes.

mod common;

use common::plans::record;
use common::{UNTOUCHED, buffer, gpus, triangulated};
use darboux::{Method, TangentOptions};
use darboux_gpu::{Attribute, Gpu, MovingMesh, Planner, Precision, TangentsPer};
use darboux_tests::{OwnedMesh, families};
use wgpu::{Buffer, BufferUsages};

const USAGE: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_SRC);

/// Interleaved positions and normals, `stride` words apart, at these word offsets.
fn interleaved(gpu: &Gpu, mesh: &OwnedMesh, stride: usize, [position, normal]: [usize; 2]) -> Buffer {
    let mut words = vec![UNTOUCHED; stride * (mesh.positions.len() + 2)];
    for v in 0..mesh.positions.len() {
        for axis in 0..3 {
            words[stride * v + position + axis] = mesh.positions[v][axis].to_bits();
            words[stride * v + normal + axis] = mesh.normals[v][axis].to_bits();
        }
    }
    buffer(gpu, &words, USAGE)
}

#[test]
fn any_layout_of_whole_words_gives_the_same_bits() {
    let mesh = triangulated(&families::sphere(9, 13, false));
    let count = mesh.positions.len();
    for gpu in gpus() {
        for precision in [Precision::Exact, Precision::Fast] {
            let plan = Planner::new(&gpu.device, precision).plan(&mesh.view(), &TangentOptions::default());
            let plan = plan.unwrap_or_else(|error| panic!("{error}"));
            let mut first = None;
            for (stride, places) in [(10, [0, 3, 6]), (13, [4, 10, 0]), (17, [21, 1, 7])] {
                let all = interleaved(gpu, &mesh, stride, [places[0], places[1]]);
                let part = |words: usize| Attribute {
                    buffer: &all,
                    stride: 4 * stride as u32,
                    offset: 4 * words as u32,
                };
                let moving = MovingMesh {
                    vertex_count: count as u32,
                    positions: part(places[0]),
                    normals: part(places[1]),
                    tangents: part(places[2]),
                    per: TangentsPer::Vertex,
                };
                let words = record(gpu, &plan, &moving).words;
                let tangents: Vec<Vec<u32>> =
                    (0..count).map(|v| words[stride * v + places[2]..][..4].to_vec()).collect();
                assert!(*first.get_or_insert(tangents.clone()) == tangents, "stride {stride}");
                // The words after the last vertex are unchanged.
                let last = stride * (count - 1) + places[2] + 4;
                assert!(words[last..].iter().filter(|&&word| word == UNTOUCHED).count() >= stride);
            }
        }
    }
}

#[test]
fn wrong_buffers_are_errors() {
    let mesh = triangulated(&families::grid(4, 3, false, true));
    let options = TangentOptions::default();
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        let error_of = |mesh: &OwnedMesh, options| match planner.plan(&mesh.view(), options) {
            Ok(_) => "none".to_owned(),
            Err(error) => error.to_string(),
        };
        let other = TangentOptions::from(Method::Average);
        assert!(error_of(&mesh, &other).starts_with("a plan on a GPU computes MikkTSpace"));
        let plan = planner.plan(&mesh.view(), &options).unwrap_or_else(|error| panic!("{error}"));
        let count = mesh.positions.len() as u32;
        let all = interleaved(gpu, &mesh, 10, [0, 3]);
        let closed = buffer(gpu, &[0; 1000], BufferUsages::VERTEX);
        let part = |offset| Attribute { buffer: &all, stride: 40, offset };
        let plain = MovingMesh {
            vertex_count: count,
            positions: part(0),
            normals: part(12),
            tangents: Attribute { buffer: &all, stride: 16, offset: 0 },
            per: TangentsPer::Corner,
        };
        let error_of = |moving| match plan.bind(&moving) {
            Ok(_) => "none".to_owned(),
            Err(error) => error.to_string(),
        };
        // The vertices at the mirrored edge have several tangents.
        let per_vertex = MovingMesh { per: TangentsPer::Vertex, tangents: part(24), ..plain };
        assert_eq!(
            error_of(per_vertex),
            "4 vertices have several tangents: split them first (split_vertices)"
        );
        let of_other = MovingMesh { vertex_count: count + 1, ..plain };
        assert_eq!(error_of(of_other), "the plan has 20 vertices, but these buffers have 21: plan this mesh");
        let short = "the tangents need a buffer of 1152 bytes, but this one has 880";
        assert_eq!(error_of(plain), short);
        let tangents = buffer(gpu, &[0; 288], USAGE);
        let tangents = Attribute { buffer: &tangents, stride: 16, offset: 0 };
        assert_eq!(error_of(MovingMesh { tangents, ..plain }), "none");
        let odd = Attribute { offset: 2, ..plain.normals };
        let odd = error_of(MovingMesh { tangents, normals: odd, ..plain });
        assert_eq!(odd, "the stride or offset of the normals is 2 bytes: use a multiple of 4");
        let closed = Attribute { buffer: &closed, ..plain.positions };
        let closed = error_of(MovingMesh { tangents, positions: closed, ..plain });
        assert_eq!(
            closed,
            "the buffer of positions was created without BufferUsages::STORAGE: add that usage"
        );
        let narrow = error_of(MovingMesh { tangents: Attribute { stride: 12, ..tangents }, ..plain });
        assert!(narrow.starts_with("the tangents at byte 0 of every 12 overlap"), "{narrow}");
    }
}

#[test]
fn tangents_over_positions_are_refused() {
    let mesh = triangulated(&families::grid(4, 3, false, false));
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        let plan =
            planner.plan(&mesh.view(), &TangentOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let all = interleaved(gpu, &mesh, 10, [0, 3]);
        let part = |offset| Attribute { buffer: &all, stride: 40, offset };
        for (offset, is_right) in [(24, true), (20, false), (64, true), (28, false)] {
            let moving = MovingMesh {
                vertex_count: mesh.positions.len() as u32,
                positions: part(0),
                normals: part(12),
                tangents: part(offset),
                per: TangentsPer::Vertex,
            };
            assert_eq!(plan.bind(&moving).is_ok(), is_right, "tangents at {offset}");
        }
    }
}
