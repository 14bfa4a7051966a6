//! Adding normals to documents.

mod support;

use darboux::{Faces, Indices, NormalOptions, Shading, generate_normals};
use darboux_io::gltf::{
    AddNormalsOptions, Document, NormalsOutcome, NormalsSummary, WrittenNormals, add_normals,
};
use serde_json::{Value, json};
use support::{Builder, SQUARE, reread, square, wide};

/// Two unit squares that meet at a right angle along x = 1: vertices 1 and 2 are on the edge.
const BEND: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, -1.0], [1.0, 1.0, -1.0]];
const BENT: [u16; 12] = [0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2];

fn options(normals: NormalOptions) -> AddNormalsOptions {
    AddNormalsOptions::default().with_normals(normals)
}

fn crease(degrees: f32) -> NormalOptions {
    NormalOptions::new().with_crease(degrees)
}

fn flat() -> NormalOptions {
    NormalOptions::new().with_shading(Shading::Flat)
}

fn run(document: &mut Document, options: &AddNormalsOptions) -> NormalsSummary {
    add_normals(document, options, &mut |_| {}).expect("normals")
}

fn written(summary: &NormalsSummary, place: usize) -> &WrittenNormals {
    match &summary.primitives[place].outcome {
        NormalsOutcome::Written(written) => written,
        other => panic!("not written: {other:?}"),
    }
}

/// A mesh with one primitive over the bend, with what `more` adds to it.
fn bend(more: impl FnOnce(&mut Builder, &mut Value)) -> Document {
    let mut builder = Builder::new();
    let (positions, indices) = (builder.vectors(&BEND), builder.indices(&BENT));
    let mut primitive = json!({"attributes": {"POSITION": positions}, "indices": indices});
    more(&mut builder, &mut primitive);
    builder.mesh(&[primitive]);
    builder.build()
}

/// The normals of all corners of a primitive, in the order of the file.
fn corner_normals(document: &Document, mesh: usize, place: usize) -> Vec<[f32; 3]> {
    let primitive = &document.meshes()[mesh].primitives[place];
    let normals = document.vectors::<3>(primitive.attributes["NORMAL"]).expect("normals").into_owned();
    reread(document).indices(mesh, place).iter().map(|&vertex| normals[vertex as usize]).collect()
}

fn expected(positions: &[[f32; 3]], indices: &[u16], options: &NormalOptions) -> Vec<[f32; 3]> {
    let indices = wide(indices);
    let normals = generate_normals(positions, Indices::U32(&indices), Faces::Triangles, options);
    normals.expect("normals").corners.into_per_corner()
}

#[test]
fn normals_equal_the_cores_and_split_few_vertices() {
    for (normals, vertices) in [(crease(180.0), 6), (crease(30.0), 8), (flat(), 8)] {
        let mut document = bend(|_, _| {});
        let summary = run(&mut document, &options(normals));
        assert_eq!(corner_normals(&document, 0, 0), expected(&BEND, &BENT, &normals), "{normals:?}");
        assert_eq!(written(&summary, 0).vertices_after, vertices, "{normals:?}");
        assert_eq!(
            reread(&document).reader(&reread(&document).primitive(0, 0)).read_positions().map(|p| p.len()),
            Some(vertices)
        );
    }
}

#[test]
fn split_vertices_keep_all_attributes() {
    let colours: Vec<[f32; 4]> = (0..6).map(|i| [i as f32, 0.5, 0.25, 1.0]).collect();
    let mut document = bend(|builder, primitive| {
        primitive["attributes"]["COLOR_0"] = builder.vectors(&colours).into();
    });
    run(&mut document, &options(flat()));
    let primitive = &document.meshes()[0].primitives[0];
    let followed = document.vectors::<4>(primitive.attributes["COLOR_0"]).expect("colours").into_owned();
    let indices = reread(&document).indices(0, 0);
    for (&old, new) in BENT.iter().zip(indices) {
        assert_eq!(followed[new as usize], colours[old as usize]);
    }
}

#[test]
fn primitives_of_a_mesh_are_one_surface() {
    let mut builder = Builder::new();
    let halves = [[0, 1, 2, 3].map(|i| BEND[i]), [1, 4, 5, 2].map(|i| BEND[i])];
    let primitives = halves.map(|half| {
        json!({"attributes": {"POSITION": builder.vectors(&half)}, "indices": builder.indices(&SQUARE)})
    });
    builder.mesh(&primitives);
    let mut document = builder.build();
    run(&mut document, &options(crease(180.0)));
    let both = [corner_normals(&document, 0, 0), corner_normals(&document, 0, 1)].concat();
    assert_eq!(both, expected(&BEND, &BENT, &crease(180.0)));
}

#[test]
fn shared_vertices_stay_shared() {
    let mut builder = Builder::new();
    let positions = builder.vectors(&BEND);
    let halves = [&BENT[..6], &BENT[6..]].map(|half| builder.indices(half));
    let primitives = halves.map(|half| json!({"attributes": {"POSITION": positions}, "indices": half}));
    builder.mesh(&primitives);
    let mut document = builder.build();
    run(&mut document, &options(crease(30.0)));
    let [first, second] = [0, 1].map(|place| document.meshes()[0].primitives[place].attributes.clone());
    assert_eq!(first, second);
    let both = [corner_normals(&document, 0, 0), corner_normals(&document, 0, 1)].concat();
    assert_eq!(both, expected(&BEND, &BENT, &crease(30.0)));
}

#[test]
fn existing_normals_are_kept_and_replaced_ones_lose_their_tangents() {
    let mut builder = Builder::new();
    let mut leaning = square();
    leaning.normals.fill([0.0, 0.6, 0.8]);
    let attributes = leaning.attributes(&mut builder);
    let tangents = builder.vectors(&[[1.0f32, 0.0, 0.0, 1.0]; 4]);
    let offsets = builder.vectors(&[[0.0f32, 0.0, 0.5]; 4]);
    let indices = builder.indices(&SQUARE);
    let mut with_tangents = attributes;
    with_tangents["TANGENT"] = tangents.into();
    let points = json!({"attributes": with_tangents, "mode": 0});
    builder.mesh(&[
        json!({"attributes": with_tangents, "indices": indices, "targets": [{"TANGENT": offsets}]}),
        points,
    ]);
    let mut document = builder.build();
    let summary = run(&mut document, &AddNormalsOptions::default());
    assert!(matches!(summary.primitives[0].outcome, NormalsOutcome::Kept { .. }));
    assert!(matches!(summary.primitives[1].outcome, NormalsOutcome::Skipped { .. }));
    assert!(!document.is_changed());
    let summary = run(&mut document, &AddNormalsOptions::default().with_overwrite(true));
    assert!(written(&summary, 0).tangents_removed && written(&summary, 0).replaced);
    let primitive = &document.meshes()[0].primitives[0];
    assert!(!primitive.attributes.contains_key("TANGENT"));
    let target = &primitive.targets[0];
    assert_eq!(target.keys().collect::<Vec<_>>(), ["NORMAL"]);
    assert_eq!(document.vectors::<3>(target["NORMAL"]).expect("offsets")[..], [[0.0; 3]; 4]);
}

/// Exporters that write accessors per primitive say the same of shared positions in other bytes.
#[test]
fn tangents_stay_with_normals_that_stay_in_any_accessor() {
    let mut builder = Builder::new();
    let (positions, indices) = (builder.vectors(&square().positions), builder.indices(&SQUARE));
    let tangents = builder.vectors(&[[1.0f32, 0.0, 0.0, 1.0]; 4]);
    let mut with_normals = |z: f32| {
        let normals = builder.vectors(&[[0.0, 0.0, z]; 4]);
        let attributes = json!({"POSITION": positions, "NORMAL": normals, "TANGENT": tangents});
        json!({"attributes": attributes, "indices": indices})
    };
    let primitives = [1.0, 1.0, -1.0].map(&mut with_normals);
    builder.mesh(&primitives);
    let mut document = builder.build();
    let summary = run(&mut document, &AddNormalsOptions::default().with_overwrite(true));
    let removed = [0, 1, 2].map(|place| written(&summary, place).tangents_removed);
    assert_eq!(removed, [false, false, true]);
    let has_tangents =
        |place: usize| document.meshes()[0].primitives[place].attributes.contains_key("TANGENT");
    assert_eq!([0, 1, 2].map(has_tangents), [true, true, false]);
}

#[test]
fn morph_targets_get_offsets_to_the_normals_of_the_moved_mesh() {
    let mut moved = BEND;
    moved[3] = [0.0, 1.0, 0.25];
    let offsets: Vec<[f32; 3]> =
        BEND.iter().zip(moved).map(|(base, moved)| std::array::from_fn(|i| moved[i] - base[i])).collect();
    // Flat: the square folds, but its triangles share the vertices 0 and 2, which cannot have two offsets.
    for (normals, conflicts) in [(crease(180.0), 0), (crease(60.0), 0), (flat(), 2)] {
        let mut document = bend(|builder, primitive| {
            primitive["targets"] = json!([{"POSITION": builder.vectors(&offsets)}]);
        });
        let summary = run(&mut document, &options(normals));
        assert_eq!(written(&summary, 0).morph_targets, 1);
        assert_eq!(written(&summary, 0).conflicting_corners, conflicts);
        let primitive = &document.meshes()[0].primitives[0];
        let found = document.vectors::<3>(primitive.targets[0]["NORMAL"]).expect("offsets").into_owned();
        let [base, after] = [BEND, moved].map(|positions| expected(&positions, &BENT, &normals));
        let vertices = reread(&document).indices(0, 0);
        let offset = |corner: usize| std::array::from_fn(|i| after[corner][i] - base[corner][i]);
        let differ = (0..12).filter(|&corner| found[vertices[corner] as usize] != offset(corner));
        assert_eq!(differ.count(), conflicts, "{normals:?}");
        assert_ne!(offset(5), [0.0; 3]);
    }
}

#[test]
fn an_index_out_of_range_is_one_sentence() {
    let mut document = bend(|builder, primitive| {
        primitive["indices"] = builder.indices(&[0, 1, 9]).into();
    });
    let error = add_normals(&mut document, &AddNormalsOptions::default(), &mut |_| {}).expect_err("an error");
    assert_eq!(
        error.to_string(),
        "test.gltf: meshes[0].primitives[0]: index 9 at place 2 is out of range: there are 6 vertices; export the file again"
    );
}
