//! Data that primitives share is computed once, split jointly and written once.

mod support;

use darboux_io::gltf::{AddTangentsOptions, Progress, add_tangents};
use darboux_io::{LoadOptions, MemoryLimit};
use serde_json::{Value, json};
use support::*;

/// The attributes of a primitive, by name.
fn attributes(
    document: &darboux_io::gltf::Document,
    mesh: usize,
    place: usize,
) -> &darboux_io::gltf::schema::Attributes {
    &document.meshes()[mesh].primitives[place].attributes
}

#[test]
fn the_same_accessors_are_computed_and_written_once() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let mut aliased = attributes.clone();
    for (_, accessor) in aliased.as_object_mut().unwrap() {
        *accessor = builder.alias(accessor.as_u64().unwrap() as usize, json!({"name": "alias"})).into();
    }
    let mut coloured = attributes.clone();
    coloured["COLOR_0"] = builder.vectors(&[[1.0; 3]; 6]).into();
    let indices = builder.indices(&BOTH);
    for attributes in [&attributes, &attributes, &aliased, &coloured] {
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    }
    let mut document = builder.build();
    let before = document.accessors().len();
    let mut steps = Vec::new();
    let summary =
        add_tangents(&mut document, &AddTangentsOptions::default(), &mut |step| steps.push(step)).unwrap();

    assert_eq!(steps, [Progress { done: 4, total: 4 }]);
    assert_eq!((summary.totals.written, summary.totals.triangles), (4, 4));
    assert_eq!((summary.totals.vertices_before, summary.totals.vertices_after), (6, 8));
    // Positions, normals, UVs, colours, tangents, indices.
    assert_eq!(document.accessors().len(), before + 6);
    let primitives: Vec<_> = document.meshes().iter().map(|mesh| &mesh.primitives[0]).collect();
    assert!(primitives.iter().all(|p| p.indices == primitives[0].indices));
    assert!(primitives.iter().all(|p| p.attributes["TANGENT"] == primitives[0].attributes["TANGENT"]));
    assert!(primitives[..3].iter().all(|p| p.attributes == primitives[0].attributes));
}

#[test]
fn index_ranges_of_one_buffer_are_split_jointly() {
    let vertices = butterfly();
    let mut builder = Builder::new();
    let shared = vertices.attributes(&mut builder);
    let ranges = [LEFT, RIGHT].map(|range| builder.indices(&range));
    builder.mesh(&ranges.map(|indices| json!({"attributes": shared, "indices": indices})));
    let mut document = builder.build();
    run(&mut document);
    assert_eq!(attributes(&document, 0, 0), attributes(&document, 0, 1));
    // The first range is served by the old vertices and keeps its indices; the second needs the new ones.
    assert_eq!(document.meshes()[0].primitives[0].indices, Some(ranges[0]));
    let after = reread(&document);
    assert_eq!(after.indices(0, 1), [6, 2, 5, 6, 5, 7]);
    assert_eq!(after.corner_tangents(0, 0), vertices.expected(&wide(&LEFT)));
    assert_eq!(after.corner_tangents(0, 1), vertices.expected(&wide(&RIGHT)));
}

#[test]
fn another_uv_set_gets_its_own_copy() {
    let mut vertices = butterfly();
    let mut builder = Builder::new();
    let mut shared = vertices.attributes(&mut builder);
    let stored = vertices.clone();
    vertices.uvs = vertices.positions.iter().map(|p| [p[0], -p[1]]).collect();
    shared["TEXCOORD_1"] = builder.vectors(&vertices.uvs).into();
    let material = builder.material(json!({"normalTexture": {"index": 0, "texCoord": 1}}));
    let indices = builder.indices(&BOTH);
    builder.mesh(&[
        json!({"attributes": shared, "indices": indices}),
        json!({"attributes": shared, "indices": indices, "material": material}),
    ]);
    let mut document = builder.build();
    run(&mut document);
    // The second set is not mirrored: its primitive keeps all old accessors.
    let (first, second) = (attributes(&document, 0, 0), attributes(&document, 0, 1));
    assert_ne!(first["TANGENT"], second["TANGENT"]);
    assert_eq!(json!(second["POSITION"]), shared["POSITION"]);
    assert_ne!(json!(first["POSITION"]), shared["POSITION"]);
    let after = reread(&document);
    assert_eq!(after.corner_tangents(0, 0), stored.expected(&wide(&BOTH)));
    assert_eq!(after.corner_tangents(0, 1), vertices.expected(&wide(&BOTH)));
}

#[test]
fn an_unindexed_primitive_on_a_buffer_that_grows_gains_indices() {
    let mut vertices = butterfly();
    // Unindexed, the six vertices are two triangles over the corners 0 1 2 (flat, so degenerate) and 3 4 5.
    vertices.positions[1][1] = 0.5;
    let mut builder = Builder::new();
    let shared = vertices.attributes(&mut builder);
    let indices = builder.indices(&BOTH);
    builder.mesh(&[
        json!({"attributes": shared}),
        json!({"attributes": shared, "indices": indices}),
        json!({"attributes": shared, "mode": 5}),
        json!({"attributes": shared, "mode": 0}),
    ]);
    let mut document = builder.build();
    run(&mut document);
    let after = reread(&document);
    assert!(after.tangents(0, 0).len() > 6);
    assert_eq!(attributes(&document, 0, 0), attributes(&document, 0, 1));
    let strip = [0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4];
    for (place, corners) in [(0, (0..6).collect()), (1, wide(&BOTH)), (2, strip.to_vec())] {
        assert_eq!(after.primitive(0, place).mode(), gltf::mesh::Mode::Triangles);
        assert!(after.primitive(0, place).indices().is_some());
        assert_eq!(after.corner_tangents(0, place), vertices.expected(&corners), "{place}");
    }
    // Points draw all vertices of a buffer: they keep the old one.
    assert_eq!(json!(attributes(&document, 0, 3)["POSITION"]), shared["POSITION"]);
}

#[test]
fn transforms_of_one_buffer_do_not_mix() {
    let vertices = square();
    let mut builder = Builder::new();
    let shared = vertices.attributes(&mut builder);
    let indices = builder.indices(&SQUARE);
    let primitives: Vec<Value> = [json!({}), json!({"scale": [-1, 1]}), json!({"scale": [1, -1]})]
        .into_iter()
        .map(|transform| {
            let info = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
            let material = builder.material(json!({"normalTexture": info}));
            json!({"attributes": shared, "indices": indices, "material": material})
        })
        .collect();
    builder.mesh(&primitives);
    let mut document = builder.build();
    run_with(&mut document, &AddTangentsOptions::default().with_apply_texture_transform(true));
    let after = reread(&document);
    assert_eq!(after.corner_tangents(0, 0), [[1.0, 0.0, 0.0, 1.0]; 6]);
    assert_eq!(after.corner_tangents(0, 1), [[-1.0, 0.0, 0.0, -1.0]; 6]);
    assert_eq!(after.corner_tangents(0, 2), [[1.0, 0.0, 0.0, -1.0]; 6]);
}

/// A row of `count` butterflies in one vertex buffer, each a primitive of its own.
fn swarm(count: usize) -> (Builder, usize) {
    let wing = butterfly();
    let mut vertices = Vertices { positions: Vec::new(), normals: Vec::new(), uvs: Vec::new() };
    let mut builder = Builder::new();
    let mut ranges = Vec::new();
    for i in 0..count {
        let first = vertices.positions.len() as u16;
        vertices.positions.extend(wing.positions.iter().map(|&[x, y, z]| [x, y, z + i as f32]));
        vertices.normals.extend(&wing.normals);
        vertices.uvs.extend(&wing.uvs);
        ranges.push(builder.indices(&BOTH.map(|index| first + index)));
    }
    let shared = vertices.attributes(&mut builder);
    let primitives: Vec<_> =
        ranges.iter().map(|indices| json!({"attributes": shared, "indices": indices})).collect();
    builder.mesh(&primitives);
    (builder, vertices.positions.len())
}

#[test]
fn a_thousand_primitives_on_one_buffer_stay_linear() {
    let count = 1000;
    let (builder, vertices) = swarm(count);
    let mut document = builder.build();
    let (input, accessors) = (document.to_glb().unwrap().len(), document.accessors().len());
    let summary = run(&mut document);
    assert_eq!(summary.totals.vertices_after, vertices + 2 * count);
    // Positions, normals, UVs and tangents once; indices for each.
    assert_eq!(document.accessors().len(), accessors + 4 + count);
    let output = document.to_glb().unwrap().len();
    assert!(output < 4 * input, "{input} bytes became {output}");
    let first = attributes(&document, 0, 0);
    assert!(document.meshes()[0].primitives.iter().all(|primitive| primitive.attributes == *first));
}

#[test]
fn overlapping_accessors_cannot_make_the_output_explode() {
    let (vertices, copies) = (4000, 400);
    let grid: Vec<_> = (0..vertices).map(|i| [(i % 2) as f32, (i % 3) as f32, i as f32]).collect();
    let build = |uv_steps: usize, index_steps: usize| {
        let mut builder = Builder::new();
        let position = builder.vectors(&grid);
        let normal = builder.vectors(&vec![[0.0, 0.0, 1.0]; vertices]);
        let uv = builder.vectors(&vec![[0.0, 0.0]; vertices + copies]);
        let list: Vec<_> = (0..50_000 + copies).map(|i| (i % vertices) as u16).collect();
        let indices = builder.indices(&list);
        let primitives: Vec<_> = (0..copies)
            .map(|copy| {
                let uv = builder.alias(uv, json!({"count": vertices, "byteOffset": 8 * uv_steps * copy}));
                let count = if index_steps == 0 { 3 } else { 50_000 };
                let indices =
                    builder.alias(indices, json!({"count": count, "byteOffset": 2 * index_steps * copy}));
                let attributes = json!({"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv});
                json!({"attributes": attributes, "indices": indices})
            })
            .collect();
        builder.mesh(&primitives);
        let options = LoadOptions::default().with_memory_limit(MemoryLimit::bytes(16 << 20));
        let mut document = builder.read(&options).unwrap();
        let result = add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {});
        result.map(|summary| summary.totals.written).map_err(|error| error.to_string())
    };
    assert_eq!(build(0, 0), Ok(copies));
    for error in [build(1, 0), build(0, 1)] {
        assert!(error.unwrap_err().contains("more than the memory limit of 16 MiB"));
    }
}
