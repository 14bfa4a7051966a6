//! Plans on meshes that move.

use darboux::{Mode, Plan, Scratch, TangentOptions, generate_tangents};
use darboux_tests::{Case, FaceSizes, OwnedMesh, families};

/// A plan of `base` on `moved`, once with triangles and once with faces that all happen to have three corners, which go through
/// every stage.
fn both(base: &OwnedMesh, moved: &OwnedMesh, mode: Mode) -> [Vec<[u32; 4]>; 2] {
    let options = TangentOptions { mode, ..TangentOptions::default() };
    let evaluate = |faces: FaceSizes| {
        let [base, moved] = [base, moved].map(|mesh| OwnedMesh { faces: faces.clone(), ..mesh.clone() });
        let plan = Plan::new(&base.view(), &options);
        let tangents = plan.evaluate(&moved.view()).expect("the same mesh, moved");
        let bits = |x: f32| if x.is_nan() { f32::NAN } else { x }.to_bits();
        tangents.per_corner().iter().map(|tangent| tangent.map(bits)).collect()
    };
    [evaluate(FaceSizes::Triangles), evaluate(FaceSizes::Mixed(vec![3; base.corner_count() / 3]))]
}

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

#[test]
fn every_stage_agrees_with_the_short_way() {
    for seed in 0..20_000 {
        let mesh = Case::from_seed(seed).mesh;
        if mesh.faces == FaceSizes::Triangles && mesh.corner_count() > 0 {
            let mode = [Mode::Reference, Mode::Repaired, Mode::Corrected][seed as usize % 3];
            let [short, long] = both(&mesh, &moved(&mesh, seed as usize), mode);
            assert_eq!(short, long, "seed {seed}");
        }
    }
}

#[test]
fn a_waving_surface_keeps_its_groups() {
    for mirrored in [false, true] {
        let base = families::grid(40, 30, false, mirrored);
        let mut waving = base.clone();
        for position in &mut waving.positions {
            position[2] += 0.05 * (3.0 * position[0]).sin() * (2.0 * position[1]).cos();
        }
        let plan = Plan::new(&base.view(), &TangentOptions::default());
        let (mut scratch, mut tangents) = (Scratch::new(), Default::default());
        for mesh in [&waving, &base, &waving] {
            plan.evaluate_into(&mesh.view(), &mut scratch, &mut tangents).expect("the same mesh, moved");
            let fresh = generate_tangents(&mesh.view(), &TangentOptions::default()).corners;
            assert_eq!(tangents.per_corner(), fresh.per_corner());
            assert_eq!(plan.count_regrouped(&mesh.view()), Ok(0));
        }
    }
}
