//! Arrays of the caller's: the same results as in the library's own, and none for an array that does not fit.

use darboux::{
    CornerTangentsRef, Method, Mode, Plan, Scratch, TangentOptions, generate_tangents, split_vertices,
    write_tangents,
};
use darboux_tests::{OwnedMesh, families};

const METHODS: [Method; 4] = [Method::MikkTSpace, Method::AngleArea, Method::Lengyel, Method::Face];

fn meshes() -> [OwnedMesh; 3] {
    [
        families::grid(6, 5, false, true),
        families::grid(6, 5, true, true),
        families::sphere(8, 13, false).unindexed(),
    ]
}

#[test]
fn have_the_same_tangents_and_splits() {
    for (mesh, method) in meshes().iter().flat_map(|mesh| METHODS.map(|method| (mesh, method))) {
        let (view, mut scratch) = (mesh.view(), Scratch::new());
        let options = TangentOptions { method, mode: Mode::Reference, ..TangentOptions::default() };
        let own = generate_tangents(&view, &options);
        let mut corners = vec![[f32::NAN; 4]; mesh.corner_count()];
        let report = write_tangents(&view, &options, &mut scratch, &mut corners).unwrap();
        assert_eq!((report, &corners[..]), (own.report, own.corners.per_corner()), "{method:?}");

        let of_array = split_vertices(&view, CornerTangentsRef::from_per_corner(&corners)).unwrap();
        assert_eq!(of_array, split_vertices(&view, &own.corners).unwrap(), "{method:?}");

        corners.fill([f32::NAN; 4]);
        Plan::new(&view, &options).write_tangents(&view, &mut scratch, &mut corners).unwrap();
        assert_eq!(corners, own.corners.per_corner(), "{method:?}");
    }
}

#[test]
fn of_another_length_are_left_alone() {
    let [mesh, ..] = meshes();
    let (view, mut scratch) = (mesh.view(), Scratch::new());
    let mut corners = vec![[7.0; 4]; mesh.corner_count() - 1];
    let options = TangentOptions::default();
    for result in [
        write_tangents(&view, &options, &mut scratch, &mut corners).map(drop),
        Plan::new(&view, &options).write_tangents(&view, &mut scratch, &mut corners),
        split_vertices(&view, CornerTangentsRef::from_per_corner(&corners)).map(drop),
    ] {
        assert!(matches!(result, Err(darboux::MeshError::OtherMesh { what: "corners", .. })), "{result:?}");
    }
    assert!(corners.iter().all(|corner| *corner == [7.0; 4]));
}
