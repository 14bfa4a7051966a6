//! Adding tangents to documents: selection of primitives and UVs, splitting of vertices, data that is kept.

mod support;

use darboux::{Context, Mesh, MikkTSpaceOptions, Mode, TangentOptions, generate_tangents_with};
use darboux_io::LoadOptions;
use darboux_io::gltf::{
    AddTangentsOptions, Document, Generate, Progress, add_tangents, add_tangents_with, inspect,
};
use gltf::Semantic;
use gltf::mesh::Mode as Topology;
use serde_json::json;
use support::*;

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

#[test]
fn the_uv_set_is_the_one_that_the_texture_names() {
    let transform = json!({"KHR_texture_transform": {"texCoord": 3}});
    let clearcoat =
        json!({"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0, "texCoord": 2}}});
    let anisotropy = json!({"KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0, "texCoord": 1}}});
    let both = json!({
        "KHR_materials_clearcoat": clearcoat["KHR_materials_clearcoat"],
        "KHR_materials_anisotropy": anisotropy["KHR_materials_anisotropy"],
    });
    let bare = json!({"KHR_materials_anisotropy": {"anisotropyStrength": 1.0}});
    let cases = [
        (json!({}), 0, "no texture with tangents names a set", false),
        (json!({"normalTexture": {"index": 0}}), 0, "normalTexture of materials[1]", true),
        (json!({"normalTexture": {"index": 0, "texCoord": 1}}), 1, "normalTexture of materials[2]", true),
        (
            json!({"normalTexture": {"index": 0, "texCoord": 1, "extensions": transform}, "extensions": both}),
            3,
            "normalTexture of materials[3]",
            true,
        ),
        (json!({"extensions": both}), 2, "clearcoatNormalTexture of materials[4]", true),
        (json!({"extensions": anisotropy}), 1, "anisotropyTexture of materials[5]", true),
        (json!({"extensions": bare}), 0, "no texture with tangents names a set", true),
    ];
    let mut builder = Builder::new();
    let mut attributes = square().attributes(&mut builder);
    for set in 1..4 {
        attributes[format!("TEXCOORD_{set}")] = attributes["TEXCOORD_0"].clone();
    }
    let primitives: Vec<_> = cases
        .iter()
        .map(|(material, ..)| {
            let material = builder.material(material.clone());
            json!({"attributes": attributes, "indices": 3, "material": material})
        })
        .collect();
    builder.indices(&SQUARE);
    builder.mesh(&primitives);
    let infos = inspect(&builder.build()).unwrap();
    for (info, (_, set, reason, needed)) in infos.iter().zip(&cases) {
        assert_eq!((info.uv_set, info.uv_reason.as_str(), info.needs_tangents), (*set, *reason, *needed));
    }
}

#[test]
fn tangents_follow_the_set_that_is_named() {
    let mut builder = Builder::new();
    let mut vertices = square();
    let mut attributes = vertices.attributes(&mut builder);
    vertices.uvs = vertices.uvs.iter().map(|&[u, v]| [v, u]).collect();
    attributes["TEXCOORD_1"] = builder.vectors(&vertices.uvs).into();
    let material = builder.material(json!({"normalTexture": {"index": 0, "texCoord": 1}}));
    let indices = builder.indices(&SQUARE);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "material": material})]);
    let mut document = builder.build();
    run(&mut document);
    let expected = vertices.expected(&wide(&SQUARE));
    assert_eq!(expected[0], [0.0, -1.0, 0.0, -1.0]);
    assert_eq!(reread(&document).corner_tangents(0, 0), expected);
}

#[test]
fn primitives_without_tangents_are_listed_with_a_reason() {
    let mut builder = Builder::new();
    let attributes = square().attributes(&mut builder);
    let without = |semantic: &str| {
        let mut fewer = attributes.clone();
        fewer.as_object_mut().unwrap().remove(semantic);
        fewer
    };
    let material = builder.material(json!({"normalTexture": {"index": 0, "texCoord": 1}}));
    let primitives = [
        json!({"attributes": attributes, "mode": 0}),
        json!({"attributes": attributes, "mode": 3}),
        json!({"attributes": without("POSITION")}),
        json!({"attributes": without("NORMAL")}),
        json!({"attributes": without("TEXCOORD_0")}),
        json!({"attributes": {"POSITION": attributes["POSITION"]}}),
        json!({"attributes": attributes, "material": material}),
        json!({"attributes": attributes, "indices": builder.indices(&[0, 1])}),
    ];
    builder.mesh(&primitives);
    let mut document = builder.build();
    let summary = run(&mut document);
    assert!(!document.is_changed());
    assert_eq!((summary.totals.skipped, summary.totals.without_normals), (8, 1));
    let reasons = [
        "its mode is POINTS; only triangles have tangents",
        "its mode is LINE_STRIP; only triangles have tangents",
        "it has no POSITION, which tangents need",
        "it has no NORMAL, which tangents need",
        "it has no TEXCOORD_0, which tangents need",
        // Normals alone would not help.
        "it has no TEXCOORD_0, which tangents need",
        "it has no TEXCOORD_1, which its tangents must follow (normalTexture of materials[0])",
        "it has no complete triangle",
    ];
    for (place, expected) in reasons.into_iter().enumerate() {
        assert_eq!(reason(&summary, place), expected);
    }
}

#[test]
fn tangents_that_exist_are_kept_unless_overwritten() {
    let build = || {
        let mut builder = Builder::new();
        let mut attributes = square().attributes(&mut builder);
        attributes["TANGENT"] = builder.vectors(&[[0.0, 1.0, 0.0, -1.0]; 4]).into();
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        builder.build()
    };
    let mut kept = build();
    let summary = run(&mut kept);
    assert!(!kept.is_changed());
    assert_eq!(reason(&summary, 0), "it has tangents already");

    let mut replaced = build();
    let summary = run_with(&mut replaced, &AddTangentsOptions::default().with_overwrite(true));
    assert!(written(&summary, 0).replaced);
    assert_eq!(reread(&replaced).tangents(0, 0), [[1.0, 0.0, 0.0, 1.0]; 4]);
}

#[test]
fn only_needed_leaves_out_materials_without_normal_maps() {
    let mut builder = Builder::new();
    let attributes = square().attributes(&mut builder);
    let plain = builder.material(json!({}));
    let mapped = builder.material(json!({"normalTexture": {"index": 0}}));
    let variants = json!({"KHR_materials_variants": {"mappings": [{"material": mapped, "variants": [0]}]}});
    builder.mesh(&[
        json!({"attributes": attributes}),
        json!({"attributes": attributes, "material": plain}),
        json!({"attributes": attributes, "material": mapped}),
        json!({"attributes": attributes, "material": plain, "extensions": variants}),
    ]);
    let mut document = builder.build();
    let summary = run_with(&mut document, &AddTangentsOptions::default().with_only_needed(true));
    assert_eq!((summary.totals.written, summary.totals.skipped), (2, 2));
    assert_eq!(reason(&summary, 0), "its material does not use tangents");
    assert_eq!(reason(&summary, 1), "its material does not use tangents");
}

#[test]
fn variants_that_want_other_uvs_are_named() {
    let mut builder = Builder::new();
    let mut attributes = square().attributes(&mut builder);
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"].clone();
    let first = builder.material(json!({"normalTexture": {"index": 0}}));
    let other = builder.material(json!({"normalTexture": {"index": 0, "texCoord": 1}}));
    let variants = json!({"KHR_materials_variants": {"mappings": [{"material": other, "variants": [0]}]}});
    let indices = builder.indices(&SQUARE);
    let primitive =
        json!({"attributes": attributes, "indices": indices, "material": first, "extensions": variants});
    builder.mesh(&[primitive]);
    let summary = run(&mut builder.build());
    assert_eq!(written(&summary, 0).uv_set, Some(0));
    let [warning] = summary.warnings.as_slice() else { panic!("{:?}", summary.warnings) };
    assert!(warning.starts_with("meshes[0].primitives[0]: the tangents follow TEXCOORD_0"), "{warning}");
}

#[test]
fn texture_transforms_are_applied_only_when_asked_for() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let build = |transform: serde_json::Value| {
        let mut builder = Builder::new();
        let attributes = square().attributes(&mut builder);
        let extensions = json!({"KHR_texture_transform": transform});
        let material = builder.material(json!({"normalTexture": {"index": 0, "extensions": extensions}}));
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices, "material": material})]);
        builder.build()
    };
    let tangent = |transform: serde_json::Value, apply: bool| {
        let mut document = build(transform);
        let options = AddTangentsOptions::default().with_apply_texture_transform(apply);
        let warnings = run_with(&mut document, &options).warnings.len();
        let [x, y, z, w] = reread(&document).tangents(0, 0)[0];
        ([x.round(), y.round(), z.round(), w], warnings)
    };
    let stored = [1.0, 0.0, 0.0, 1.0];
    for (transform, turned, warnings) in [
        // u' = u cos + v sin with v down: u' grows downwards after a quarter turn.
        (json!({"rotation": quarter}), [0.0, -1.0, 0.0, 1.0], 1),
        (json!({"scale": [1, -1], "offset": [0, 1]}), [1.0, 0.0, 0.0, -1.0], 1),
        (json!({"scale": [-1, -1]}), [-1.0, 0.0, 0.0, 1.0], 1),
        // Scaled first, then rotated.
        (json!({"rotation": quarter, "scale": [1, -1]}), [0.0, 1.0, 0.0, -1.0], 1),
        (json!({"scale": [2, 3], "offset": [0.5, 0.5]}), stored, 0),
    ] {
        assert_eq!(tangent(transform.clone(), false), (stored, warnings), "{transform}");
        assert_eq!(tangent(transform.clone(), true), (turned, 0), "{transform}");
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
fn strict_refuses_data_that_the_default_repairs() {
    let strict = AddTangentsOptions::default().with_strict(true);
    let build = |vertices: &Vertices| {
        let mut builder = Builder::new();
        let attributes = vertices.attributes(&mut builder);
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        builder.build()
    };
    let error = |vertices: &Vertices| {
        run(&mut build(vertices));
        add_tangents(&mut build(vertices), &strict, &mut |_| {}).err().map(|error| error.to_string())
    };
    assert_eq!(error(&square()), None);
    let mut infinite = square();
    infinite.uvs[1] = [f32::INFINITY, 0.0];
    let sentence = "test.gltf: meshes[0].primitives[0]: 1 corners have a position, normal or UV that is not finite; \
                    repair the model, or run without strict";
    assert_eq!(error(&infinite).as_deref(), Some(sentence));
    let mut collapsed = square();
    collapsed.normals = vec![[1.0, 0.0, 0.0]; 4];
    collapsed.uvs = vec![[0.5, 0.5]; 4];
    assert!(error(&collapsed).unwrap().contains("no usable tangent"));
}

/// Of primitives that get no tangents, too.
#[test]
fn strict_refuses_data_of_skipped_primitives() {
    let strict = AddTangentsOptions::default().with_strict(true);
    let error = |change: &dyn Fn(&mut Vertices)| {
        let mut vertices = square();
        change(&mut vertices);
        let mut builder = Builder::new();
        let mut attributes = json!(vertices.attributes(&mut builder));
        attributes.as_object_mut().unwrap().remove("NORMAL");
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        let mut document = builder.build();
        add_tangents(&mut document, &strict, &mut |_| {}).err().map(|error| error.to_string())
    };
    assert_eq!(error(&|_| {}), None);
    let sentence = "test.gltf: meshes[0].primitives[0]: has 1 value that is not finite in TEXCOORD_0; \
                    repair the model, or run without strict";
    assert_eq!(error(&|vertices| vertices.uvs[1] = [f32::NAN, 0.0]).as_deref(), Some(sentence));
    assert!(error(&|vertices| vertices.positions[0][2] = f32::INFINITY).is_some());
}

#[test]
fn unusable_tangents_of_the_reference_are_named() {
    let mut vertices = square();
    vertices.normals = vec![[1.0, 0.0, 0.0]; 4];
    vertices.uvs = vec![[0.5, 0.5]; 4];
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.indices(&SQUARE);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let tangents = TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Reference));
    let summary = run_with(&mut builder.build(), &AddTangentsOptions::default().with_tangents(tangents));
    assert!(summary.warnings[0].contains("unusable tangent"), "{:?}", summary.warnings);
}

#[test]
fn broken_primitives_are_errors_that_name_them() {
    let error = |change: fn(&mut Builder, &mut serde_json::Value)| {
        let mut builder = Builder::new();
        let attributes = square().attributes(&mut builder);
        let mut primitive = json!({"attributes": attributes, "indices": builder.indices(&SQUARE)});
        change(&mut builder, &mut primitive);
        builder.mesh(&[primitive]);
        let result = builder.read(&LoadOptions::default()).and_then(|mut document| {
            add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {})
        });
        result.unwrap_err().to_string()
    };
    let out_of_range = error(|builder, primitive| primitive["indices"] = builder.indices(&[0, 1, 4]).into());
    assert!(
        out_of_range.starts_with("test.gltf: meshes[0].primitives[0]: index 4 at place 2"),
        "{out_of_range}"
    );
    let short = error(|builder, primitive| {
        primitive["attributes"]["NORMAL"] = builder.vectors(&[[0.0, 0.0, 1.0]; 3]).into();
    });
    assert!(
        short.starts_with("test.gltf: meshes[0].primitives[0].attributes.NORMAL: has 3 elements"),
        "{short}"
    );
    let missing = error(|_, primitive| primitive["indices"] = 99.into());
    let sentence = "test.gltf: meshes[0].primitives[0].indices: accessor 99 does not exist: there are 4";
    assert!(missing.starts_with(sentence), "{missing}");
    let material = error(|_, primitive| primitive["material"] = 7.into());
    assert!(
        material.contains("primitives[0].material: material 7 does not exist: there are 0"),
        "{material}"
    );
    let mode = error(|_, primitive| primitive["mode"] = 9.into());
    assert!(mode.starts_with("test.gltf: meshes[0].primitives[0].mode: 9 is not a mode"), "{mode}");
    let wrong = error(|_, primitive| {
        primitive["attributes"]["TEXCOORD_0"] = primitive["attributes"]["NORMAL"].clone()
    });
    assert!(wrong.contains("accessors[1].type"), "{wrong}");
}

#[test]
fn attributes_of_another_length_are_errors() {
    let mut builder = Builder::new();
    let mut attributes = butterfly().attributes(&mut builder);
    attributes["COLOR_0"] = builder.vectors(&[[1.0; 3]; 5]).into();
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let error = builder.read(&LoadOptions::default()).unwrap_err();
    let sentence =
        "test.gltf: meshes[0].primitives[0].attributes.COLOR_0: has 5 elements but there are 6 positions";
    assert!(error.to_string().starts_with(sentence), "{error}");
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

#[test]
fn progress_counts_the_triangles_of_every_job() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let (left, both) = (builder.indices(&LEFT), builder.indices(&BOTH));
    builder.mesh(&[
        json!({"attributes": attributes, "indices": left}),
        json!({"attributes": attributes, "indices": both}),
        json!({"attributes": attributes, "indices": left}),
    ]);
    let mut steps = Vec::new();
    add_tangents(&mut builder.build(), &AddTangentsOptions::default(), &mut |step| steps.push(step)).unwrap();
    assert_eq!(steps, [Progress { done: 2, total: 6 }, Progress { done: 6, total: 6 }]);
}

#[test]
fn inspect_counts_without_changing_anything() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let (left, both) = (builder.indices(&LEFT), builder.indices(&BOTH));
    builder.mesh(&[
        json!({"attributes": attributes, "indices": both}),
        json!({"attributes": attributes, "indices": left}),
        json!({"attributes": attributes, "mode": 1}),
    ]);
    let document = builder.build();
    let infos = inspect(&document).unwrap();
    assert!(!document.is_changed());
    let [all, left, lines] = infos.as_slice() else { panic!("{infos:?}") };
    assert_eq!((all.vertices, all.counts.triangles, all.mode), (6, 4, "TRIANGLES"));
    assert_eq!((all.mirrored_triangles, all.counts.mirrored_edges, all.counts.split_vertices), (2, 1, 2));
    assert_eq!((left.mirrored_triangles, left.counts.split_vertices), (2, 0));
    assert_eq!(lines.ineligible.as_deref(), Some("its mode is LINES; only triangles have tangents"));
    assert!(all.ineligible.is_none() && !all.has_tangents && !all.needs_tangents);
    assert_eq!(all.attributes, ["NORMAL", "POSITION", "TEXCOORD_0"]);
}

/// A document of small primitives, a large one, and one with a morph target. `damaged`: primitives with a
/// normal that is not finite.
fn scene(damaged: &[usize]) -> Document {
    let mut builder = Builder::new();
    let large: Vec<u16> = BOTH.iter().copied().cycle().take(12 * 5_000).collect();
    for place in 0..40 {
        let mut vertices = butterfly();
        vertices.positions.iter_mut().for_each(|position| position[2] = position[0] * place as f32);
        vertices.normals[0][0] = if damaged.contains(&place) { f32::NAN } else { 0.0 };
        let attributes = vertices.attributes(&mut builder);
        let indices = builder.indices(if place == 17 { &large } else { &BOTH });
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if place == 23 {
            let offsets = vertices.positions.iter().map(|p| [0.0, p[0] * p[0], 0.0]).collect::<Vec<_>>();
            primitive["targets"] = json!([{"POSITION": builder.vectors(&offsets)}]);
        }
        builder.mesh(&[primitive]);
    }
    builder.build()
}

#[test]
fn small_primitives_on_many_threads_give_the_same_file() {
    let add = |context: &mut Context| {
        let (mut document, mut steps) = (scene(&[]), Vec::new());
        let mut progress = |step: Progress| steps.push(step);
        let options = AddTangentsOptions::default();
        let summary = add_tangents_with(&mut document, &options, context, Generate::OnCpu, &mut progress);
        let summary = summary.expect("valid data");
        assert_eq!(steps.last().map(|step| step.done), Some(39 * 4 + 20_000));
        (document.to_glb().expect("a document can be saved"), format!("{summary:?}"))
    };
    let alone = add(&mut Context::new().with_max_threads(1));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a thread pool");
    assert!(pool.install(|| add(&mut Context::new())) == alone);
    let one_by_one = {
        let (mut document, mut on_cpu) =
            (scene(&[]), |mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context| {
                generate_tangents_with(mesh, options, context).map_err(|error| error.to_string())
            });
        let generate = Generate::With(&mut on_cpu);
        let (options, context) = (AddTangentsOptions::default(), &mut Context::new());
        let summary = add_tangents_with(&mut document, &options, context, generate, &mut |_| {});
        (document.to_glb().expect("a document can be saved"), format!("{:?}", summary.expect("valid data")))
    };
    assert!(one_by_one == alone);
}

#[test]
fn the_first_of_several_faulty_primitives_is_the_error() {
    let error = |context: &mut Context| {
        let options = AddTangentsOptions::default().with_strict(true);
        let mut document = scene(&[30, 9, 12]);
        let added = add_tangents_with(&mut document, &options, context, Generate::OnCpu, &mut |_| {});
        added.expect_err("a normal is not finite").to_string()
    };
    let alone = error(&mut Context::new().with_max_threads(1));
    assert!(alone.contains("meshes[9]"), "{alone}");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a thread pool");
    assert_eq!(pool.install(|| error(&mut Context::new())), alone);
}
