//! Arrays of the caller's: the same results as in the library's own, and none for an array that does not fit.

use darboux::{
    Cancel, CornerTangentsRef, MeshError, Method, Mode, Plan, Scratch, TangentOptions, generate_tangents,
    split_vertices, write_tangents,
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
        assert!(matches!(result, Err(MeshError::OtherMesh { what: "corners", .. })), "{result:?}");
    }
    assert!(corners.iter().all(|corner| *corner == [7.0; 4]));
}

/// Below 180 degrees a fan costs its size squared: this one would take the better part of an hour.
#[test]
fn a_long_run_stops_when_it_is_told_to() {
    let mesh = families::fan(1 << 20, true);
    let (view, mut scratch, cancel) = (mesh.view(), Scratch::new(), Cancel::new());
    scratch.cancel_by(&cancel);
    let options = TangentOptions { threshold: 90.0, ..TangentOptions::default() };
    let mut corners = vec![[0.0; 4]; mesh.corner_count()];
    std::thread::scope(|scope| {
        let run = scope.spawn(|| write_tangents(&view, &options, &mut scratch, &mut corners));
        std::thread::sleep(std::time::Duration::from_millis(300));
        cancel.cancel();
        assert_eq!(run.join().expect("no panic"), Err(MeshError::Cancelled));
    });
}
