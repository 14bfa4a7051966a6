//! Plans on deformed meshes.

use darboux::{Choice, Context, Method, MikkTSpaceOptions, Mode, Plan, TangentOptions, generate_tangents};
use darboux_tests::{Case, FaceSizes, OwnedMesh, families};

/// The tangents of `moved` by a plan of `base`, as bits.
fn planned(base: &OwnedMesh, moved: &OwnedMesh, options: &TangentOptions) -> Vec<[u32; 4]> {
    let plan = Plan::new(&base.view(), options);
    let tangents = plan.evaluate(&moved.view()).expect("the same mesh, moved");
    let bits = |x: f32| if x.is_nan() { f32::NAN } else { x }.to_bits();
    tangents.per_corner().iter().map(|tangent| tangent.map(bits)).collect()
}

/// The mesh with a pentagon added. MikkTSpace does not support it, so the mesh takes the general path.
fn with_pentagon(mesh: &OwnedMesh) -> OwnedMesh {
    let mut faces = mesh.face_list();
    faces.push(vec![0; 5]);
    let mesh = if mesh.indices.is_some() { mesh.clone() } else { mesh.unindexed() };
    mesh.with_face_list(&faces)
}

/// Scales of x, y and z, also such that squares of lengths are too small or too large for a float. (Quads at
/// 1e-22 had bitangents that were NaN, and so averaged tangents.)
const SCALES: [[f32; 3]; 8] = [
    [1.0; 3],
    [1.25, 0.75, -1.5],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1e-20],
    [1e-18; 3],
    [1e-22; 3],
    [1e-38; 3],
    [1e18; 3],
];

fn scaled(mesh: &OwnedMesh, scale: [f32; 3]) -> OwnedMesh {
    let mut scaled = mesh.clone();
    for position in &mut scaled.positions {
        *position = [0, 1, 2].map(|axis| scale[axis] * position[axis]);
    }
    scaled
}

fn is_supported(size: u32) -> bool {
    matches!(size, 3 | 4)
}

/// The seeds `first..last` of the variable DARBOUX_SWEEP, or 20,000.
fn seeds() -> std::ops::Range<u64> {
    let Ok(range) = std::env::var("DARBOUX_SWEEP") else { return 0..20_000 };
    let (first, last) = range.split_once("..").expect("first..last");
    first.parse().expect("a number")..last.parse().expect("a number")
}

#[test]
fn every_stage_agrees_with_the_short_way() {
    for seed in seeds() {
        let Case { mesh, threshold } = Case::from_seed(seed);
        if mesh.corner_count() > 0 && mesh.face_sizes().into_iter().all(is_supported) {
            let mode = [Mode::Reference, Mode::Repaired, Mode::Corrected][seed as usize % 3];
            let options =
                TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold));
            let scale = SCALES[seed as usize / 3 % SCALES.len()];
            for moved in [mesh.moved(seed as usize), scaled(&mesh, scale)] {
                let short = planned(&mesh, &moved, &options);
                let mut long = planned(&with_pentagon(&mesh), &with_pentagon(&moved), &options);
                long.truncate(short.len());
                assert_eq!(short, long, "seed {seed}, scale {scale:?}");
            }
        }
    }
}

/// A plan uses the faces of its base mesh and ignores those of the deformed mesh.
#[test]
fn other_faces_change_nothing() {
    let base = families::grid(3, 2, true, true);
    let (view, corners) = (base.view(), base.corner_count());
    let others = [
        base.clone().with_face_list(&vec![vec![11, 5, 7]; corners / 3]),
        base.clone().with_face_list(&[vec![11; 2], vec![0; corners - 2]]),
    ];
    for &method in Method::ALL {
        for base in [base.clone(), OwnedMesh { faces: FaceSizes::Triangles, ..base.clone() }] {
            let options = TangentOptions::from(method);
            let plan = Plan::new(&base.view(), &options);
            for other in &others {
                assert_eq!(plan.evaluate(&other.view()), plan.evaluate(&view), "{method:?}");
            }
        }
    }
}

#[test]
fn a_waving_surface_keeps_its_groups() {
    for (mirrored, &method) in [false, true]
        .into_iter()
        .flat_map(|mirrored| Method::ALL.iter().map(move |method| (mirrored, method)))
    {
        let options = TangentOptions::from(method);
        let base = families::grid(40, 30, false, mirrored);
        let mut waving = base.clone();
        for position in &mut waving.positions {
            position[2] += 0.05 * (3.0 * position[0]).sin() * (2.0 * position[1]).cos();
        }
        let plan = Plan::new(&base.view(), &options);
        let mut context = Context::new();
        for mesh in [&waving, &base, &waving] {
            let tangents = plan.evaluate_with(&mesh.view(), &mut context).expect("the same mesh, moved");
            let fresh = generate_tangents(&mesh.view(), &options).corners;
            assert_eq!(tangents.per_corner(), fresh.per_corner());
            assert_eq!(plan.count_regrouped(&mesh.view()), Ok(0));
        }
    }
}

/// Vertices that coincide with others or are NaN change only their own triangles and their neighbours.
#[test]
fn groups_of_angle_and_area_hold_whatever_moves() {
    let options = TangentOptions::from(Method::AngleArea);
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
