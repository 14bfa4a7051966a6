//! Morph targets: tangent offsets, and targets of split vertices.

mod support;

use darboux::{Mesh, Plan, TangentOptions};
use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use serde_json::{Value, json};
use support::*;

fn document(vertices: &Vertices, indices: &[u16], targets: impl FnOnce(&mut Builder) -> Value) -> Document {
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.indices(indices);
    let targets = targets(&mut builder);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "targets": targets})]);
    builder.build()
}

/// The tangent offsets of a target, one per vertex.
fn offsets(document: &Document, target: usize) -> Vec<[f32; 3]> {
    let targets = &document.meshes()[0].primitives[0].targets;
    document.vectors(targets[target]["TANGENT"]).unwrap().into_owned()
}

/// A document as its file gives it.
fn reopened(document: &Document) -> Document {
    let file = document.to_glb().unwrap();
    Document::from_bytes("m.glb", file, None, &LoadOptions::default()).unwrap()
}

fn add(base: &[[f32; 3]], by: &[[f32; 3]]) -> Vec<[f32; 3]> {
    base.iter().zip(by).map(|(base, by)| std::array::from_fn(|i| base[i] + by[i])).collect()
}

#[test]
fn targets_that_move_vertices_get_tangent_offsets() {
    let vertices = square();
    // The first target shears the square, the second turns the normals, the third moves only UVs.
    let shear: Vec<_> = vertices.positions.iter().map(|p| [0.0, p[0], 0.0]).collect();
    let turn = vec![[0.25, 0.5, -0.5]; 4];
    let mut document = document(&vertices, &SQUARE, |builder| {
        json!([
            {"POSITION": builder.vectors(&shear)},
            {"POSITION": builder.vectors(&[[0.0; 3]; 4]), "NORMAL": builder.vectors(&turn)},
            {"TEXCOORD_0": builder.vectors(&[[0.5, 0.0]; 4])},
        ])
    });
    let summary = run(&mut document);
    assert_eq!(written(&summary, 0).morph_targets, 2);

    let corners = wide(&SQUARE);
    let base = Mesh::triangles(&vertices.positions, &vertices.normals, &vertices.uvs, &corners).unwrap();
    let plan = Plan::new(&base, &TangentOptions::default());
    let moved = [
        (add(&vertices.positions, &shear), vertices.normals.clone()),
        (vertices.positions.clone(), add(&vertices.normals, &turn)),
    ];
    for (target, (positions, normals)) in moved.iter().enumerate() {
        let mesh = Mesh::triangles(positions, normals, &vertices.uvs, &corners).unwrap();
        let evaluated = plan.evaluate(&mesh).unwrap();
        let offsets = offsets(&document, target);
        assert!(offsets.iter().flatten().any(|&x| x != 0.0), "target {target} moves tangents");
        for (tangent, vertex) in evaluated.per_corner().iter().zip(SQUARE) {
            let expected: [f32; 3] = std::array::from_fn(|i| tangent[i] - [1.0, 0.0, 0.0][i]);
            assert_eq!(offsets[usize::from(vertex)], expected);
        }
    }
    assert!(!document.meshes()[0].primitives[0].targets[2].contains_key("TANGENT"));
}

#[test]
fn offsets_that_exist_stay_unless_overwritten() {
    let build = || {
        document(&square(), &SQUARE, |builder| {
            let lift = builder.vectors(&[[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]);
            json!([{"POSITION": lift, "TANGENT": builder.vectors(&[[9.0; 3]; 4])}])
        })
    };
    let mut kept = build();
    assert_eq!(written(&run(&mut kept), 0).morph_targets, 0);
    assert_eq!(offsets(&kept, 0), [[9.0; 3]; 4]);
    let mut replaced = build();
    let summary = run_with(&mut replaced, &AddTangentsOptions::default().with_overwrite(true));
    assert_eq!(written(&summary, 0).morph_targets, 1);
    assert!(offsets(&replaced, 0).iter().flatten().all(|x| x.abs() <= 1.0));
}

#[test]
fn a_base_that_keeps_its_tangents_gets_no_offsets() {
    let mut builder = Builder::new();
    let mut attributes = square().attributes(&mut builder);
    attributes["TANGENT"] = builder.vectors(&[[1.0, 0.0, 0.0, 1.0]; 4]).into();
    let targets = json!([{"POSITION": builder.vectors(&[[1.0; 3]; 4])}]);
    let indices = builder.indices(&SQUARE);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "targets": targets})]);
    let mut document = builder.build();
    run(&mut document);
    assert!(!document.is_changed());
}

#[test]
fn targets_follow_a_split() {
    let vertices = butterfly();
    let lift: Vec<_> = (0..6).map(|i| [0.0, 0.0, 0.125 * i as f32]).collect();
    let tint: Vec<u8> = (1..25).collect();
    let mut document = document(&vertices, &BOTH, |builder| {
        let tint = builder.accessor(&tint, 6, 5121, "VEC4", json!({"normalized": true}));
        json!([{"POSITION": builder.vectors(&lift), "COLOR_0": tint, "_X": tint}])
    });
    let before = reread(&document);
    let summary = run(&mut document);
    assert_eq!(written(&summary, 0).vertices_after, 8);
    let after = reread(&document);
    let indices = after.indices(0, 0);
    let (old, new) = (before.primitive(0, 0), after.primitive(0, 0));
    let (old, new) = (old.morph_targets().next().unwrap(), new.morph_targets().next().unwrap());
    let old_positions = old.positions().unwrap();
    let new_positions = new.positions().unwrap();
    assert_eq!((new_positions.min(), new_positions.max()), (old_positions.min(), old_positions.max()));
    let (source, moved) = (before.elements(&old_positions), after.elements(&new_positions));
    assert_eq!(moved.len(), 8);
    for (&vertex, old) in indices.iter().zip(BOTH) {
        assert_eq!(moved[vertex as usize], source[usize::from(old)]);
    }
    let targets = &document.meshes()[0].primitives[0].targets[0];
    assert_eq!(document.accessors()[targets["COLOR_0"]].count, 8);
    assert_eq!(targets["COLOR_0"], targets["_X"], "one copy serves both");

    // Offsets belong to the side of the seam that the vertex is on.
    let corners = wide(&BOTH);
    let base = Mesh::triangles(&vertices.positions, &vertices.normals, &vertices.uvs, &corners).unwrap();
    let plan = Plan::new(&base, &TangentOptions::default());
    let positions = add(&vertices.positions, &lift);
    let mesh = Mesh::triangles(&positions, &vertices.normals, &vertices.uvs, &corners).unwrap();
    let evaluated = plan.evaluate(&mesh).unwrap();
    let offsets = offsets(&document, 0);
    let tangents = after.tangents(0, 0);
    for (&vertex, expected) in indices.iter().zip(evaluated.per_corner()) {
        let (tangent, offset) = (tangents[vertex as usize], offsets[vertex as usize]);
        assert_eq!(offset, std::array::from_fn(|i| expected[i] - tangent[i]));
    }
}

#[test]
fn sparse_targets_are_read_and_follow_a_split() {
    let vertices = butterfly();
    let mut document = document(&vertices, &BOTH, |builder| {
        let places = builder.accessor(&[2, 5], 2, 5121, "SCALAR", json!({}));
        let values = builder.vectors(&[[0.0, 1.0, 0.0], [0.0, 2.0, 0.0]]);
        let sparse = json!({
            "count": 2,
            "indices": {"bufferView": places, "componentType": 5121},
            "values": {"bufferView": values},
        });
        let more = json!({"sparse": sparse, "min": [0, 0, 0], "max": [0, 2, 0]});
        json!([{"POSITION": builder.zeros(6, "VEC3", more)}])
    });
    let summary = run(&mut document);
    assert_eq!(written(&summary, 0).morph_targets, 1);
    let targets = &document.meshes()[0].primitives[0].targets[0];
    for semantic in ["POSITION", "TANGENT"] {
        let accessor = &document.accessors()[targets[semantic]];
        assert!(accessor.buffer_view.is_none() && accessor.is_sparse(), "{semantic}");
        assert_eq!(accessor.count, 8);
    }
    let after = reread(&document);
    let primitive = after.primitive(0, 0);
    let (moved, _, turned) = after.reader(&primitive).read_morph_targets().next().unwrap();
    let moved: Vec<_> = moved.unwrap().map(|offset| offset[1]).collect();
    assert_eq!(moved, [0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    let turned: Vec<_> = turned.unwrap().collect();
    assert_eq!(turned, offsets(&document, 0));
    assert!(turned.iter().flatten().any(|&x| x != 0.0));
}

#[test]
fn sparse_targets_that_turn_nothing_get_zeros_without_bytes() {
    let mut document = document(
        &square(),
        &SQUARE,
        |builder| json!([{"POSITION": builder.zeros(4, "VEC3", json!({"min": [0, 0, 0], "max": [0, 0, 0]}))}]),
    );
    run(&mut document);
    let accessor = &document.accessors()[document.meshes()[0].primitives[0].targets[0]["TANGENT"]];
    assert!(accessor.buffer_view.is_none() && !accessor.is_sparse());
    assert_eq!(offsets(&document, 0), [[0.0; 3]; 4]);
}

#[test]
fn offsets_of_vertices_that_no_face_uses_take_no_bytes() {
    let count = 100;
    let square = square();
    let places = [97, 3, 50, 20];
    let of_many = |values: &[[f32; 3]]| {
        let mut all = vec![[0.5; 3]; count];
        places.iter().zip(values).for_each(|(&place, &value)| all[usize::from(place)] = value);
        all
    };
    let mut vertices = Vertices {
        positions: of_many(&square.positions),
        normals: of_many(&square.normals),
        uvs: vec![[0.5; 2]; count],
    };
    places.iter().zip(&square.uvs).for_each(|(&place, &uv)| vertices.uvs[usize::from(place)] = uv);
    let indices: Vec<u16> = SQUARE.iter().map(|&corner| places[usize::from(corner)]).collect();
    let shear: Vec<_> = square.positions.iter().map(|p| [0.0, p[0], 0.0]).collect();
    let build = |vertices: &Vertices, indices: &[u16], shear: Vec<[f32; 3]>| {
        let mut document =
            document(vertices, indices, |builder| json!([{"POSITION": builder.vectors(&shear)}]));
        assert_eq!(written(&run(&mut document), 0).morph_targets, 1);
        document
    };
    let few = build(&square, &SQUARE, shear.clone());
    let many = build(&vertices, &indices, of_many(&shear));
    let of_few = offsets(&reopened(&few), 0);
    let of_many_offsets = offsets(&reopened(&many), 0);
    assert!(of_few.iter().flatten().any(|&x| x != 0.0));
    for (vertex, offset) in of_many_offsets.iter().enumerate() {
        let place = places.iter().position(|&place| usize::from(place) == vertex);
        assert_eq!(*offset, place.map_or([0.0; 3], |place| of_few[place]), "vertex {vertex}");
    }
    let accessor = &many.accessors()[many.meshes()[0].primitives[0].targets[0]["TANGENT"]];
    assert!(accessor.buffer_view.is_none() && accessor.is_sparse() && accessor.count == count);
    // Old offsets of all vertices change neither that nor, where they are the same, themselves.
    let mut again = reopened(&many);
    let options = AddTangentsOptions::default().with_overwrite(true);
    run_with(&mut again, &options);
    assert!(!again.is_changed());
    let full = vec![[0.25; 3]; count];
    let mut replaced = document(
        &vertices,
        &indices,
        |builder| json!([{"POSITION": builder.vectors(&of_many(&shear)), "TANGENT": builder.vectors(&full)}]),
    );
    run_with(&mut replaced, &options);
    assert_eq!(offsets(&reopened(&replaced), 0), of_many_offsets);
    let accessor = &replaced.accessors()[replaced.meshes()[0].primitives[0].targets[0]["TANGENT"]];
    assert!(accessor.buffer_view.is_none() && accessor.is_sparse());
}

#[test]
fn one_movement_of_several_primitives_is_evaluated_once() {
    let vertices = butterfly();
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let lift: Vec<_> = (0..6).map(|i| [0.0, 0.0, (i * i) as f32]).collect();
    let lift = builder.vectors(&lift);
    let targets = json!([{"POSITION": lift}, {"POSITION": builder.alias(lift, json!({}))}]);
    let ranges = [LEFT, RIGHT].map(|range| builder.indices(&range));
    let primitives =
        ranges.map(|indices| json!({"attributes": attributes, "indices": indices, "targets": targets}));
    builder.mesh(&primitives);
    let mut document = builder.build();
    let before = document.accessors().len();
    let summary = run(&mut document);
    assert_eq!((written(&summary, 0).morph_targets, written(&summary, 1).morph_targets), (2, 2));
    let [left, right] = document.meshes()[0].primitives.as_slice() else { panic!() };
    assert_eq!(left.targets, right.targets);
    assert_eq!(left.targets[0], left.targets[1]);
    // Positions, normals, UVs, tangents, indices of the right side, the target's positions and tangents.
    assert_eq!(document.accessors().len(), before + 7);
}

#[test]
fn corners_with_another_group_after_morphing_are_counted() {
    // The target turns the right square's texture by moving it behind the left one.
    let vertices = continuous();
    let fold: Vec<_> = vertices.positions.iter().map(|p| [-2.0 * p[0].max(0.0), 0.0, 0.0]).collect();
    let mut document = document(&vertices, &BOTH, |builder| json!([{"POSITION": builder.vectors(&fold)}]));
    let summary = run(&mut document);
    assert!(written(&summary, 0).regrouped_corners > 0);
}

/// Two squares with one continuous texture.
fn continuous() -> Vertices {
    let mut vertices = butterfly();
    vertices.uvs = vertices.positions.iter().map(|p| [p[0], 1.0 - p[1]]).collect();
    vertices
}

#[test]
fn corners_that_share_a_vertex_but_not_its_offset_are_counted() {
    // Two squares that touch in one vertex: not one group, but equal tangents until the target turns one of
    // them.
    let positions: Vec<_> =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]
            .map(|[x, y]: [f32; 2]| [x, y, 0.0])
            .to_vec();
    let uvs = positions.iter().map(|p| [p[0], 2.0 - p[1]]).collect();
    let vertices = Vertices { normals: vec![[0.0, 0.0, 1.0]; 7], positions, uvs };
    let list = [0, 1, 2, 0, 2, 3, 2, 4, 5, 2, 5, 6];
    let mut shear = vec![[0.0; 3]; 7];
    shear[4] = [0.0, -0.5, 0.0];
    shear[5] = [0.0, -0.5, 0.0];
    let mut document = document(&vertices, &list, |builder| json!([{"POSITION": builder.vectors(&shear)}]));
    let summary = run(&mut document);
    let written = written(&summary, 0);
    assert_eq!((written.vertices_after, written.conflicting_corners), (7, 2));
}

#[test]
fn broken_offsets_are_errors() {
    let error = |offsets: &[[f32; 3]], strict| {
        let mut document =
            document(&square(), &SQUARE, |builder| json!([{}, {"NORMAL": builder.vectors(offsets)}]));
        let options = AddTangentsOptions::default().with_strict(strict);
        add_tangents(&mut document, &options, &mut |_| {}).err().map(|error| error.to_string())
    };
    let short = error(&[[0.0; 3]; 3], false).unwrap();
    let sentence = "test.gltf: meshes[0].primitives[0].targets[1]: accessor 4 has 3 elements for 4 vertices";
    assert!(short.starts_with(sentence), "{short}");
    assert_eq!(error(&[[f32::INFINITY; 3]; 4], false), None);
    let infinite = error(&[[f32::INFINITY; 3]; 4], true).unwrap();
    assert!(infinite.contains("4 offsets of accessor 4 are not finite"), "{infinite}");
}

#[test]
fn offsets_are_finite_whatever_the_target_holds() {
    let huge = [[f32::MAX; 3], [-f32::MAX; 3], [1e-40; 3], [f32::NAN; 3]];
    let mut document = document(
        &square(),
        &SQUARE,
        |builder| json!([{"POSITION": builder.vectors(&huge), "NORMAL": builder.vectors(&huge)}]),
    );
    run(&mut document);
    assert!(offsets(&document, 0).iter().flatten().all(|x| x.is_finite()));
}
