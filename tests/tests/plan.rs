//! Plans on meshes that move.

use darboux::{Method, Mode, Plan, Scratch, TangentOptions, generate_tangents};
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

#[test]
fn every_stage_agrees_with_the_short_way() {
    for seed in 0..20_000 {
        let mesh = Case::from_seed(seed).mesh;
        if mesh.faces == FaceSizes::Triangles && mesh.corner_count() > 0 {
            let mode = [Mode::Reference, Mode::Repaired, Mode::Corrected][seed as usize % 3];
            let [short, long] = both(&mesh, &mesh.moved(seed as usize), mode);
            assert_eq!(short, long, "seed {seed}");
        }
    }
}

#[test]
fn a_waving_surface_keeps_its_groups() {
    for (mirrored, method) in [
        (false, Method::MikkTSpace),
        (true, Method::MikkTSpace),
        (false, Method::AngleArea),
        (true, Method::AngleArea),
        (true, Method::Lengyel),
        (true, Method::Average),
    ] {
        let options = TangentOptions { method, ..TangentOptions::default() };
        let base = families::grid(40, 30, false, mirrored);
        let mut waving = base.clone();
        for position in &mut waving.positions {
            position[2] += 0.05 * (3.0 * position[0]).sin() * (2.0 * position[1]).cos();
        }
        let plan = Plan::new(&base.view(), &options);
        let (mut scratch, mut tangents) = (Scratch::new(), Default::default());
        for mesh in [&waving, &base, &waving] {
            plan.evaluate_into(&mesh.view(), &mut scratch, &mut tangents).expect("the same mesh, moved");
            let fresh = generate_tangents(&mesh.view(), &options).corners;
            assert_eq!(tangents.per_corner(), fresh.per_corner());
            assert_eq!(plan.count_regrouped(&mesh.view()), Ok(0));
        }
    }
}

/// Vertices that fall onto others, or nowhere, change no group: nothing but their own triangles and those around them.
#[test]
fn groups_of_angle_and_area_hold_whatever_moves() {
    let options = TangentOptions { method: Method::AngleArea, ..TangentOptions::default() };
    for seed in 0..5_000 {
        let mesh = Case::from_seed(seed).mesh;
        let moved = mesh.moved(seed as usize);
        let plan = Plan::new(&mesh.view(), &options);
        let base = generate_tangents(&mesh.view(), &options);
        assert_eq!(plan.base().report, base.report, "seed {seed}");
        let bits = |tangents: &[[f32; 4]]| tangents.iter().map(|it| it.map(f32::to_bits)).collect::<Vec<_>>();
        let still = plan.evaluate(&mesh.view()).expect("the same mesh");
        assert_eq!(bits(still.per_corner()), bits(base.corners.per_corner()), "seed {seed}");
        let tangents = plan.evaluate(&moved.view()).expect("the same mesh, moved");
        for (tangent, base) in tangents.per_corner().iter().zip(base.corners.per_corner()) {
            let [x, y, z, w] = tangent.map(f64::from);
            assert!(((x * x + y * y + z * z).sqrt() - 1.0).abs() < 1e-3, "seed {seed}: {tangent:?}");
            assert_eq!(w, f64::from(base[3]), "seed {seed}");
        }
    }
}
