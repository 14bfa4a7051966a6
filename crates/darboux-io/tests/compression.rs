//! Compressed documents: decoded faithfully, written plain; broken streams get one sentence.

use std::path::Path;

use darboux_io::gltf::{Document, LoadOptions, TangentsOptions, add_tangents};

const MODELS: [(&str, &str); 2] =
    [("draco.glb", "KHR_draco_mesh_compression"), ("meshopt.glb", "EXT_meshopt_compression")];

fn bytes_of(model: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/made").join(model);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn read(bytes: Vec<u8>) -> Result<Document, darboux_io::Error> {
    Document::from_bytes("model", bytes, None, &LoadOptions::default())
}

fn contains(bytes: &[u8], word: &str) -> bool {
    bytes.windows(word.len()).any(|window| window == word.as_bytes())
}

/// The corners of every primitive, attribute by attribute, as values.
fn corners(document: &Document) -> Vec<Vec<[f32; 3]>> {
    let mut corners = Vec::new();
    for primitive in document.meshes().iter().flat_map(|mesh| &mesh.primitives) {
        let indices = document.read_indices(primitive.indices.expect("indexed")).expect("indices");
        for semantic in ["POSITION", "NORMAL"] {
            let values = document.read_vectors::<3>(primitive.attributes[semantic]).expect("values");
            corners.push(indices.iter().map(|&index| values[index as usize]).collect());
        }
    }
    corners
}

#[test]
fn what_is_written_is_plain_and_reads_the_same() {
    for (model, extension) in MODELS {
        let original = bytes_of(model);
        assert!(contains(&original, extension));
        let mut document = read(original).expect("a model");
        document.decompress().expect("decodable");
        let decoded = corners(&document);
        add_tangents(&mut document, &TangentsOptions::default(), &mut |_| {}).expect("tangents");
        let written = document.to_glb().expect("a GLB");
        assert!(!contains(&written, extension), "{model}");
        let again = read(written).expect("what was written");
        assert!(!again.is_compressed());
        assert_eq!(corners(&again), decoded, "{model}");
    }
}

#[test]
fn a_document_without_edits_stays_compressed_and_equal() {
    for (model, _) in MODELS {
        let original = bytes_of(model);
        let mut document = read(original.clone()).expect("a model");
        let options = TangentsOptions { only_needed: true, ..TangentsOptions::default() };
        // Both models need tangents; a document that is only read does not change.
        assert_eq!(document.to_glb().expect("a GLB"), original, "{model}");
        add_tangents(&mut document, &options, &mut |_| {}).expect("tangents");
        assert!(document.is_changed(), "{model}");
    }
}

/// Every byte of the binary chunk flipped in turn, and every truncation of a compressed view: an error in one sentence, or a mesh.
#[test]
fn broken_streams_do_not_break_the_reader() {
    // The decoder's own panics are caught where it is called; their messages are not for this test's output.
    std::panic::set_hook(Box::new(|_| {}));
    for (model, _) in MODELS {
        let original = bytes_of(model);
        let json = u32::from_le_bytes(original[12..16].try_into().expect("four bytes")) as usize;
        let mut refused = 0;
        for place in (28 + json..original.len()).step_by(3) {
            let mut broken = original.clone();
            broken[place] ^= 0x55;
            let Ok(mut document) = read(broken) else { continue };
            if let Err(error) = add_tangents(&mut document, &TangentsOptions::default(), &mut |_| {}) {
                let sentence = error.to_string();
                assert!(sentence.starts_with("model: ") && !sentence.contains('\n'), "{sentence}");
                refused += 1;
            }
        }
        assert!(refused > 10, "{model}: {refused}");
    }
}
