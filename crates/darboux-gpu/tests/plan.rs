//! Plans on the device against the core's, bit for bit.

mod common;

use common::{buffer, gpus, triangulated, words_of};
use darboux::{Mode, TangentOptions};
use darboux_gpu::stages::Arithmetic;
use darboux_gpu::{Attribute, Gpu, GpuError, MovingMesh, Per, Planner, Precision};
use darboux_tests::{Case, OwnedMesh, families};
use wgpu::BufferUsages;

/// Moves vertices: some a little, some onto others, some to nowhere.
fn moved(mesh: &OwnedMesh, seed: usize) -> OwnedMesh {
    let mut moved = mesh.clone();
    let count = mesh.positions.len();
    for vertex in 0..count {
        let place = (seed + vertex) * 7919;
        match place % 23 {
            0 => moved.positions[vertex] = mesh.positions[place % count],
            1 if seed.is_multiple_of(3) => moved.positions[vertex][place % 3] = f32::NAN,
            2 if seed.is_multiple_of(4) => moved.normals[vertex] = [0.0; 3],
            3..10 if seed.is_multiple_of(2) => moved.positions[vertex][place % 3] += 0.125,
            10..15 => moved.normals[vertex][place % 3] *= -0.5,
            _ => {}
        }
    }
    moved
}

/// The words that a plan of `base` writes for `moved`, four per corner or vertex, and its counts.
fn run(planner: &Planner, gpu: &Gpu, meshes: [&OwnedMesh; 2], mode: Mode, per: Per) -> (Vec<u32>, [u32; 3]) {
    let [base, moved] = meshes;
    let options = TangentOptions { mode, ..Default::default() };
    let plan = planner.plan(&base.view(), &options).unwrap_or_else(|error| panic!("{error}"));
    let words = |values: &[[f32; 3]]| values.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    let [positions, normals] = [&moved.positions, &moved.normals].map(|list| buffer(gpu, &words(list), usage));
    let outputs = if per == Per::Corner { base.corner_count() } else { base.positions.len() };
    let tangents = buffer(gpu, &vec![common::UNTOUCHED; 4 * outputs], usage);
    let floats = |buffer, stride| Attribute { buffer, stride, offset: 0 };
    let moving = MovingMesh {
        vertex_count: moved.positions.len() as u32,
        positions: floats(&positions, 12),
        normals: floats(&normals, 12),
        tangents: floats(&tangents, 16),
        per,
    };
    let plan = plan.of_buffers(&moving).unwrap_or_else(|error| panic!("{error}"));
    let reading = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let [found, counts] = [4 * outputs, 3].map(|count| buffer(gpu, &vec![0; count], reading));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    plan.record(&mut encoder);
    encoder.copy_buffer_to_buffer(&tangents, 0, &found, 0, None);
    encoder.copy_buffer_to_buffer(plan.counts(), 0, &counts, 0, None);
    gpu.queue.submit([encoder.finish()]);
    let counts = words_of(gpu, &counts);
    (words_of(gpu, &found), [counts[0], counts[1], counts[2]])
}

fn bits(tangent: [f32; 4]) -> [u32; 4] {
    tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits())
}

/// The core's plan of `base` on `moved`, as words.
fn on_cpu(base: &OwnedMesh, moved: &OwnedMesh, mode: Mode) -> Vec<[u32; 4]> {
    let plan = darboux::Plan::new(&base.view(), &TangentOptions { mode, ..Default::default() });
    let tangents = plan.evaluate(&moved.view()).expect("the same mesh, moved");
    tangents.per_corner().iter().map(|tangent| bits(*tangent)).collect()
}

/// How corners fared.
#[derive(Debug, Default)]
struct Tally {
    identical: usize,
    replaced: usize,
    counts: [u32; 3],
}

fn check(planner: &Planner, gpu: &Gpu, name: &str, meshes: [&OwnedMesh; 2], mode: Mode, tally: &mut Tally) {
    let [base, moved] = meshes;
    let (found, counts) = run(planner, gpu, meshes, mode, Per::Corner);
    let expected = on_cpu(base, moved, mode);
    let raw = on_cpu(base, moved, Mode::Reference);
    for (corner, found) in found.as_chunks().0.iter().enumerate() {
        let found = bits(found.map(f32::from_bits));
        if expected[corner] == raw[corner] {
            assert_eq!(found, expected[corner], "{name}, corner {corner}, {mode:?}");
            tally.identical += 1;
        } else {
            check_replaced(name, corner, found.map(f32::from_bits), meshes);
            assert_eq!(found[3], expected[corner][3], "{name}, corner {corner}: sign");
            tally.replaced += 1;
        }
    }
    tally.counts = std::array::from_fn(|k| tally.counts[k] + counts[k]);
}

/// A unit vector in the plane of the normal, of its own vertex or of one that it was welded with.
fn check_replaced(name: &str, corner: usize, [x, y, z, _]: [f32; 4], [base, moved]: [&OwnedMesh; 2]) {
    let dot = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| f64::from(a[i]) * f64::from(b[i])).sum::<f64>();
    let (tangent, own) = ([x, y, z], base.vertex_of_corner(corner));
    assert!((dot(tangent, tangent) - 1.0).abs() < 1e-3, "{name}, corner {corner}: {tangent:?}");
    let welded = (0..base.positions.len()).filter(|&v| v == own || base.vertex(v) == base.vertex(own));
    let is_across = |normal: [f32; 3]| {
        let size = dot(normal, normal).sqrt();
        !(size.is_finite() && size > 1e-37) || (dot(tangent, normal) / size).abs() < 1e-3
    };
    let mut normals = welded.map(|vertex| moved.normals[vertex]);
    assert!(normals.any(is_across), "{name}, corner {corner}: {tangent:?}");
}

#[test]
fn moved_meshes_have_the_core_s_bits() {
    for gpu in gpus() {
        for (arithmetic, seeds) in [(Arithmetic::Exact, 0..1_500), (Arithmetic::Soft, 0..150)] {
            let planner = Planner::with_arithmetic(&gpu.device, arithmetic);
            let mut tally = Tally::default();
            for seed in seeds {
                let mesh = triangulated(&Case::from_seed(seed as u64).mesh);
                if mesh.corner_count() > 0 {
                    let mode = [Mode::Reference, Mode::Repaired][seed % 2];
                    let meshes = [&mesh, &moved(&mesh, seed)];
                    check(&planner, gpu, &format!("seed {seed}"), meshes, mode, &mut tally);
                }
            }
            println!("{arithmetic:?} on {}: {tally:?}", gpu.name);
        }
    }
}
