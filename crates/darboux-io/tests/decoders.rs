//! Decoded values equal those of other decoders, and declared sizes are checked.

use std::path::Path;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

fn open(model: &str) -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/made").join(model);
    Document::open(&path, &LoadOptions::default()).expect("a model")
}

/// FNV-1a, 64 bits.
fn hash(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn attribute<const N: usize>(document: &Document, mesh: usize, primitive: usize, semantic: &str) -> u64 {
    let accessor = document.meshes()[mesh].primitives[primitive].attributes[semantic];
    let values = document.vectors::<N>(accessor).expect("values");
    hash(values.iter().flatten().flat_map(|value| value.to_le_bytes()))
}

fn indices(document: &Document, mesh: usize, primitive: usize) -> u64 {
    let accessor = document.meshes()[mesh].primitives[primitive].indices.expect("indexed");
    hash(document.indices(accessor).expect("indices").into_u32().into_iter().flat_map(u32::to_le_bytes))
}

/// The hashes are of what draco3dgltf 1.5 decodes.
#[test]
fn draco_decodes_as_elsewhere() {
    let document = open("draco.glb");
    assert_eq!(attribute::<3>(&document, 0, 0, "POSITION"), 0xb5c7_902a_b37e_8735);
    assert_eq!(attribute::<3>(&document, 0, 0, "NORMAL"), 0xec6e_da23_58c7_9625);
    assert_eq!(attribute::<2>(&document, 0, 0, "TEXCOORD_0"), 0x41b1_56bc_f96c_54d8);
    assert_eq!(attribute::<2>(&document, 0, 0, "TEXCOORD_1"), 0xff34_6e60_8905_7000);
    assert_eq!(indices(&document, 0, 0), 0x2ff2_af70_aa35_7b1a);
}

/// The hashes are of what meshoptimizer's own JavaScript decodes.
#[test]
fn meshopt_decodes_as_elsewhere() {
    let document = open("meshopt.glb");
    assert_eq!(attribute::<3>(&document, 0, 0, "POSITION"), 0x823c_e190_0a2a_7c04);
    assert_eq!(attribute::<3>(&document, 0, 0, "NORMAL"), 0x2044_d52f_5b56_fbb4);
    assert_eq!(attribute::<2>(&document, 0, 0, "TEXCOORD_0"), 0xb527_a75d_0ce5_c1a5);
    assert_eq!(attribute::<4>(&document, 0, 0, "WEIGHTS_0"), 0x9ec1_e6ce_e219_07a5);
    assert_eq!(indices(&document, 0, 0), 0x8e12_12e4_4644_ba0d);
}

/// Views of four bytes, each as far behind the last as everything before it: a few of them would fill any
/// memory.
#[test]
fn gaps_between_views_do_not_add_up() {
    // Version 0 of the vertex codec, one vertex of zeros: a header, four channels without data, the tail.
    let mut stream = vec![0; 1 + 4 + 32];
    stream[0] = 0xa0;
    let uri = BASE64_STANDARD.encode(&stream);
    let view = |offset: u64| {
        let compressed = r#"{"buffer":0,"byteLength":37,"byteStride":4,"count":1,"mode":"ATTRIBUTES"}"#;
        let extension = format!(r#""extensions":{{"EXT_meshopt_compression":{compressed}}}"#);
        format!(r#"{{"buffer":1,"byteOffset":{offset},"byteLength":4,{extension}}}"#)
    };
    let decode = |offsets: &[u64]| {
        let views: Vec<String> = offsets.iter().map(|&offset| view(offset)).collect();
        let source = format!(r#"{{"byteLength":37,"uri":"data:application/octet-stream;base64,{uri}"}}"#);
        let buffers = format!(r#""buffers":[{source},{{"byteLength":1000000000}}]"#);
        let text =
            format!(r#"{{"asset":{{"version":"2.0"}},{buffers},"bufferViews":[{}]}}"#, views.join(","));
        let document = Document::from_bytes("model", text.into_bytes(), None, &LoadOptions::default());
        document.map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(decode(&[0, 8, 4]), Ok(()));
    let error = decode(&[0, 60 << 20, 120 << 20]).expect_err("gaps");
    assert!(error.starts_with("model: buffers[1]: has larger gaps between"), "{error}");
}
