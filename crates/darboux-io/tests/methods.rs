//! Methods other than MikkTSpace, and smaller encodings of tangents.

mod support;

use darboux::{Choice, Convention, Mesh, Method, TangentOptions, generate_tangents, measure_tangents};
use darboux_io::gltf::{AddTangentsOptions, TangentEncoding};
use serde_json::json;
use support::{BOTH, Builder, Vertices, butterfly, reason, reread, run_with, wide, written};

fn with_method(method: Method) -> AddTangentsOptions {
    let tangents = TangentOptions::from(method);
    AddTangentsOptions::default().with_tangents(tangents)
}

/// The butterfly, bent so that methods differ.
fn bent() -> Vertices {
    let mut vertices = butterfly();
    vertices.positions[2] = [2.5, 0.2, -0.5];
    vertices.positions[3] = [-1.2, 1.5, 0.7];
    vertices
}

/// The corner tangents of a method, in glTF's convention.
fn tangents(vertices: &Vertices, options: &TangentOptions) -> Vec<[f32; 4]> {
    let indices = wide(&BOTH);
    let mesh =
        Mesh::triangles(&vertices.positions, &vertices.normals, &vertices.uvs, &indices).expect("a mesh");
    let corners = generate_tangents(&mesh, options).corners;
    corners.converted(Convention::GLTF.generated(), Convention::GLTF).into_per_corner()
}

#[test]
fn every_method_is_the_cores() {
    let vertices = bent();
    for &method in Method::ALL {
        let mut builder = Builder::new();
        let attributes = vertices.attributes(&mut builder);
        let indices = builder.indices(&BOTH);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        let mut document = builder.build();
        let options = with_method(method);
        let summary = run_with(&mut document, &options);
        let expected = tangents(&vertices, &options.tangents);
        assert_eq!(reread(&document).corner_tangents(0, 0), expected, "{method:?}");
        let merged = if method == Method::LengyelPerVertex { 2 } else { 0 };
        assert_eq!(written(&summary, 0).counts.merged_vertices, merged, "{method:?}");
        assert_eq!(summary.warnings.len(), usize::from(merged > 0), "{:?}", summary.warnings);
    }
}

#[test]
fn a_frame_from_the_normal_needs_no_uvs() {
    let build = || {
        let mut builder = Builder::new();
        let mut attributes = bent().attributes(&mut builder);
        attributes.as_object_mut().expect("attributes").remove("TEXCOORD_0");
        let indices = builder.indices(&BOTH);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        builder.build()
    };
    let mut document = build();
    let summary = run_with(&mut document, &with_method(Method::FromNormal));
    assert_eq!(written(&summary, 0).uv_set, None);
    assert_eq!(written(&summary, 0).counts.uv_degenerate_triangles, 0);
    assert_eq!(reread(&document).tangents(0, 0).len(), 6);
    let summary = run_with(&mut build(), &with_method(Method::Face));
    assert_eq!(reason(&summary, 0), "it has no TEXCOORD_0, which tangents need");
}

#[test]
fn morph_targets_follow_the_method_of_the_base() {
    let vertices = butterfly();
    let mut moved = vertices.clone();
    moved.positions[5] = [1.5, 1.0, 1.0];
    let offsets = [[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [0.5, 0.0, 1.0]];
    let mut builder = Builder::new();
    let (attributes, indices) = (vertices.attributes(&mut builder), builder.indices(&BOTH));
    let target = builder.vectors(&offsets);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices, "targets": [{"POSITION": target}]})]);
    let mut document = builder.build();
    let options = with_method(Method::Lengyel);
    run_with(&mut document, &options);
    let accessor = document.meshes()[0].primitives[0].targets[0]["TANGENT"];
    let offsets = document.vectors::<3>(accessor).expect("offsets").into_owned();
    let [base, moved] = [&vertices, &moved].map(|vertices| tangents(vertices, &options.tangents));
    let of_corner = reread(&document).indices(0, 0);
    for (corner, &vertex) in of_corner.iter().enumerate() {
        let expected: [f32; 3] = std::array::from_fn(|i| moved[corner][i] - base[corner][i]);
        assert_eq!(offsets[vertex as usize], expected, "corner {corner}");
    }
}

#[test]
fn integer_encodings_keep_their_error_bounds_and_declare_their_extension() {
    let vertices = bent();
    let exact = tangents(&vertices, &TangentOptions::default());
    let cases = [(TangentEncoding::Snorm16x4, 5122, 0.0016f64), (TangentEncoding::Snorm8x4, 5120, 0.40)];
    for (encoding, component, degrees) in cases {
        let mut builder = Builder::new();
        let (attributes, indices) = (vertices.attributes(&mut builder), builder.indices(&BOTH));
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        builder.set("extensionsUsed", json!(["KHR_texture_transform"]));
        let mut document = builder.build();
        run_with(&mut document, &AddTangentsOptions::default().with_encoding(encoding));
        let json: serde_json::Value = {
            let glb = document.to_glb().expect("a GLB");
            let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
            serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
        };
        assert_eq!(json["extensionsUsed"], json!(["KHR_texture_transform", "KHR_mesh_quantization"]));
        assert_eq!(json["extensionsRequired"], json!(["KHR_mesh_quantization"]));
        let primitive = &document.meshes()[0].primitives[0];
        let accessor = primitive.attributes["TANGENT"];
        let written = &json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"];
        let written = &json["accessors"][written.as_u64().expect("a number") as usize];
        assert_eq!(written["componentType"], component);
        assert_eq!(written["normalized"], true);
        let stored = document.vectors::<4>(accessor).expect("tangents").into_owned();
        let corners = document.indices(primitive.indices.expect("indices")).expect("indices").into_u32();
        for (&vertex, exact) in corners.iter().zip(&exact) {
            let stored = stored[vertex as usize];
            assert_eq!(stored[3], exact[3]);
            let worst = measure_tangents(&[stored], &[*exact]).expect("a pair").max;
            assert!(worst <= degrees, "{stored:?} {exact:?}: {worst}");
        }
    }
}
