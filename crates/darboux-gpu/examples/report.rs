//! Compares MikkTSpace on each adapter with the core, on families of meshes, the corpus and random meshes.
//!
//! `cargo run -p darboux-gpu --example report` prints a table in Markdown: the number of corners with the
//! bits of the core, the largest difference of a component in ulp, the number of corners with another sign or
//! in another group, and of corners that the CPU computed.

use darboux::internal::stage_arrays::{NONE, Stages};
use darboux::{Context, Faces, MikkTSpaceOptions, Mode, TangentOptions, generate_tangents};
use darboux_gpu::{Gpu, GpuError, MikkTSpace};
use darboux_tests::{Case, Dice, OwnedMesh, corpus, families};

/// The row of an adapter.
#[derive(Default)]
struct Row {
    corners: usize,
    of_cpu: usize,
    identical: usize,
    worst_ulp: u64,
    signs: usize,
    groups: usize,
}

fn main() -> Result<(), GpuError> {
    println!("| adapter | corners | identical | worst ulp | other signs | other groups | by the CPU |");
    println!("|---|---|---|---|---|---|---|");
    let meshes = meshes();
    for gpu in pollster::block_on(Gpu::open_all())? {
        let kernels = MikkTSpace::new(&gpu)?;
        let mut row = Row::default();
        for mesh in &meshes {
            row.add(&kernels, mesh)?;
        }
        let Row { corners, of_cpu, identical, worst_ulp, signs, groups } = row;
        println!("| {} | {corners} | {identical} | {worst_ulp} | {signs} | {groups} | {of_cpu} |", gpu.name);
    }
    Ok(())
}

fn meshes() -> Vec<OwnedMesh> {
    let mut meshes = vec![
        families::grid(100, 100, false, false),
        families::grid(60, 60, false, true),
        families::sphere(60, 90, false),
        families::fan(2_000, false),
        families::moebius(200, false),
        families::with_lone_degenerates(families::grid(30, 30, false, false), 50),
    ];
    meshes.extend(corpus::corpus().into_iter().map(|corpus_case| corpus_case.mesh));
    meshes.extend((0..2_000).map(|seed| Case::from_seed(seed).mesh));
    meshes.retain(|mesh| matches!(mesh.view().faces(), Faces::Triangles) && mesh.corner_count() > 0);
    // Random meshes have few complete triangle fans. Grids with noise have only complete fans, and all kinds
    // of rounding.
    meshes.extend((0..20).map(noisy_grid));
    meshes
}

fn noisy_grid(seed: u64) -> OwnedMesh {
    let mut mesh = families::grid(40, 40, false, false);
    let mut dice = Dice::from_seed(seed);
    let mut noise = |x: &mut f32, size: f32| *x += 0.5 * size * dice.uniform();
    mesh.positions.as_flattened_mut().iter_mut().for_each(|x| noise(x, 0.01));
    mesh.normals.as_flattened_mut().iter_mut().for_each(|x| noise(x, 0.2));
    mesh.uvs.as_flattened_mut().iter_mut().for_each(|x| noise(x, 0.01));
    mesh
}

impl Row {
    fn add(&mut self, kernels: &MikkTSpace, mesh: &OwnedMesh) -> Result<(), GpuError> {
        let view = mesh.view();
        let options = TangentOptions::default();
        let made = kernels.generate_tangents(&view, &options)?;
        let expected = generate_tangents(&view, &options);
        let pairs = made.tangents.corners.per_corner().iter().zip(expected.corners.per_corner());
        for (found, expected) in pairs {
            self.identical += usize::from(found.map(f32::to_bits) == expected.map(f32::to_bits));
            self.signs += usize::from(found[3] != expected[3]);
            let distances = found.iter().zip(expected).map(|(a, b)| ordered(*a).abs_diff(ordered(*b)));
            self.worst_ulp = distances.fold(self.worst_ulp, u64::max);
        }
        self.corners += mesh.corner_count();
        self.of_cpu += made.cpu_corners;
        if made.cpu_fallback.is_none() {
            self.groups += other_groups(kernels, mesh)?;
        }
        Ok(())
    }
}

/// Maps floats to integers of the same order.
fn ordered(x: f32) -> i64 {
    let size = i64::from(x.to_bits() & !(1 << 31));
    if x.is_sign_negative() { -size } else { size }
}

/// The number of corners that are in another group than in the core, at vertices without UV-degenerate
/// triangles.
fn other_groups(kernels: &MikkTSpace, mesh: &OwnedMesh) -> Result<usize, GpuError> {
    let options = MikkTSpaceOptions::new().with_mode(Mode::Corrected);
    let found = kernels.stage_arrays(&mesh.view(), &options)?;
    let core =
        Stages::new(&mesh.view(), &options, &mut Context::new(), usize::MAX).unwrap().expect("no limit");
    let faces = &core.triangulation.good.face;
    let mut seeds = vec![NONE; mesh.corner_count()];
    for group in 0..core.groups.ends().len() {
        let corners = core.groups.members(group).iter().map(|&k| 3 * faces[k as usize / 3] + k % 3);
        let seed = corners.clone().min().unwrap_or(NONE);
        corners.for_each(|corner| seeds[corner as usize] = seed);
    }
    let mut is_any = vec![false; found.welded_vertex.len()];
    for (corner, &vertex) in found.vertex_of_corner.iter().enumerate().filter(|(_, vertex)| **vertex != NONE)
    {
        is_any[vertex as usize] |= found.triangle_flags[corner / 3] & 2 != 0;
    }
    let compared = (0..seeds.len()).filter(|&corner| {
        let vertex = found.vertex_of_corner[corner];
        vertex != NONE && !is_any[vertex as usize]
    });
    Ok(compared.filter(|&corner| found.seed_of_corner[corner] != seeds[corner]).count())
}
