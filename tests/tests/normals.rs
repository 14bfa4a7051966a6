//! Normals compared with the oracle, on shapes with known normals, and on degenerate input.

use darboux::{
    CornerNormalsRef, Error, Faces, Indices, Mesh, NormalOptions, NormalPlan, NormalWeight, Normals, Shading,
    SmoothingSeams, generate_normals, split_normals,
};
use darboux_tests::{Case, FaceSizes, OwnedMesh, families, oracle};

const WEIGHTS: [NormalWeight; 3] = [NormalWeight::Angle, NormalWeight::Area, NormalWeight::AngleArea];

/// The result is rounded to f32, 6e-8; the weights hold the angle, whose cosine is rounded so: where it is
/// near one that is an error of some 3e-4 of a radian in the weight, and a weight's error shows in proportion
/// to the angle between the normals that it weighs.
const TOLERANCE: f32 = 1e-5;

fn run(mesh: &OwnedMesh, options: &NormalOptions) -> Normals {
    let indices = mesh.indices.as_ref().map_or(Indices::Unindexed, Indices::from);
    let sizes = mesh.face_sizes();
    generate_normals(&mesh.positions, indices, Faces::Mixed(&sizes), options).expect("a valid mesh")
}

fn all_options() -> Vec<NormalOptions> {
    let mut all = vec![NormalOptions::new().with_shading(Shading::Flat)];
    for weight in WEIGHTS {
        for crease in [180.0, 60.0, 20.0] {
            for seams in [SmoothingSeams::Ignored, SmoothingSeams::Respected] {
                all.push(NormalOptions::new().with_weight(weight).with_crease(crease).with_seams(seams));
            }
        }
    }
    all
}

#[test]
fn regular_meshes_agree_with_the_brute_force() {
    for quads in [false, true] {
        let meshes = [
            families::grid(6, 5, quads, true),
            families::cube(quads),
            families::sphere(6, 9, quads),
            families::strip(12),
            families::grid(4, 3, quads, false).unindexed(),
        ];
        for mesh in meshes {
            for options in all_options() {
                let found = run(&mesh, &options).corners.into_per_corner();
                let expected = oracle::normals(&mesh.view(), &mesh.face_sizes(), &options);
                for (corner, (a, b)) in found.iter().zip(&expected).enumerate() {
                    let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                    assert!(worst <= TOLERANCE, "{options:?}, corner {corner}: {a:?} is not {b:?}");
                }
            }
        }
    }
}

#[test]
fn a_cube_is_flat_or_round() {
    let mesh = families::cube(true);
    let flat = run(&mesh, &NormalOptions::new().with_shading(Shading::Flat));
    let creased = run(&mesh, &NormalOptions::new().with_crease(89.0));
    let sides: Vec<[f32; 3]> = (0..24).map(|corner| mesh.normals[mesh.vertex_of_corner(corner)]).collect();
    let outward = |normal: &[f32; 3], side: &[f32; 3]| {
        normal.iter().zip(side).map(|(a, b)| a * b).sum::<f32>().abs() > 0.999_999
    };
    assert!(flat.corners.per_corner().iter().zip(&sides).all(|(normal, side)| outward(normal, side)));
    assert_eq!(flat.corners, creased.corners);
    assert_eq!(creased.report.creased_edges, 12);
    for options in [NormalOptions::default(), NormalOptions::new().with_crease(91.0)] {
        let round = run(&mesh, &options);
        let third = (1.0f32 / 3.0).sqrt();
        assert!(
            round.corners.per_corner().iter().flatten().all(|x| (x.abs() - third).abs() < 1e-6),
            "{round:?}"
        );
        assert_eq!(round.report.creased_edges, 0);
    }
    let own = run(&mesh, &NormalOptions::new().with_seams(SmoothingSeams::Respected));
    assert_eq!(own.corners, flat.corners, "every side has vertices of its own");
}

/// Angle weights do not depend on the triangulation; area weights do.
#[test]
fn angles_do_not_see_how_a_surface_is_cut() {
    let mesh = families::cube(true);
    // One side along its other diagonal: cut all alike, the corners of a cube happen to be even.
    let first = |face: usize| usize::from(face == 0);
    let halves = |(face, quad): (usize, &Vec<u32>)| {
        let at = |k: usize| quad[(first(face) + k) % 4];
        [vec![at(0), at(1), at(2)], vec![at(0), at(2), at(3)]]
    };
    let faces: Vec<Vec<u32>> = mesh.face_list().iter().enumerate().flat_map(halves).collect();
    let cut = mesh.clone().with_face_list(&faces);
    let normals = |weight| {
        let options = NormalOptions::new().with_weight(weight);
        [&mesh, &cut].map(|mesh| run(mesh, &options).corners.into_per_corner())
    };
    let differ = |[quads, triangles]: [Vec<[f32; 3]>; 2]| {
        let pairs = triangles.iter().enumerate();
        pairs
            .flat_map(|(corner, normal)| {
                let same = quads[4 * (corner / 6) + (first(corner / 6) + [0, 1, 2, 0, 2, 3][corner % 6]) % 4];
                [0, 1, 2].map(|i| (same[i] - normal[i]).abs())
            })
            .fold(0.0, f32::max)
    };
    assert!(differ(normals(NormalWeight::Angle)) < 1e-6);
    assert!(differ(normals(NormalWeight::Area)) > 0.1);
}

#[test]
fn splitting_keeps_every_corner_s_normal() {
    let mesh = families::grid(6, 5, false, false);
    let normals = run(&mesh, &NormalOptions::new().with_crease(5.0));
    let indices = mesh.indices.as_ref().expect("an indexed mesh");
    let split = split_normals(mesh.positions.len(), indices, &normals.corners).expect("as many corners");
    for (corner, normal) in normals.corners.per_corner().iter().enumerate() {
        let vertex = split.indices[corner] as usize;
        assert_eq!(split.normal_of_vertex[vertex], *normal);
        assert_eq!(split.source_of_vertex[vertex] as usize, mesh.vertex_of_corner(corner));
    }
    assert!(split.normal_of_vertex.len() > mesh.positions.len(), "creases split");
    let lone = split_normals(2, &[1u32, 1, 1], CornerNormalsRef::from_per_corner(&[[1.0, 0.0, 0.0]; 3]))
        .expect("three corners");
    assert_eq!(lone.normal_of_vertex, [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
}

#[test]
fn any_input_gives_unit_normals() {
    for seed in 0..10_000 {
        let Case { mesh, .. } = Case::from_seed(seed);
        for options in all_options().into_iter().step_by(3) {
            let normals = run(&mesh, &options);
            assert_eq!(normals.corners.len(), mesh.corner_count());
            for (corner, normal) in normals.corners.per_corner().iter().enumerate() {
                let size = normal.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
                let unit = (size - 1.0).abs() < 1e-6;
                assert!(unit, "seed {seed}, {options:?}, corner {corner}: {normal:?}\n{}", mesh.to_text());
            }
        }
    }
}

#[test]
fn wrong_structure_is_an_error() {
    let positions = [[0.0; 3]; 3];
    let run = |indices: &[u32], faces: Faces<'_>| {
        generate_normals(&positions, indices, faces, &NormalOptions::default()).map(|normals| normals.report)
    };
    assert_eq!(
        run(&[0, 1, 3], Faces::Triangles),
        Err(Error::IndexOutOfRange { at: 2, index: 3, vertices: 3 })
    );
    assert_eq!(run(&[0, 1], Faces::Triangles), Err(Error::PartialFace { corners: 2, size: 3 }));
    let empty_faces = run(&[0, 1, 2], Faces::Mixed(&[0, 0, 3, 0])).expect("faces may be empty");
    assert_eq!((empty_faces.faces, empty_faces.degenerate_faces, empty_faces.repaired_corners), (4, 4, 3));
    split_normals(3, &[0u32, 1, 2], CornerNormalsRef::from_per_corner(&[[0.0; 3]; 2]))
        .expect_err("two normals for three corners");
}

/// A mesh whose normals are zero: the area method computes normals itself.
#[test]
fn tangents_without_normals() {
    let mesh = families::sphere(8, 12, false);
    let none = darboux::Strided::repeated(&[0.0; 3], mesh.positions.len());
    let indices = mesh.indices.as_ref().expect("an indexed mesh");
    let bare = Mesh::triangles(&mesh.positions, none, &mesh.uvs, indices).expect("a valid mesh");
    let tangents = darboux::generate_tangents(&bare, &darboux::Method::Area.into());
    assert_eq!(tangents.report.repaired_corners, 0);
    let options = NormalOptions::new().with_weight(NormalWeight::Area).with_seams(SmoothingSeams::Respected);
    let normals =
        generate_normals(&mesh.positions, indices, Faces::Triangles, &options).expect("a valid mesh");
    for (tangent, normal) in tangents.corners.per_corner().iter().zip(normals.corners.per_corner()) {
        let cosine: f32 = (0..3).map(|i| tangent[i] * normal[i]).sum();
        assert!(cosine.abs() < 1e-6, "{tangent:?} {normal:?}");
    }
    assert_eq!(mesh.faces, FaceSizes::Triangles);
}

fn plan(mesh: &OwnedMesh, options: &NormalOptions) -> NormalPlan {
    let indices = mesh.indices.as_ref().map_or(Indices::Unindexed, Indices::from);
    let sizes = mesh.face_sizes();
    NormalPlan::new(&mesh.positions, indices, Faces::Mixed(&sizes), options).expect("a valid mesh")
}

#[test]
fn plans_give_moved_meshes_what_a_fresh_run_does() {
    for quads in [false, true] {
        for mut mesh in [
            families::cube(quads),
            families::sphere(6, 9, quads),
            families::grid(6, 5, quads, true).unindexed(),
        ] {
            for options in all_options() {
                let plan = plan(&mesh, &options);
                // A turn about z and a stretch: exact, no crease comes or goes.
                for [x, y, z] in &mut mesh.positions {
                    (*x, *y, *z) = (-2.0 * *y, 2.0 * *x, 2.0 * *z);
                }
                let (planned, fresh) =
                    (plan.evaluate(&mesh.positions).expect("as many"), run(&mesh, &options));
                assert_eq!(planned.report, fresh.report, "{options:?}");
                let bits = |normals: &Normals| {
                    normals.corners.per_corner().iter().map(|n| n.map(f32::to_bits)).collect::<Vec<_>>()
                };
                assert_eq!(bits(&planned), bits(&fresh), "{options:?}");
            }
        }
    }
}

#[test]
fn plans_keep_the_creases_that_they_began_with() {
    let mesh = families::cube(true);
    let plan = plan(&mesh, &NormalOptions::new().with_crease(60.0).with_seams(SmoothingSeams::Ignored));
    let mut flat = mesh.clone();
    flat.positions.iter_mut().for_each(|position| position[2] = 0.0);
    let planned = plan.evaluate(&flat.positions).expect("as many");
    assert_eq!(planned.report.creased_edges, 12);
    assert_eq!(planned.report.degenerate_faces, 4);
}

#[test]
fn plans_refuse_other_meshes() {
    let mesh = families::cube(false);
    let refused = plan(&mesh, &NormalOptions::default()).evaluate(&mesh.positions[1..]).err();
    let (expected, found) = (mesh.positions.len(), mesh.positions.len() - 1);
    assert_eq!(refused, Some(Error::OtherMesh { what: "vertices", expected, found }));
}
