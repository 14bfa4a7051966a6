//! Compares the methods `Average` and `Lengyel` on every adapter, with both searches, with the core and with
//! the oracle in double precision.

mod common;

use common::bound::{KnownFrame, U, dot, known, length};
use common::{
    APART, APART_STRIDE, ENGINE, ENGINE_FRAME, Found, GpuFrame, Packed, Place, UNTOUCHED, frames, gpus, pack,
    run, run_method, triangulated,
};
use darboux::{Method, TangentOptions, generate_frames};
use darboux_gpu::{FrameLayout, Search, VertexLayout};
use darboux_tests::{Case, OwnedMesh, corpus, families, oracle};

/// Counts of compared vertices.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    same_bits_as_core: usize,
    unsure: usize,
    /// The largest error as a fraction of its bound.
    of_bound: f64,
}

/// Compares both methods. `tallies`: of `Average` and of `Lengyel`.
fn check(name: &str, mesh: &OwnedMesh, [average, lengyel]: &mut [Tally; 2]) {
    check_method(Method::Average, name, mesh, average);
    check_method(Method::Lengyel, &format!("{name}, Lengyel"), mesh, lengyel);
}

/// Runs a mesh with both searches, into a separate buffer and in place, and compares the frames with the
/// core.
fn check_method(method: Method, name: &str, mesh: &OwnedMesh, tally: &mut Tally) {
    let mesh = triangulated(mesh);
    if mesh.corner_count() == 0 {
        return;
    }
    for gpu in gpus() {
        let packed = pack(&mesh, ENGINE);
        let run = |search, place| run_method(gpu, (method, search), &packed, place);
        let found = run(Search::Adjacency, Place::Apart);
        assert_eq!(found, run(Search::BruteForce, Place::Apart), "{name}: brute force");
        for search in [Search::Adjacency, Search::BruteForce] {
            check_in_place(name, &packed, &found, &run(search, Place::InPlace(ENGINE_FRAME)));
        }
        compare(method, name, &mesh, &frames(&found), tally);
    }
}

/// Checks that the words of frames equal those of `apart`, and that all other words are unchanged.
fn check_in_place(name: &str, packed: &Packed, apart: &Found, found: &Found) {
    let mut expected = packed.vertices.clone();
    for v in 0..packed.vertex_count as usize {
        let (frame, vertex) = (&apart.words[7 * v..], &mut expected[14 * v..]);
        vertex[8..11].copy_from_slice(&frame[..3]);
        vertex[11..14].copy_from_slice(&frame[4..7]);
    }
    assert!(found.words == expected, "{name}: in place");
    assert_eq!(found.counts, apart.counts, "{name}: in place");
}

fn compare(method: Method, name: &str, mesh: &OwnedMesh, found: &[GpuFrame], tally: &mut Tally) {
    let view = mesh.view();
    let core = generate_frames(&view, &TangentOptions::from(method));
    let slow = if method == Method::Lengyel { oracle::lengyel } else { oracle::average };
    let slow = (mesh.corner_count() < 3_000).then(|| slow(&view));
    for (v, frame) in found.iter().enumerate() {
        check_shape(name, v, frame, mesh.normals[v]);
    }
    let known = known(mesh, method);
    let mut is_seen = vec![false; found.len()];
    for corner in 0..mesh.corner_count() {
        let v = mesh.vertex_of_corner(corner);
        let (tangent, sign, bitangent) = found[v];
        let KnownFrame::Frame { sign: right, tangent: tangent_bound, bitangent: bitangent_bound } = known[v]
        else {
            tally.unsure +=
                usize::from(known[v] == KnownFrame::Unsure && !std::mem::replace(&mut is_seen[v], true));
            continue;
        };
        assert_eq!(sign, right, "{name}, vertex {v}: sign");
        let expected = core.corners.per_corner()[corner];
        // Faces without an orientation may take an orientation that no triangle of the vertex has.
        if expected.sign != sign || expected.tangent == [0.0; 3] || std::mem::replace(&mut is_seen[v], true) {
            continue;
        }
        let mut near = |what: &str, found: [f32; 3], expected: [f32; 3], bound: f64| {
            let error = length([0, 1, 2].map(|i| f64::from(found[i]) - f64::from(expected[i])));
            assert!(error <= bound, "{name}, vertex {v}, {what}: {found:?}, not {expected:?} to {bound:e}");
            tally.of_bound = tally.of_bound.max(error / bound);
        };
        // Both have errors.
        near("tangent", tangent, expected.tangent, 2.0 * tangent_bound);
        near("bitangent", bitangent, expected.bitangent, 2.0 * bitangent_bound);
        // Without a normal the oracle uses those of the triangles.
        let slow = slow.as_ref().filter(|_| mesh.normals[v] != [0.0; 3]);
        if let Some(expected) = slow.and_then(|slow| slow[corner]) {
            near("tangent in f64", tangent, expected.tangent, tangent_bound + 2.0 * U);
            near("bitangent in f64", bitangent, expected.bitangent, bitangent_bound + 2.0 * U);
        }
        tally.compared += 1;
        let same = [(tangent, expected.tangent), (bitangent, expected.bitangent)]
            .iter()
            .all(|(found, expected)| found.map(f32::to_bits) == expected.map(f32::to_bits));
        tally.same_bits_as_core += usize::from(same);
    }
}

/// Checks that a frame is usable: unit vectors, perpendicular to the normal if there is one.
fn check_shape(name: &str, v: usize, (tangent, sign, bitangent): &GpuFrame, normal: [f32; 3]) {
    assert!(sign.abs() == 1.0, "{name}, vertex {v}: sign {sign}");
    let normal = normal.map(f64::from);
    let size = length(normal);
    for vector in [tangent, bitangent] {
        let vector = vector.map(f64::from);
        assert!((length(vector) - 1.0).abs() < 1e-5, "{name}, vertex {v}: {vector:?}");
        if (1e-37..1e37).contains(&size) {
            let along = dot(vector, normal) / size;
            assert!(along.abs() < 1e-4, "{name}, vertex {v}: {vector:?} has {along} along the normal");
        }
    }
}

#[test]
fn families_agree_with_the_core() {
    let mut tallies = <[Tally; 2]>::default();
    check("grid", &families::grid(37, 23, false, false), &mut tallies);
    check("mirrored grid", &families::grid(30, 30, false, true), &mut tallies);
    check("sphere", &families::sphere(20, 31, false), &mut tallies);
    check("fan", &families::fan(1_000, false), &mut tallies);
    check("moebius", &families::moebius(64, false), &mut tallies);
    check("strip", &families::strip(50), &mut tallies);
    println!("{tallies:?}");
    assert!(gpus().is_empty() || tallies.iter().all(|tally| tally.compared > 3_000));
}

#[test]
fn corpus_agrees_with_the_core() {
    let mut tallies = <[Tally; 2]>::default();
    for corpus_case in corpus::corpus() {
        check(&corpus_case.name, &corpus_case.mesh, &mut tallies);
    }
    println!("{tallies:?}");
    assert!(gpus().is_empty() || tallies.iter().all(|tally| tally.compared > 100));
}

#[test]
fn random_meshes_agree_with_the_core() {
    let mut tallies = <[Tally; 2]>::default();
    for seed in 0..600 {
        check(&format!("seed {seed}"), &Case::from_seed(seed).mesh, &mut tallies);
    }
    println!("{tallies:?}");
    assert!(gpus().is_empty() || tallies.iter().all(|tally| tally.compared > 3_000));
}

#[test]
fn any_layout_of_whole_words_gives_the_same_bits() {
    let mesh = triangulated(&families::sphere(9, 13, false));
    let layouts = [
        VertexLayout { stride: 32, position: 0, normal: 12, uv: 24 },
        VertexLayout { stride: 32, position: 20, normal: 8, uv: 0 },
        VertexLayout { stride: 36, position: 4, normal: 24, uv: 16 },
        VertexLayout { stride: 68, position: 100, normal: 44, uv: 12 },
    ];
    for gpu in gpus() {
        let expected = run(gpu, Search::Adjacency, &pack(&mesh, ENGINE), Place::Apart);
        for layout in layouts {
            for search in [Search::Adjacency, Search::BruteForce] {
                let found = run(gpu, search, &pack(&mesh, layout), Place::Apart);
                assert_eq!(found, expected, "{layout:?}, {search:?}");
            }
        }
    }
}

#[test]
fn absent_parts_of_frames_are_not_written() {
    let mesh = triangulated(&families::grid(5, 5, false, true));
    let packed = pack(&mesh, ENGINE);
    for gpu in gpus() {
        let all = run(gpu, Search::Adjacency, &packed, Place::Apart);
        let mut expected = packed.vertices.clone();
        for v in 0..packed.vertex_count as usize {
            expected[14 * v + 9..14 * v + 13].copy_from_slice(&all.words[7 * v..7 * v + 4]);
        }
        let tangent_and_sign = FrameLayout { tangent: 36, bitangent: None, sign: Some(48) };
        let found = run(gpu, Search::Adjacency, &packed, Place::InPlace(tangent_and_sign));
        assert!(found.words == expected);
        // The words after the last vertex are unchanged.
        assert_eq!(all.words.len(), 7 * mesh.positions.len() + 1);
        assert_eq!(all.words.last(), Some(&UNTOUCHED));
    }
    assert_eq!((APART.sign, APART_STRIDE), (Some(12), 28));
}

#[test]
fn every_run_gives_the_same_bits() {
    let mesh = triangulated(&families::fan(5_000, true));
    let packed = pack(&mesh, ENGINE);
    for gpu in gpus() {
        let first = run(gpu, Search::Adjacency, &packed, Place::Apart);
        for _ in 0..10 {
            assert!(first == run(gpu, Search::Adjacency, &packed, Place::Apart));
        }
    }
}

#[test]
fn triangles_with_indices_out_of_range_are_ignored() {
    let mesh = triangulated(&families::grid(6, 4, false, false));
    let packed = pack(&mesh, ENGINE);
    let mut broken = packed.clone();
    let outside = [packed.vertex_count, u32::MAX, 0x8000_0000];
    for (k, outside) in outside.into_iter().enumerate() {
        broken.indices.extend([0, 1, 2]);
        let at = packed.indices.len() + 4 * k;
        broken.indices[at] = outside;
    }
    for gpu in gpus() {
        let expected = run(gpu, Search::Adjacency, &packed, Place::Apart);
        for search in [Search::Adjacency, Search::BruteForce] {
            assert_eq!(run(gpu, search, &broken, Place::Apart), expected, "{search:?}");
        }
    }
}

#[test]
fn vertices_without_a_direction_and_of_both_orientations_are_counted() {
    // Two columns of quads, of which the second is mirrored: the three vertices between them have both
    // orientations. One vertex is unused.
    let mut mesh = triangulated(&families::grid(2, 2, false, true));
    mesh.push(([0.0; 3], [0.0, 0.0, -1.0], [0.0; 2]));
    for gpu in gpus() {
        let found = run(gpu, Search::Adjacency, &pack(&mesh, ENGINE), Place::Apart);
        assert_eq!(found.counts, [1, 3, 0]);
        assert_eq!(frames(&found)[9], ([1.0, 0.0, 0.0], 1.0, [0.0, -1.0, 0.0]));
    }
}

#[test]
fn long_index_lists_are_processed_in_ranges() {
    let grid = triangulated(&families::grid(9, 9, false, true));
    let faces = vec![grid.face_list(); 250].concat();
    assert!(faces.len() > 40_000);
    let mut tallies = <[Tally; 2]>::default();
    check("repeated grid", &grid.with_face_list(&faces), &mut tallies);
    assert!(gpus().is_empty() || tallies.iter().all(|tally| tally.compared == 100));
}

#[test]
fn vertices_with_too_many_triangles_are_counted() {
    let triangle = triangulated(&families::strip(1));
    let faces = vec![triangle.face_list(); 32_769].concat();
    let (within, past) = (triangle.clone().with_face_list(&faces[1..]), triangle.with_face_list(&faces));
    for gpu in gpus() {
        let counts = |mesh| run(gpu, Search::Adjacency, &pack(mesh, ENGINE), Place::Apart).counts;
        assert_eq!(counts(&within), [0, 0, 0]);
        assert_eq!(counts(&past), [3, 0, 3]);
    }
}
