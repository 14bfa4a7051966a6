//! Compares plans on the GPU with plans of the core, bit by bit.

mod common;

use common::plans::{Found, run};
use common::{buffer, gpus, triangulated, words_of};
use darboux::{Method, MikkTSpaceOptions, Mode, TangentOptions, generate_tangents, split_vertices};
use darboux_gpu::internal::Arithmetic;
use darboux_gpu::{Attribute, Gpu, GpuError, MovingMesh, Planner, Precision, TangentsPer};
use darboux_tests::{Case, FaceSizes, OwnedMesh, families};
use wgpu::BufferUsages;

fn bits(tangent: [f32; 4]) -> [u32; 4] {
    tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits())
}

/// The tangents of the plan of `base` on the moved mesh `moved` by the core, as words.
fn on_cpu(base: &OwnedMesh, moved: &OwnedMesh, mode: Mode) -> Vec<[u32; 4]> {
    let plan =
        darboux::Plan::new(&base.view(), &TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode)));
    let tangents = plan.evaluate(&moved.view()).expect("the same mesh, moved");
    tangents.per_corner().iter().map(|tangent| bits(*tangent)).collect()
}

/// Counts of compared corners.
#[derive(Debug, Default)]
struct Tally {
    identical: usize,
    replaced: usize,
    counts: [u32; 3],
}

fn check(planner: &Planner, gpu: &Gpu, name: &str, meshes: [&OwnedMesh; 2], mode: Mode, tally: &mut Tally) {
    let [base, moved] = meshes;
    let Found { words, counts, .. } = run(planner, gpu, meshes, mode, TangentsPer::Corner);
    let expected = on_cpu(base, moved, mode);
    let raw = on_cpu(base, moved, Mode::Reference);
    for (corner, found) in words.as_chunks().0.iter().enumerate() {
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

/// Checks a replaced tangent: a unit vector perpendicular to the normal of its vertex, or of a vertex that it
/// was welded with.
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
        let arithmetics = [
            (Arithmetic::Exact, 0..900),
            (Arithmetic::HostileDevice, 0..900),
            (Arithmetic::SoftFloat, 0..100),
        ];
        for (arithmetic, seeds) in arithmetics {
            let planner = Planner::with_arithmetic(&gpu.device, arithmetic);
            let mut tally = Tally::default();
            for seed in seeds {
                let mesh = triangulated(&Case::from_seed(seed as u64).mesh);
                if mesh.corner_count() > 0 {
                    let mode = [Mode::Reference, Mode::Repaired][seed % 2];
                    let meshes = [&mesh, &mesh.moved(seed)];
                    check(&planner, gpu, &format!("seed {seed}"), meshes, mode, &mut tally);
                }
            }
            println!("{arithmetic:?} on {}: {tally:?}", gpu.name);
        }
    }
}

#[test]
fn moved_quads_have_the_core_s_bits() {
    for gpu in gpus() {
        for arithmetic in [Arithmetic::Exact, Arithmetic::HostileDevice] {
            let planner = Planner::with_arithmetic(&gpu.device, arithmetic);
            let mut tally = Tally::default();
            let (mut planned, mut refused) = (0, 0);
            for (seed, mesh) in quads().into_iter().enumerate() {
                let mode = [Mode::Reference, Mode::Repaired][seed % 2];
                let options = TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode));
                match planner.plan(&mesh.view(), &options) {
                    Err(GpuError::QuadHalvesDiffer { corners: 1.. }) => refused += 1,
                    plan => {
                        plan.unwrap_or_else(|error| panic!("mesh {seed}: {error}"));
                        let meshes = [&mesh, &mesh.moved(seed)];
                        check(&planner, gpu, &format!("mesh {seed}"), meshes, mode, &mut tally);
                        planned += 1;
                    }
                }
            }
            println!("{arithmetic:?} on {}: {tally:?}, {planned} planned, {refused} refused", gpu.name);
            assert!(planned > 100 && refused > 100);
        }
    }
}

/// Meshes of quads, and of faces with three, four and more corners.
fn quads() -> Vec<OwnedMesh> {
    let mut meshes = vec![families::grid(12, 9, true, false), families::grid(12, 9, true, true)];
    meshes.extend((0..900).map(|seed| Case::from_seed(seed).mesh));
    meshes.retain(|mesh| mesh.faces != FaceSizes::Triangles && mesh.corner_count() > 0);
    meshes
}

/// A grid that may have a mirrored edge, and the same grid bent into waves.
fn waving(mirrored: bool) -> [OwnedMesh; 2] {
    let base = triangulated(&families::grid(40, 30, false, mirrored));
    let split = split_vertices(&base.view(), &generate_tangents(&base.view(), &Default::default()).corners);
    let split = split.expect("the mesh that the tangents are of");
    let of = |list: &[[f32; 3]]| split.source_of_vertex.iter().map(|&v| list[v as usize]).collect();
    let base = OwnedMesh {
        positions: of(&base.positions),
        normals: of(&base.normals),
        uvs: split.source_of_vertex.iter().map(|&v| base.uvs[v as usize]).collect(),
        indices: Some(split.indices.clone()),
        ..base
    };
    let mut waving = base.clone();
    for position in &mut waving.positions {
        position[2] += 0.05 * (3.0 * position[0]).sin() * (2.0 * position[1]).cos();
    }
    [base, waving]
}

#[test]
fn a_waving_surface_has_the_bits_of_a_fresh_run() {
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        for mirrored in [false, true] {
            let [base, waving] = &waving(mirrored);
            let found = run(&planner, gpu, [base, waving], Mode::Repaired, TangentsPer::Vertex);
            assert_eq!((found.counts, found.changes), ([0; 3], [0; 5]));
            let fresh = generate_tangents(&waving.view(), &Default::default()).corners;
            for (corner, tangent) in fresh.per_corner().iter().enumerate() {
                let vertex = waving.vertex_of_corner(corner);
                assert_eq!(found.words[4 * vertex..][..4], tangent.map(f32::to_bits), "vertex {vertex}");
            }
        }
    }
}

#[test]
fn a_check_that_finds_nothing_means_a_fresh_run() {
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        let options = TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Corrected));
        let (mut unchanged, mut changed) = (0, 0);
        for seed in 0..800 {
            let base = triangulated(&Case::from_seed(seed).mesh);
            if base.corner_count() == 0 {
                continue;
            }
            let mut moved = base.clone();
            for (v, position) in moved.positions.iter_mut().enumerate() {
                position[v % 3] *= 1.0 + 0.02 * ((seed as usize + v) % 5) as f32;
            }
            let plan = darboux::Plan::new(&base.view(), &options);
            let differing = plan.count_regrouped(&moved.view()).expect("the same mesh, moved");
            let found = run(&planner, gpu, [&base, &moved], Mode::Corrected, TangentsPer::Corner);
            if found.changes == [0; 5] {
                assert_eq!(differing, 0, "seed {seed}");
                unchanged += 1;
            } else {
                changed += usize::from(differing > 0);
            }
        }
        println!("{unchanged} unchanged; {changed} changed and found to be on {}", gpu.name);
        assert!(unchanged > 20 && changed > 20);
    }
}

#[test]
fn changes_are_counted() {
    let [base, _] = waving(false);
    let moved = |change: &dyn Fn(&mut OwnedMesh)| {
        let mut mesh = base.clone();
        change(&mut mesh);
        mesh
    };
    // The mesh with one more vertex, welded with its first.
    let mut doubled = base.clone();
    let copy = doubled.push(base.vertex(0));
    let mut list = base.face_list();
    list[0] = list[0].iter().map(|&v| if v == 0 { copy } else { v }).collect();
    let doubled = doubled.with_face_list(&list);
    let mut parted = doubled.clone();
    parted.positions[copy as usize][2] += 1e-3;
    let collapsed = moved(&|mesh| mesh.positions[1] = mesh.positions[0]);
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        let changes = |base: &OwnedMesh, moved: &OwnedMesh| {
            run(&planner, gpu, [base, moved], Mode::Repaired, TangentsPer::Corner).changes
        };
        assert_eq!(changes(&base, &base), [0; 5]);
        assert_eq!(changes(&doubled, &parted)[2], 1);
        let [triangles, ..] = changes(&base, &collapsed);
        assert!(triangles > 0);
        assert_eq!(changes(&collapsed, &base)[1], triangles);
        let met = moved(&|mesh| {
            let last = mesh.positions.len() - 1;
            mesh.uvs[last] = mesh.uvs[0];
        });
        let mut at_first = met.clone();
        let last = met.positions.len() - 1;
        (at_first.positions[last], at_first.normals[last]) = (met.positions[0], met.normals[0]);
        assert_eq!(changes(&met, &at_first)[3], 1);
        let turned = moved(&|mesh| mesh.positions[0] = mesh.positions[base.positions.len() / 2]);
        assert!(changes(&base, &turned)[4] > 0);
    }
}

#[test]
fn normals_are_nearly_the_core_s() {
    let [base, waving] = waving(true);
    let sphere = triangulated(&families::sphere(20, 31, false));
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        for (base, moved) in [(&base, &waving), (&sphere, &sphere)] {
            // Normals that only say which vertices have one.
            let plan = planner.plan(&base.view(), &TangentOptions::default()).expect("a plan");
            let words =
                |list: &[[f32; 3]]| list.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let count = moved.positions.len();
            // All in one buffer: positions, then normals, then tangents.
            let all = [words(&moved.positions), vec![0; 7 * count]].concat();
            let all = buffer(gpu, &all, usage);
            let part = |stride, words: usize| Attribute { buffer: &all, stride, offset: 4 * words as u32 };
            let moving = MovingMesh {
                vertex_count: count as u32,
                positions: part(12, 0),
                normals: part(12, 3 * count),
                tangents: part(16, 6 * count),
                per: TangentsPer::Vertex,
            };
            let normals = plan.bind_normals(&moving).unwrap_or_else(|error| panic!("{error}"));
            let read = buffer(gpu, &vec![0; 10 * count], BufferUsages::MAP_READ | BufferUsages::COPY_DST);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            normals.record(&mut encoder);
            encoder.copy_buffer_to_buffer(&all, 0, &read, 0, None);
            gpu.queue.submit([encoder.finish()]);
            let found = words_of(gpu, &read);
            let indices = moved.indices.as_deref().expect("indices");
            let options = darboux::NormalOptions::default();
            let expected =
                darboux::generate_normals(&moved.positions, indices, darboux::Faces::Triangles, &options);
            for (corner, expected) in expected.expect("a mesh").corners.per_corner().iter().enumerate() {
                let at = 3 * (count + moved.vertex_of_corner(corner));
                let error = (0..3).map(|axis| (f32::from_bits(found[at + axis]) - expected[axis]).abs());
                assert!(error.fold(0.0, f32::max) < 2e-6, "corner {corner}: {expected:?}");
            }
        }
    }
}

#[test]
fn what_has_no_plan_is_said() {
    let quads = families::grid(3, 3, true, false);
    // Two quads lose an edge that both have.
    let mut halved = quads.clone();
    let face = halved.face_list()[0].clone();
    halved.positions[face[3] as usize] = halved.positions[face[2] as usize];
    let grid = families::grid(3, 3, false, true);
    for gpu in gpus() {
        let planner = Planner::new(&gpu.device, Precision::Exact);
        let plan = |mesh: &OwnedMesh, options| planner.plan(&mesh.view(), &options);
        let options = TangentOptions::default();
        assert_eq!(plan(&halved, options).err(), Some(GpuError::QuadHalvesDiffer { corners: 2 }));
        let average = TangentOptions::from(Method::Average);
        assert_eq!(plan(&grid, average).err(), Some(GpuError::UnsupportedMethod));
        let floats = buffer(gpu, &vec![0; 4 * grid.positions.len()], BufferUsages::STORAGE);
        let part = |stride| Attribute { buffer: &floats, stride, offset: 0 };
        let [positions, normals, tangents] = [12, 12, 16].map(part);
        let moving = |vertex_count| MovingMesh {
            vertex_count,
            positions,
            normals,
            tangents,
            per: TangentsPer::Vertex,
        };
        let of_quads = plan(&quads, options).expect("a plan");
        let check = of_quads.bind_check(&moving(quads.positions.len() as u32));
        assert_eq!(check.err(), Some(GpuError::NotTriangles));
        let of_seam = plan(&grid, options).expect("a plan").bind(&moving(grid.positions.len() as u32));
        assert!(matches!(of_seam.err(), Some(GpuError::UnsplitVertices { vertices: 1.. })));
        let whole = plan(&families::grid(3, 3, false, false), options).expect("a plan");
        assert_eq!(
            whole.bind(&moving(15)).err(),
            Some(GpuError::VertexCountMismatch { expected: 16, found: 15 })
        );
    }
}
