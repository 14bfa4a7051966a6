//! Which primitives get tangents, and which UVs they follow.

use darboux_io::gltf::{AddTangentsOptions, inspect};
use serde_json::json;

use crate::support::*;

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
