//! Invalid input gives one sentence with its place, without a panic or much memory.

use std::fs;
use std::path::Path;

use darboux_io::gltf::Document;
use darboux_io::{Error, LoadOptions};
use serde_json::{Value, json};

fn parse(bytes: impl Into<Vec<u8>>) -> Result<Document, Error> {
    Document::from_bytes("x.gltf", bytes.into(), None, &LoadOptions::default())
}

/// The error must be one line that starts with the file and contains `expected`.
#[track_caller]
fn refused<T>(result: Result<T, Error>, expected: &str) {
    let Err(error) = result else { panic!("accepted, instead of {expected:?}") };
    let text = error.to_string();
    assert!(text.contains(expected) && !text.contains('\n'), "{text:?} does not say {expected:?}");
}

fn glb_of(words: &[u32], json: &str) -> Vec<u8> {
    let mut bytes = b"glTF".to_vec();
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    bytes.extend(json.as_bytes());
    bytes
}

#[test]
fn containers() {
    const JSON: u32 = 0x4E4F_534A;
    refused(parse(""), "x.gltf: is empty; export or download it again");
    refused(parse("PK\x03\x04"), "is a zip archive; unpack it and give the model in it");
    refused(parse("glTF, once upon a time"), "begins as a GLB of a version that does not exist");
    refused(parse("glTF\x02\0"), "is cut off within the GLB header");
    refused(parse(glb_of(&[1, 12], "")), "is a GLB of version 1; convert it to glTF 2.0");
    refused(parse(glb_of(&[2, 99], "")), "the GLB header says 99 bytes but there are 12");
    refused(parse(glb_of(&[2, 12], "")), "has no JSON chunk");
    refused(parse(glb_of(&[2, 16, 4], "")), "is cut off within the chunk header at byte 12");
    refused(
        parse(glb_of(&[2, 24, u32::MAX, JSON], "{}  ")),
        "the chunk at byte 12 says 4294967295 bytes but 4 are left",
    );
    refused(parse(glb_of(&[2, 24, 4, 0x004E_4942], "{}  ")), "the first chunk is not JSON");
    let other = "asset.version is missing, so this is not a glTF file; give a .gltf or .glb file";
    refused(parse(glb_of(&[2, 24, 4, JSON], "{}\0\0")), other);
    refused(parse(r#"{"asset": {"generator": "x"}, "meshes": 7}"#), other);
}

#[test]
fn text_of_the_file_cannot_forge_or_flood_a_message() {
    let hostile = format!("\\u001b[2J\\nerror: forged \\u202e{}", "x".repeat(70_000));
    let accessor = format!(r#"{{"componentType":5126,"count":1,"type":"{hostile}"}}"#);
    for json in [
        format!(r#"{{"asset":{{"version":"2.0"}},"accessors":[{accessor}]}}"#),
        format!(r#"{{"asset":{{"version":"{hostile}"}}}}"#),
        format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{{"attributes":{{"{hostile}":"a"}}}}]}}]}}"#
        ),
        format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{{"attributes":{{"{hostile}":7}}}}]}}]}}"#
        ),
    ] {
        let message = parse(json).expect_err("an error").to_string();
        assert!(message.len() < 800, "{} bytes", message.len());
        assert!(!message.contains(['\u{1b}', '\n', '\u{202e}']), "{message:?}");
    }
}

#[test]
fn json_text() {
    refused(parse("{\"asset\":"), "asset: is not JSON: the text ends too early at line 1, column ");
    refused(parse("{\"asset\":{\"version\":\"2.0\"}} trailing"), "is not JSON: more text follows its end");
    refused(parse(b"{\"asset\":\"\xff\"}".as_slice()), "the JSON is not UTF-8");
    refused(
        parse(r#"{"asset":{"version":"1.0"},"meshes":{}}"#),
        "asset.version: is \"1.0\"; convert the file",
    );
    refused(
        parse(r#"{"asset":{"version":"2.0"},"meshes":[],"meshes":[]}"#),
        "an object has the key \"meshes\" twice",
    );
    refused(
        parse(r#"{"asset":{"version":"2.0"},"meshes":[{"primitives":7}]}"#),
        "meshes[0].primitives: is 7; it must be an array; export the file again",
    );
    let nested = |depth: usize| {
        let nested = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        parse(format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extras\":{nested}}}"))
    };
    refused(nested(500_000), "the JSON is nested more than 100 levels deep");
    assert!(nested(90).is_ok());
    let keys: String = (0..1_000_000).map(|i| format!(",\"k{i}\":1")).collect();
    assert!(parse(format!("{{\"asset\":{{\"version\":\"2.0\"}}{keys}}}")).is_ok());
    refused(parse(r#"{"asset":{"version":"2.0"},"extras":1e999}"#), "the number 1e999 is out of range");
    let by_position = r#"{"asset":{"version":"2.0"},"meshes":[["name",[{"attributes":{}}]]]}"#;
    refused(parse(by_position), "meshes[0]: is an array; it must be an object");
}

/// Eight bytes in a buffer, two accessors over it; the second is sparse.
fn good() -> Value {
    json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 8, "uri": "data:;base64,AAABAAIAAwA="}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 4, "type": "SCALAR"},
            {"bufferView": 0, "componentType": 5123, "count": 4, "type": "SCALAR", "sparse": {
                "count": 2,
                "indices": {"bufferView": 0, "componentType": 5121, "byteOffset": 3},
                "values": {"bufferView": 0},
            }},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    })
}

fn read_with(accessor: usize, pointer: &str, value: Value) -> Result<Vec<u32>, Error> {
    let mut json = good();
    let (parent, member) = pointer.rsplit_once('/').unwrap();
    json.pointer_mut(parent).unwrap()[member] = value;
    parse(json.to_string())?.indices(accessor).map(darboux_io::gltf::IndexList::into_u32)
}

#[test]
fn accessors() {
    assert_eq!(read_with(0, "/extras", json!(0)).unwrap(), [0, 1, 2, 3]);
    assert_eq!(read_with(1, "/extras", json!(0)).unwrap(), [0, 1, 1, 3]);

    let view =
        "x.gltf: accessors[0]: 4 elements of 2 bytes from byte 2 on do not fit its buffer view of 8 bytes";
    refused(read_with(0, "/accessors/0/byteOffset", json!(2)), view);
    refused(read_with(0, "/accessors/0/byteOffset", json!(u64::MAX)), "do not fit");
    refused(read_with(0, "/accessors/0/count", json!(5)), "accessors[0]: 5 elements");
    refused(read_with(0, "/accessors/0/count", json!(u64::MAX)), "do not fit");
    refused(
        read_with(0, "/accessors/0/count", json!(-1)),
        "accessors[0].count: is -1; it must be a whole number of 0 or more",
    );
    refused(
        read_with(0, "/accessors/0/count", json!(1.5)),
        "accessors[0].count: is 1.5; it must be a whole number of 0 or more",
    );
    refused(read_with(0, "/accessors/0/componentType", json!(5124)), "5124 is not a component type");
    refused(read_with(0, "/accessors/0/componentType", json!(5126)), "accessors[0]");
    refused(
        read_with(0, "/accessors/0/type", json!("VEC5")),
        "accessors[0].type: is \"VEC5\"; it must be one of SCALAR, VEC2",
    );
    refused(
        read_with(0, "/accessors/0/type", json!("VEC2")),
        "accessors[0]: 4 elements of 4 bytes from byte 0 on do not fit its buffer view of 8 bytes",
    );
    refused(read_with(0, "/accessors/0/bufferView", json!(1)), "buffer view 1 does not exist: there are 1");
    refused(read_with(7, "/extras", json!(0)), "accessors[7]: does not exist: there are 2 accessors");
    refused(read_with(0, "/bufferViews/0/byteStride", json!(1)), "byteStride of 1 is less than");
    refused(read_with(0, "/bufferViews/0/byteStride", json!(u64::MAX)), "do not fit");
    refused(read_with(0, "/bufferViews/0/byteOffset", json!(u64::MAX)), "bufferViews[0]: 8 bytes from byte");
    refused(read_with(0, "/bufferViews/0/byteLength", json!(9)), "do not fit the buffer of 8 bytes");
    refused(
        read_with(0, "/bufferViews/0/buffer", json!(3)),
        "bufferViews[0].buffer: buffer 3 does not exist",
    );
}

#[test]
fn sparse_accessors() {
    let at = |member: &str| format!("/accessors/1/sparse/{member}");
    refused(read_with(1, &at("count"), json!(5)), "sparse.count: 5 is more than the accessor's count of 4");
    refused(
        read_with(1, &at("indices/byteOffset"), json!(0)),
        "sparse.indices: index 0 at place 1 is not greater than the one before",
    );
    refused(read_with(1, &at("indices/byteOffset"), json!(7)), "sparse.indices: 2 elements");
    refused(
        read_with(1, &at("indices/componentType"), json!(5120)),
        "sparse.indices.componentType: is signed",
    );
    refused(read_with(1, &at("indices/bufferView"), json!(1)), "sparse.indices.bufferView: buffer view 1");
    refused(read_with(1, &at("values/byteOffset"), json!(6)), "sparse.values: 2 elements");
    refused(read_with(1, "/accessors/1/count", json!(2)), "not below 2");
}

#[test]
fn accessors_without_bytes_are_limited() {
    let mut json = good();
    json["accessors"][0] = json!({"componentType": 5126, "count": 1u64 << 40, "type": "MAT4"});
    refused(
        parse(json.to_string()).unwrap().elements(0),
        "accessors[0].count: 1099511627776 elements are too many",
    );
    json["accessors"][0]["count"] = json!(1000);
    assert_eq!(parse(json.to_string()).unwrap().elements(0).unwrap().bytes, vec![0; 64_000]);
}

#[test]
fn buffers() {
    refused(
        read_with(0, "/buffers/0/byteLength", json!(9)),
        "buffers[0].byteLength: is 9 but there are 8 bytes",
    );
    refused(
        read_with(0, "/buffers/0/uri", json!("data:;base64,A!")),
        "buffers[0].uri: the data URI is not base64",
    );
    refused(read_with(0, "/buffers/0/uri", json!("data:")), "the data URI has no comma");
    refused(read_with(0, "/buffers/0/uri", json!("file:///etc/passwd")), "uses the scheme \"file\"");
    refused(read_with(0, "/buffers/0/uri", json!("a.bin")), "refers to the file \"a.bin\"");
    refused(
        read_with(0, "/buffers/0/uri", json!("https://example.org/a.bin")),
        "is on another machine; download it",
    );
    refused(read_with(0, "/buffers/0/uri", Value::Null), "buffers[0]: has no bytes");
}

/// Opens a document in `folder` whose buffer of one byte is at `uri`.
fn open_with(folder: &Path, uri: &str, allow_outside: bool) -> Result<Document, Error> {
    let json = json!({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": uri}]});
    let path = folder.join("a.gltf");
    fs::write(&path, json.to_string()).unwrap();
    Document::open(&path, &LoadOptions::default().with_allow_outside(allow_outside))
}

#[test]
fn files_outside_the_folder_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("in");
    fs::create_dir_all(inside.join("sub")).unwrap();
    fs::write(folder.path().join("secret"), "s").unwrap();
    fs::write(inside.join("ok %.bin"), "s").unwrap();
    let absolute = folder.path().join("secret").display().to_string();
    for uri in ["ok%20%25.bin", "sub/../ok%20%25.bin", "./ok %25.bin"] {
        open_with(&inside, uri, false).unwrap();
    }
    for uri in
        ["../secret", "%2e%2e/secret", "sub/../../secret", "..%2Fsecret", &absolute, "C:\\a", "..\\secret"]
    {
        refused(open_with(&inside, uri, false), "lies outside the document's folder");
    }
    for uri in ["../secret", &absolute] {
        open_with(&inside, uri, true).unwrap();
    }
    refused(open_with(&inside, "gone.bin", false), "buffers[0].uri: the file \"gone.bin\" does not exist");
    refused(open_with(&inside, "sub", false), "is not a regular file");
    refused(Document::open(&inside, &LoadOptions::default()).map(drop), "it is a folder");
    refused(Document::open(&inside.join("gone.glb"), &LoadOptions::default()).map(drop), "cannot be read");
}

#[cfg(unix)]
#[test]
fn links_and_devices_outside_the_folder_are_refused() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("in");
    fs::create_dir_all(inside.join("sub")).unwrap();
    fs::write(folder.path().join("secret"), "s").unwrap();
    fs::write(inside.join("sub/real.bin"), "s").unwrap();
    symlink("../secret", inside.join("out.bin")).unwrap();
    symlink("sub/real.bin", inside.join("in.bin")).unwrap();
    symlink("/dev/zero", inside.join("zero")).unwrap();
    refused(open_with(&inside, "out.bin", false), "lies outside");
    open_with(&inside, "in.bin", false).unwrap();
    open_with(&inside, "out.bin", true).unwrap();
    refused(open_with(&inside, "zero", true), "is not a regular file");
    refused(Document::open(Path::new("/dev/zero"), &LoadOptions::default()), "is not a regular file");
}

#[test]
fn references_to_images_outside_the_folder_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("secret.png"), b"\x89PNG secret").unwrap();
    let json = json!({"asset": {"version": "2.0"}, "images": [{"uri": "../secret.png"}]});
    let path = folder.path().join("in/a.gltf");
    fs::write(&path, json.to_string()).unwrap();
    let read = |allow_outside| {
        Document::open(&path, &LoadOptions::default().with_allow_outside(allow_outside)).unwrap()
    };
    assert!(read(false).warnings()[0].contains("images[0].uri: \"../secret.png\" lies outside"));
    let kept = b"../secret.png";
    assert!(read(false).to_glb().unwrap().windows(kept.len()).any(|bytes| bytes == kept));
    assert!(read(true).to_glb().unwrap().windows(7).any(|bytes| bytes == b" secret"));
}

/// Every byte of a small file is damaged, and the file is cut at every length: errors or documents, no
/// panics.
#[test]
fn damage_never_panics() {
    let good = parse(good().to_string()).unwrap();
    let mut glb = good.to_glb().unwrap();
    for at in 0..glb.len() {
        let old = glb[at];
        for damage in [0, b'-', b'9', b'"', 0xff] {
            glb[at] = damage;
            if let Ok(document) = parse(glb.clone()) {
                for accessor in 0..document.accessors().len() {
                    let _ = document.elements(accessor);
                    let _ = document.vectors::<3>(accessor);
                }
                let _ = document.to_glb();
            }
        }
        glb[at] = old;
        assert!(parse(&glb[..at]).is_err());
    }
}
