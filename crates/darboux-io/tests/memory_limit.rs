//! Small files that ask for much memory are refused before it is allocated, by a sentence that names the
//! option.

mod support;

use darboux_io::gltf::{AddNormalsOptions, Document, add_normals};
use darboux_io::image::PngImage;
use darboux_io::{Error, LoadOptions, MemoryLimit};
use serde_json::json;
use support::glb;

const ADVICE: &str = "; if you trust the file, raise the limit (LoadOptions::memory_limit)";

/// The error must name the limit and the option.
#[track_caller]
fn refused<T>(result: Result<T, Error>, limit: &str) {
    let Err(error) = result else { panic!("accepted, instead of a limit of {limit}") };
    let text = error.to_string();
    assert!(
        text.contains(&format!("more than the memory limit of {limit}")) && text.ends_with(ADVICE),
        "{text}"
    );
}

/// A PNG of RGBA texels with 16 bits per channel that are all zero: compressed to a thousandth.
fn flat_png(side: u32) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, side, side);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Sixteen);
    let texels = vec![0; side as usize * side as usize * 8];
    encoder.write_header().unwrap().write_image_data(&texels).unwrap();
    file
}

#[test]
fn png_bombs_are_refused() {
    let file = flat_png(1024);
    assert!(file.len() < 50_000, "{}", file.len());
    let read = |limit| {
        let options = LoadOptions::default().with_memory_limit(limit);
        PngImage::from_bytes("flat.png", file.clone(), &options)
    };
    refused(read(MemoryLimit::bytes(16 << 20)), "16 MiB");
    assert!(read(MemoryLimit::default()).is_ok());
}

#[test]
fn lists_of_tiny_primitives_are_refused() {
    let text = |count: usize| {
        let primitives = vec![r#"{"attributes":{}}"#; count].join(",");
        format!(r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{primitives}]}}]}}"#)
    };
    let read = |count, memory_limit| {
        let options = LoadOptions::default().with_memory_limit(memory_limit);
        Document::from_bytes("many.gltf", text(count).into_bytes(), None, &options)
    };
    refused(read(100_000, MemoryLimit::default()), "366 MiB");
    assert!(read(50_000, MemoryLimit::default()).is_ok());
    refused(read(1000, MemoryLimit::bytes(1 << 20)), "1 MiB");
}

#[test]
fn overlapping_strips_are_refused() {
    let strip = 100_000;
    let data = vec![0u8; 4 * strip];
    let primitives: Vec<_> =
        (0..1000).map(|_| json!({"attributes": {"POSITION": 0}, "indices": 1, "mode": 5})).collect();
    let json = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": data.len()}],
        "bufferViews": [{"buffer": 0, "byteLength": data.len()}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 0, "componentType": 5125, "count": strip, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": primitives}],
    });
    let mut document =
        Document::from_bytes("strips.glb", glb(&json.to_string(), &data), None, &LoadOptions::default())
            .unwrap();
    refused(add_normals(&mut document, &AddNormalsOptions::default(), &mut |_| {}), "284 MiB");
}

/// Every view names the same stream, so that the file decodes to any size.
#[test]
fn views_over_one_stream_are_refused() {
    use base64::Engine;

    let zeros = vec![[0u8; 16]; 1 << 20];
    let stream = meshopt::encode_vertex_buffer(&zeros).unwrap();
    let length = 16 * zeros.len();
    let view = |i: usize| {
        let compressed = json!({
            "buffer": 0, "byteLength": stream.len(), "byteStride": 16, "count": zeros.len(), "mode": "ATTRIBUTES",
        });
        json!({
            "buffer": 1, "byteOffset": i * length, "byteLength": length,
            "extensions": {"EXT_meshopt_compression": compressed},
        })
    };
    let read = |count: usize| {
        let views: Vec<_> = (0..count).map(view).collect();
        let uri = base64::engine::general_purpose::STANDARD.encode(&stream);
        let json = json!({
            "asset": {"version": "2.0"},
            "buffers": [
                {"byteLength": stream.len(), "uri": format!("data:application/octet-stream;base64,{uri}")},
                {"byteLength": count * length},
            ],
            "bufferViews": views,
        });
        let text = json.to_string().into_bytes();
        Document::from_bytes("views.gltf", text, None, &LoadOptions::default())
    };
    assert!(read(2).is_ok());
    refused(read(30), "259 MiB");
}

#[test]
#[cfg(feature = "obj")]
fn objs_of_many_objects_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.obj");
    let objects: String = (0..1000).map(|i| format!("o {i}\nf 1 1 1\n")).collect();
    std::fs::write(&path, format!("v 0 0 0\n{objects}")).unwrap();
    let read = |limit| Document::open(&path, &LoadOptions::default().with_memory_limit(limit));
    assert!(read(MemoryLimit::default()).is_ok());
    refused(read(MemoryLimit::bytes(1 << 20)), "1 MiB");
}
