//! Vertices are split, and all other data is kept.

use gltf::Semantic;
use gltf::mesh::Mode as Topology;
use serde_json::json;

use crate::support::*;

#[test]
fn without_a_split_only_tangents_are_added() {
    let mut builder = Builder::new();
    let (vertices, indices) = (square(), builder.indices(&SQUARE));
    let attributes = vertices.attributes(&mut builder);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    let accessors = document.accessors().len();

    let summary = run(&mut document);

    assert_eq!(document.accessors().len(), accessors + 1);
    let primitive = &document.meshes()[0].primitives[0];
    assert_eq!(primitive.indices, Some(indices));
    assert_eq!(primitive.attributes["POSITION"], attributes["POSITION"]);
    let written = written(&summary, 0);
    assert_eq!((written.vertices_before, written.vertices_after, written.counts.triangles), (4, 4, 2));
    // An upright image has w = +1 in glTF, where MikkTSpace says -1.
    assert_eq!(reread(&document).tangents(0, 0), [[1.0, 0.0, 0.0, 1.0]; 4]);
    assert_eq!(vertices.expected(&wide(&SQUARE))[0], [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn a_split_carries_every_attribute_bit_for_bit() {
    let mut builder = Builder::new();
    let vertices = butterfly();
    let mut attributes = vertices.attributes(&mut builder);
    let second_uvs = [[0.25, 0.5], [0.5, 0.5], [1.0, 0.0], [0.0, 0.5], [0.1, 0.2], [0.3, 0.9]];
    let bytes: Vec<u8> = (0..48).collect();
    let not_a_number: Vec<u8> = (0..6u32).flat_map(|i| (0x7fc0_0000 + i).to_le_bytes()).collect();
    for (semantic, accessor) in [
        ("TEXCOORD_1", builder.vectors(&second_uvs)),
        (
            "COLOR_0",
            builder.accessor(&bytes[..18], 6, 5121, "VEC3", json!({"normalized": true, "name": "tint"})),
        ),
        ("JOINTS_0", builder.accessor(&bytes[..24], 6, 5121, "VEC4", json!({}))),
        ("WEIGHTS_0", builder.accessor(&bytes, 6, 5123, "VEC4", json!({"normalized": true}))),
        ("_FEATURE_ID_0", builder.accessor(&bytes[..12], 6, 5123, "SCALAR", json!({}))),
        ("_ODD", builder.accessor(&not_a_number, 6, 5126, "SCALAR", json!({}))),
    ] {
        attributes[semantic] = accessor.into();
    }
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    let before = reread(&document);

    let summary = run(&mut document);

    let after = reread(&document);
    let written = written(&summary, 0);
    assert_eq!((written.vertices_before, written.vertices_after, written.counts.split_vertices), (6, 8, 2));
    assert_eq!(after.corner_tangents(0, 0), vertices.expected(&wide(&BOTH)));
    let (old, new) = (before.primitive(0, 0), after.primitive(0, 0));
    for (semantic, accessor) in old.attributes() {
        let extended = new.get(&semantic).unwrap();
        assert_eq!(extended.data_type(), accessor.data_type(), "{semantic:?}");
        assert_eq!(extended.normalized(), accessor.normalized(), "{semantic:?}");
        assert_eq!(extended.name(), accessor.name(), "{semantic:?}");
        let (elements, source) = (after.elements(&extended), before.elements(&accessor));
        assert_eq!(elements[..6], source, "{semantic:?}: old vertices keep their place");
        let corners = after.indices(0, 0).into_iter().zip(BOTH);
        for (vertex, source_vertex) in corners {
            assert_eq!(elements[vertex as usize], source[usize::from(source_vertex)], "{semantic:?}");
        }
    }
    let positions = |primitive: &gltf::Primitive<'_>| {
        let accessor = primitive.get(&Semantic::Positions).unwrap();
        (accessor.min(), accessor.max())
    };
    assert_eq!(positions(&new), positions(&old));
}

#[test]
fn indices_widen_when_a_split_needs_it() {
    // 254 vertices; indices of 8 bits can name one more.
    let mut vertices = butterfly();
    vertices.positions.resize(254, [5.0; 3]);
    vertices.normals.resize(254, [0.0, 1.0, 0.0]);
    vertices.uvs.resize(254, [0.0; 2]);
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.accessor(&BOTH.map(|index| index as u8), 12, 5121, "SCALAR", json!({}));
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    run(&mut document);
    let after = reread(&document);
    assert_eq!(after.primitive(0, 0).indices().unwrap().data_type(), gltf::accessor::DataType::U16);
    assert_eq!(after.corner_tangents(0, 0), vertices.expected(&wide(&BOTH)));
}

#[test]
fn tangents_of_unused_vertices_are_valid() {
    let mut vertices = square();
    vertices.positions.push([f32::NAN; 3]);
    vertices.normals.push([0.0; 3]);
    vertices.uvs.push([0.0; 2]);
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.indices(&SQUARE);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    run(&mut document);
    for [x, y, z, w] in reread(&document).tangents(0, 0) {
        assert_eq!((x * x + y * y + z * z, w.abs()), (1.0, 1.0));
    }
}

/// A zigzag strip of two squares: with one upright texture, or with a mirrored texture from the middle on.
fn ribbon(mirrored: bool) -> Vertices {
    let positions: Vec<_> =
        [0.0, 1.0, 2.0].iter().flat_map(|&x: &f32| [[x, 1.0, 0.0], [x, 0.0, 0.0]]).collect();
    let u = |x: f32| if mirrored && x > 1.0 { 2.0 - x } else { x };
    let uvs = positions.iter().map(|p: &[f32; 3]| [u(p[0]), 1.0 - p[1]]).collect();
    Vertices { normals: vec![[0.0, 0.0, 1.0]; 6], positions, uvs }
}

#[test]
fn strips_keep_their_mode_unless_they_split() {
    let triangles = [0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4];
    for (mirrored, indexed) in [(false, false), (false, true), (true, false), (true, true)] {
        let vertices = ribbon(mirrored);
        let mut builder = Builder::new();
        let attributes = vertices.attributes(&mut builder);
        let mut primitive = json!({"attributes": attributes, "mode": 5});
        if indexed {
            primitive["indices"] = builder.indices(&[0, 1, 2, 3, 4, 5]).into();
        }
        builder.mesh(&[primitive]);
        let mut document = builder.build();
        run(&mut document);
        let after = reread(&document);
        let primitive = after.primitive(0, 0);
        if mirrored {
            assert_eq!(primitive.mode(), Topology::Triangles);
            assert_eq!(after.corner_tangents(0, 0), vertices.expected(&triangles));
            let reader = after.reader(&primitive);
            let positions: Vec<_> = reader.read_positions().unwrap().collect();
            let corners = after.indices(0, 0).into_iter().zip(triangles);
            assert!(corners.into_iter().all(|(new, old)| positions[new as usize] == positions[old as usize]));
        } else {
            assert_eq!(primitive.mode(), Topology::TriangleStrip);
            assert_eq!(primitive.indices().is_some(), indexed);
            assert_eq!(after.tangents(0, 0), [[1.0, 0.0, 0.0, 1.0]; 6]);
        }
    }
}

#[test]
fn fans_that_split_become_triangles() {
    let vertices = butterfly();
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.indices(&[1, 2, 5, 4, 3, 0]);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "mode": 6})]);
    let mut document = builder.build();
    let summary = run(&mut document);
    assert_eq!(written(&summary, 0).vertices_after, 8);
    let after = reread(&document);
    assert_eq!(after.primitive(0, 0).mode(), Topology::Triangles);
    let triangles = [2, 5, 1, 5, 4, 1, 4, 3, 1, 3, 0, 1];
    assert_eq!(after.corner_tangents(0, 0), vertices.expected(&triangles));
}

#[test]
fn indices_that_make_no_triangle_stay() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let list: Vec<_> = BOTH.into_iter().chain([4, 5]).collect();
    let indices = builder.indices(&list);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    let summary = run(&mut document);
    let after = reread(&document).indices(0, 0);
    assert_eq!((after.len(), &after[12..]), (14, [4, 5].as_slice()));
    let [warning] = summary.warnings.as_slice() else { panic!("{:?}", summary.warnings) };
    assert!(warning.contains("last 2 of 14 corners"), "{warning}");
}

#[test]
fn quantised_vertices_are_read_as_their_values() {
    let vertices = butterfly();
    let mut builder = Builder::new();
    let positions: Vec<u8> = vertices.positions.iter().flatten().map(|&x| x as i8 as u8).collect();
    let normals: Vec<u8> = vertices.normals.iter().flatten().map(|&x| (x * 127.0) as i8 as u8).collect();
    let uvs: Vec<u8> = vertices.uvs.iter().flatten().map(|&x| (x * 255.0) as u8).collect();
    let attributes = json!({
        "POSITION": builder.accessor(&positions, 6, 5120, "VEC3", json!({"min": [-1, 0, 0], "max": [1, 1, 0]})),
        "NORMAL": builder.accessor(&normals, 6, 5120, "VEC3", json!({"normalized": true})),
        "TEXCOORD_0": builder.accessor(&uvs, 6, 5121, "VEC2", json!({"normalized": true})),
    });
    builder.set("extensionsUsed", json!(["KHR_mesh_quantization"]));
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let mut document = builder.build();
    run(&mut document);
    let expected = vertices.expected(&wide(&BOTH));
    let tangents = document.meshes()[0].primitives[0].attributes["TANGENT"];
    let indices = document.indices(document.meshes()[0].primitives[0].indices.unwrap()).unwrap().into_u32();
    let tangents = document.vectors::<4>(tangents).unwrap().into_owned();
    assert!(indices.iter().zip(&expected).all(|(&vertex, expected)| tangents[vertex as usize] == *expected));
}

#[test]
fn extensions_that_refer_to_split_vertices_are_a_warning() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    let outline = json!({"CESIUM_primitive_outline": {"indices": indices}});
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "extensions": outline})]);
    let summary = run(&mut builder.build());
    assert!(summary.warnings[0].contains("CESIUM_primitive_outline"), "{:?}", summary.warnings);
}
