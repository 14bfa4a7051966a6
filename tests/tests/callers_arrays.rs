//! Functions that write into the caller's arrays: the same results as those that allocate, and an error for
//! an array of another length.

use std::panic::{AssertUnwindSafe, catch_unwind};

use darboux::{
    Context, CornerTangentsRef, Error, Frame, Method, MikkTSpaceOptions, Mode, Plan, TangentOptions,
    generate_compact_frames, generate_frames, generate_tangents, split_vertices, write_frames,
    write_tangents,
};
use darboux_tests::{OwnedMesh, families};

const METHODS: [Method; 4] = [
    Method::MikkTSpace(MikkTSpaceOptions::new().with_mode(Mode::Reference)),
    Method::AngleArea,
    Method::Lengyel,
    Method::Face,
];

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
        let (view, mut context) = (mesh.view(), Context::new());
        let options = TangentOptions::from(method);
        let own = generate_tangents(&view, &options);
        let mut corners = vec![[f32::NAN; 4]; mesh.corner_count()];
        let report = write_tangents(&view, &options, &mut context, &mut corners).unwrap();
        assert_eq!((report, &corners[..]), (own.report, own.corners.per_corner()), "{method:?}");

        let of_array = split_vertices(&view, CornerTangentsRef::from_per_corner(&corners)).unwrap();
        assert_eq!(of_array, split_vertices(&view, &own.corners).unwrap(), "{method:?}");

        corners.fill([f32::NAN; 4]);
        Plan::new(&view, &options).write_tangents(&view, &mut context, &mut corners).unwrap();
        assert_eq!(corners, own.corners.per_corner(), "{method:?}");
    }
}

/// Every method on one thread and on several, with a context that was used for larger and smaller meshes
/// before.
#[test]
fn have_the_same_frames() {
    let large = families::grid(97, 97, false, true);
    let mut context = Context::new();
    for mesh in meshes().iter().chain([&large, &families::fan(9, false)]) {
        let sharp = Method::MikkTSpace(MikkTSpaceOptions::new().with_threshold(60.0));
        for method in METHODS.into_iter().chain([Method::default(), sharp]) {
            let options = TangentOptions::from(method);
            let (view, count) = (mesh.view(), mesh.corner_count());
            let own = generate_frames(&view, &options);
            let mut frames = vec![Frame::default(); count];
            let report = write_frames(&view, &options, &mut context, &mut frames).unwrap();
            assert_eq!((report, &frames[..]), (own.report, own.corners.per_corner()), "{method:?}");

            let compact = generate_compact_frames(&view, &options, &mut context).unwrap();
            assert_eq!((compact.report(), compact.len()), (own.report, count));
            for (first, size) in [(0, count), (1, 2), (count - 1, 1), (count, 0)] {
                let mut part = vec![Frame::default(); size];
                compact.read(first, &mut part);
                assert_eq!(part, own.corners.per_corner()[first..first + size], "{method:?}");
            }
            for (first, size) in [(1, count), (count, 1), (usize::MAX, 1)] {
                let read = || compact.read(first, &mut vec![Frame::default(); size]);
                assert!(catch_unwind(AssertUnwindSafe(read)).is_err(), "{first} {size}");
            }
            let (mut tangents, mut bitangents) = (vec![[0.0; 4]; count], vec![[0.0; 3]; count]);
            let mut magnitudes = vec![[0.0; 2]; count];
            compact.read_apart(&mut tangents, &mut bitangents, &mut magnitudes).unwrap();
            assert!(compact.read_apart(&mut tangents, &mut bitangents[1..], &mut magnitudes).is_err());
            let parts = |frame: &Frame| (frame.tangent_and_sign(), frame.bitangent, frame.magnitude);
            let apart = tangents.into_iter().zip(bitangents).zip(magnitudes).map(|((t, b), m)| (t, b, m));
            assert!(apart.eq(frames.iter().map(parts)), "{method:?}");
        }
    }
}

/// A context remembers nothing of a mesh without UV area in a later mesh to which the fast path does not
/// apply.
#[test]
fn have_the_same_frames_after_a_mesh_without_uv_area() {
    let mut flat = families::grid(6, 5, false, true);
    flat.uvs.fill([0.5; 2]);
    let mut not_finite = families::grid(2, 2, false, true);
    not_finite.positions[0][0] = f32::NAN;
    let (options, mut context) = (TangentOptions::default(), Context::new());
    let mut tangents = vec![[0.0; 4]; flat.corner_count()];
    write_tangents(&flat.view(), &options, &mut context, &mut tangents).unwrap();
    let mut frames = vec![Frame::default(); not_finite.corner_count()];
    let report = write_frames(&not_finite.view(), &options, &mut context, &mut frames).unwrap();
    let own = generate_frames(&not_finite.view(), &options);
    assert_eq!(report, own.report);
    let bits = |frame: &Frame| frame.tangent.map(f32::to_bits);
    assert!(frames.iter().map(bits).eq(own.corners.per_corner().iter().map(bits)));
}

#[test]
fn of_another_length_are_left_alone() {
    let [mesh, ..] = meshes();
    let (view, mut context) = (mesh.view(), Context::new());
    let mut corners = vec![[7.0; 4]; mesh.corner_count() - 1];
    let options = TangentOptions::default();
    for result in [
        write_tangents(&view, &options, &mut context, &mut corners).map(drop),
        Plan::new(&view, &options).write_tangents(&view, &mut context, &mut corners),
    ] {
        assert!(matches!(result, Err(Error::OutputLength { what: "tangents", .. })), "{result:?}");
    }
    let result = split_vertices(&view, CornerTangentsRef::from_per_corner(&corners));
    assert!(matches!(result, Err(Error::InputLength { what: "tangents", .. })), "{result:?}");
    assert!(corners.iter().all(|corner| *corner == [7.0; 4]));
    let mut frames = vec![Frame::default(); mesh.corner_count() + 1];
    let result = write_frames(&view, &options, &mut context, &mut frames);
    let expected = mesh.corner_count();
    let error = Error::OutputLength { what: "frames", expected, found: expected + 1 };
    assert_eq!(result, Err(error));
}
