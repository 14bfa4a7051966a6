//! Documents: reading, edits, and everything that edits keep.

mod support;

use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

use darboux_io::gltf::{ComponentType, Document, ElementType, Elements, IndexList, NewAccessor, Target};
use darboux_io::{Error, Files, LoadOptions, SaveOptions};
use serde_json::{Value, json};
use support::glb;

/// Odd but valid spelling and layout, members that nothing here knows, and a buffer with one triangle:
/// positions, then indices.
const ODD: &str = r#"{
  "zebra": [1.0e-7, 0.10, 1e+5, -0.0, 12345678901234567890123],
  "asset": {"version": "2.0", "generator": "a\u00e9\/b"},
  "meshes": [ {"name": "m", "primitives": [
    {"extras": {"k": 1e+2, "s": "\u0001"}, "attributes": {"POSITION": 0, "_CUSTOM": 0}, "indices": 1}
  ]} ],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0.0, 0, 0], "max": [1, 1.0, 0]},
    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR", "name": "i", "extras": 1.50}
  ],
  "bufferViews": [
    {"buffer": 0, "byteLength": 36, "target": 34962},
    {"buffer": 0, "byteLength": 6, "byteOffset": 36}
  ],
  "buffers": [{"byteLength": 42, "uri": "URI", "extras": "mine"}],
  "extensionsUsed": ["UNKNOWN_extension"]
}
"#;

fn triangle() -> Vec<u8> {
    let positions = [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let indices = [0u16, 1, 2];
    positions
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .chain(indices.iter().flat_map(|i| i.to_le_bytes()))
        .collect()
}

fn data_uri(bytes: &[u8]) -> String {
    use base64::Engine;
    format!("data:;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

fn parse(text: &str) -> Result<Document, Error> {
    Document::from_bytes("x.gltf", text.into(), None, &LoadOptions::default())
}

fn odd() -> String {
    ODD.replace("URI", &data_uri(&triangle()))
}

/// The JSON chunk of a GLB.
fn json_of(glb: &[u8]) -> &str {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    std::str::from_utf8(&glb[20..20 + length]).unwrap().trim_end()
}

fn tangents() -> NewAccessor {
    let bytes = [1f32, 0.0, 0.0, -1.0].repeat(3).iter().flat_map(|x| x.to_le_bytes()).collect();
    let (component_type, element_type) = (ComponentType::F32, ElementType::Vec4);
    let elements = Elements { bytes, count: 3, component_type, element_type, normalized: false };
    NewAccessor::new(elements, Target::Vertices)
}

fn add_tangents(document: &mut Document) {
    let accessor = document.push_accessor(tangents());
    document
        .edit_primitive(0, 0, |primitive| {
            primitive["attributes"]["TANGENT"] = accessor.into();
        })
        .unwrap();
}

/// What the `gltf` crate, an independent reader, finds in a GLB: positions, indices and tangents of the first
/// primitive.
#[allow(clippy::type_complexity)]
fn independent(glb: &[u8]) -> (Vec<[f32; 3]>, Vec<u32>, Vec<[f32; 4]>) {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(glb).unwrap();
    let mesh = document.meshes().next().unwrap();
    let primitive = mesh.primitives().next().unwrap();
    let reader = primitive.reader(|_| blob.as_deref());
    let tangents = reader.read_tangents().map(Iterator::collect).unwrap_or_default();
    let indices = reader.read_indices().unwrap().into_u32().collect();
    (reader.read_positions().unwrap().collect(), indices, tangents)
}

#[test]
fn an_edit_keeps_the_rest_of_the_text() {
    let mut document = parse(&odd()).unwrap();
    assert!(!document.is_changed());
    add_tangents(&mut document);
    assert!(document.is_changed());
    let folder = tempfile::tempdir().unwrap();
    let written = document.save(&folder.path().join("out.gltf"), &SaveOptions::default()).unwrap();
    assert_eq!(written, [folder.path().join("out.bin"), folder.path().join("out.gltf")]);

    let mut expected: Value = serde_json::from_str(&odd()).unwrap();
    expected["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(2);
    let push = |array: &mut Value, element| array.as_array_mut().unwrap().push(element);
    push(
        &mut expected["accessors"],
        json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"}),
    );
    push(
        &mut expected["bufferViews"],
        json!({"buffer": 1, "byteOffset": 0, "byteLength": 48, "target": 34962}),
    );
    push(&mut expected["buffers"], json!({"name": "darboux", "byteLength": 48, "uri": "out.bin"}));
    // Texts are compared, so that the order of keys and the digits of numbers count.
    let text = fs::read_to_string(folder.path().join("out.gltf")).unwrap();
    let written: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written.to_string(), expected.to_string());
    assert!(text.starts_with("{\n  \"zebra\": [\n    1.0e-7,\n    0.10,\n    1e+5,\n    -0.0,"), "{text}");
    assert!(text.ends_with("\n}\n"), "{text}");
}

#[test]
fn a_glb_holds_everything() {
    let mut document = parse(&odd()).unwrap();
    add_tangents(&mut document);
    let written = document.to_glb().unwrap();
    let text = json_of(&written);
    assert!(text.contains("[1.0e-7,0.10,1e+5,-0.0,12345678901234567890123]"), "{text}");
    assert!(text.contains(r#""extras":{"k":1e+2,"s":"\u0001"}"#), "{text}");
    assert!(text.contains(r#""buffers":[{"byteLength":92,"extras":"mine"}]"#), "{text}");
    let (positions, indices, tangents) = independent(&written);
    assert_eq!(positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(indices, [0, 1, 2]);
    assert_eq!(tangents, [[1.0, 0.0, 0.0, -1.0]; 3]);
}

#[test]
fn without_edits_every_byte_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let options = SaveOptions::default();
    let with_bom = format!("\u{feff}{}", odd());
    let path = folder.path().join("a.gltf");
    fs::write(&path, &with_bom).unwrap();
    let out = folder.path().join("sub/folder/b.gltf");
    Document::open(&path, &LoadOptions::default()).unwrap().save(&out, &options).unwrap();
    assert_eq!(fs::read_to_string(&out).unwrap(), with_bom);

    let mut binary = glb(&odd().replace("\"uri\": ", "\"x\": "), &triangle());
    binary.extend([4, 0, 0, 0]);
    binary.extend(*b"MINEdata");
    let length = (binary.len() as u32).to_le_bytes();
    binary[8..12].copy_from_slice(&length);
    let mut document = Document::from_bytes("x", binary.clone(), None, &LoadOptions::default()).unwrap();
    assert_eq!(document.to_glb().unwrap(), binary);

    // With an edit, the chunk of unknown type is kept; a .gltf could not hold it.
    add_tangents(&mut document);
    assert!(document.to_glb().unwrap().ends_with(b"MINEdata"));
    let refused = document.save(&folder.path().join("c.gltf"), &options).unwrap_err();
    assert!(refused.to_string().contains("chunks of unknown type"), "{refused}");
}

#[test]
fn a_glb_becomes_a_gltf_with_a_bin_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = parse(&odd()).unwrap();
    add_tangents(&mut document);
    let first = document.to_glb().unwrap();
    let path = folder.path().join("é ü.gltf");
    let document = Document::from_bytes("x", first.clone(), None, &LoadOptions::default()).unwrap();
    document.save(&path, &SaveOptions::default()).unwrap();
    assert!(fs::read_to_string(&path).unwrap().contains(r#""uri":"%C3%A9%20%C3%BC.bin""#));
    let back = Document::open(&path, &LoadOptions::default()).unwrap().to_glb().unwrap();
    assert_eq!(independent(&back), independent(&first));
}

#[test]
fn values_of_every_component_type_are_read() {
    // 0: interleaved normalised i8 VEC3 with a stride of 4; 12: u16 VEC2; 20: sparse indices 1, 2; 24: sparse
    // values.
    let mut bytes = vec![127u8, 0x81, 0x80, 9, 0, 64, 1, 9, 0, 0, 0, 9];
    bytes.extend([1u8, 0, 2, 0, 0xff, 0xff, 0, 1, 1, 0, 2, 0]);
    bytes.extend([7f32, 8.0].iter().flat_map(|x| x.to_le_bytes()));
    let text = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": bytes.len(), "uri": data_uri(&bytes)}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 12, "byteStride": 4},
            {"buffer": 0, "byteOffset": 12, "byteLength": 8},
            {"buffer": 0, "byteOffset": 20, "byteLength": 4},
            {"buffer": 0, "byteOffset": 24, "byteLength": 8},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 2, "type": "VEC2"},
            {"componentType": 5126, "count": 3, "type": "SCALAR", "sparse": {
                "count": 2,
                "indices": {"bufferView": 2, "componentType": 5123},
                "values": {"bufferView": 3},
            }},
            {"bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR"},
            {"componentType": 5126, "count": 2, "type": "VEC2"},
            {"bufferView": 1, "componentType": 5121, "count": 1, "type": "MAT2"},
        ],
    });
    let document = parse(&text.to_string()).unwrap();
    let normals = document.vectors::<3>(0).unwrap().into_owned();
    assert_eq!(normals, [[1.0, -1.0, -1.0], [0.0, 64.0 / 127.0, 1.0 / 127.0], [0.0; 3]]);
    assert_eq!(document.elements(0).unwrap().bytes, [127, 0x81, 0x80, 0, 64, 1, 0, 0, 0]);
    assert_eq!(document.vectors::<2>(1).unwrap()[..], [[1.0, 2.0], [65535.0, 256.0]]);
    assert_eq!(document.vectors::<1>(2).unwrap()[..], [[0.0], [7.0], [8.0]]);
    assert_eq!(document.indices(3).unwrap().into_u32(), [1, 2, 65535, 256]);
    assert_eq!(document.vectors::<2>(4).unwrap()[..], [[0.0; 2]; 2]);
    assert_eq!(document.elements(5).unwrap().element_size(), 8);
    assert!(document.vectors::<2>(0).is_err());
    assert!(document.indices(2).is_err());
}

#[test]
fn values_are_borrowed_where_the_file_has_them_so() {
    // Twelve floats, or 48 bytes of indices, at an offset.
    let document = |offset: usize, stride: serde_json::Value, kind: u32, element: &str, count: usize| {
        let mut bytes = vec![0; offset];
        match kind {
            5126 => bytes.extend((0..12).flat_map(|i| (i as f32 + 0.5).to_le_bytes())),
            5123 => bytes.extend((0..24u16).flat_map(|i| (i + 1000).to_le_bytes())),
            _ => bytes.extend((0..12u32).flat_map(|i| (i + 100_000).to_le_bytes())),
        }
        let mut view = json!({"buffer": 0, "byteOffset": offset, "byteLength": 48});
        if stride.is_number() {
            view["byteStride"] = stride;
        }
        let text = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": bytes.len(), "uri": data_uri(&bytes)}],
            "bufferViews": [view],
            "accessors": [{"bufferView": 0, "componentType": kind, "count": count, "type": element}],
        });
        parse(&text.to_string()).unwrap()
    };
    let packed: Vec<[f32; 3]> = (0..4).map(|i| [0.5, 1.5, 2.5].map(|x| x + 3.0 * i as f32)).collect();
    for (offset, is_borrowed) in [(0, true), (16, true), (1, false)] {
        let vectors = document(offset, json!(null), 5126, "VEC3", 4);
        let vectors = vectors.vectors::<3>(0).unwrap();
        assert_eq!((matches!(vectors, Cow::Borrowed(_)), &*vectors), (is_borrowed, &*packed), "{offset}");
        let shorts = document(offset, json!(null), 5123, "SCALAR", 24);
        let list = shorts.indices(0).unwrap();
        assert_eq!(matches!(list, IndexList::U16(Cow::Borrowed(_))), is_borrowed, "{offset}");
        assert_eq!(list.into_u32(), (1000..1024).collect::<Vec<_>>());
        let words = document(offset, json!(null), 5125, "SCALAR", 12);
        let list = words.indices(0).unwrap();
        assert_eq!(matches!(list, IndexList::U32(Cow::Borrowed(_))), is_borrowed, "{offset}");
        assert_eq!(list.into_u32(), (100_000..100_012).collect::<Vec<_>>());
    }
    // Interleaved: the last element has no padding.
    let interleaved = document(0, json!(16), 5126, "VEC2", 3);
    assert_eq!(*interleaved.vectors::<2>(0).unwrap(), [[0.5, 1.5], [4.5, 5.5], [8.5, 9.5]]);
    assert_eq!(interleaved.elements(0).unwrap().bytes.len(), 24);
}

#[test]
fn new_accessors_are_aligned_bounded_and_described() {
    let mut document = parse(&odd()).unwrap();
    let elements = Elements {
        bytes: vec![1, 2, 3, 251, 5, 6],
        count: 2,
        component_type: ComponentType::I8,
        element_type: ElementType::Vec3,
        normalized: true,
    };
    let new =
        NewAccessor::new(elements.clone(), Target::Vertices).with_bounds(true).with_metadata_of(Some(1));
    let index = document.push_accessor(new);
    assert_eq!(document.elements(index).unwrap(), elements);
    let json = |document: &Document| json_of(&document.to_glb().unwrap()).to_owned();
    assert!(!json(&document).contains("normalized"), "an accessor that nothing refers to is not written");
    document.edit_primitive(0, 0, |primitive| primitive["attributes"]["_DELTA"] = index.into()).unwrap();
    let written = document.to_glb().unwrap();
    let text = json_of(&written);
    let expected = r#"{"bufferView":2,"componentType":5120,"normalized":true,"count":2,"type":"VEC3","min":[-5.0,2.0,3.0],"max":[1.0,5.0,6.0],"name":"i","extras":1.50}"#;
    assert!(text.contains(expected), "{text}");
    assert!(
        text.contains(r#"{"buffer":0,"byteOffset":44,"byteLength":8,"byteStride":4,"target":34962}"#),
        "{text}"
    );
}

#[test]
fn an_input_with_external_files_is_embedded_or_brought_along() {
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("in");
    fs::create_dir_all(input.join("tex tures")).unwrap();
    fs::write(input.join("b 1.bin"), triangle()).unwrap();
    fs::write(input.join("tex tures/n.png"), b"\x89PNG1").unwrap();
    let images = r#""images": [{"uri": "tex%20tures/n.png", "name": "n"}, {"uri": "gone.png"},
        {"uri": "https://example.org/x.png"}, {"uri": "tex%20tures/n.png"}], "extensionsUsed""#;
    let text = ODD.replace("URI", "b%201.bin").replace("\"extensionsUsed\"", images);
    fs::write(input.join("a.gltf"), text).unwrap();

    let mut document = Document::open(&input.join("a.gltf"), &LoadOptions::default()).unwrap();
    assert_eq!(document.warnings().len(), 1);
    assert!(document.warnings()[0].contains("images[1].uri: the file \"gone.png\" does not exist"));

    let embedded = document.to_glb().unwrap();
    let text = json_of(&embedded);
    let image = r#"{"name":"n","mimeType":"image/png","bufferView":2}"#;
    assert!(text.contains(image), "{text}");
    assert!(
        text.contains(r#"{"uri":"gone.png"}"#) && text.contains(r#"{"uri":"https://example.org/x.png"}"#)
    );
    assert!(text.contains(r#"{"mimeType":"image/png","bufferView":2}"#), "{text}");

    add_tangents(&mut document);
    let output = folder.path().join("out");
    fs::create_dir(&output).unwrap();
    fs::write(output.join("b 1.bin"), b"someone else's").unwrap();
    document.save(&output.join("a.gltf"), &SaveOptions::default()).unwrap();
    assert_eq!(fs::read(output.join("b 1.bin")).unwrap(), b"someone else's");
    assert_eq!(fs::read(output.join("b 1_1.bin")).unwrap(), triangle());
    assert_eq!(fs::read(output.join("tex tures/n.png")).unwrap(), b"\x89PNG1");
    let text = fs::read_to_string(output.join("a.gltf")).unwrap();
    assert!(text.contains(r#""uri": "b%201_1.bin""#), "{text}");
    let written: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["images"][0], json!({"uri": "tex%20tures/n.png", "name": "n"}));

    // Once more: what is there already is used again.
    document.save(&output.join("a.gltf"), &SaveOptions::default().with_force(true)).unwrap();
    assert_eq!(names(&output), ["a.bin", "a.gltf", "b 1.bin", "b 1_1.bin", "tex tures"]);
}

fn names(folder: &Path) -> Vec<String> {
    let entries =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = entries.collect();
    names.sort();
    names
}

#[test]
fn in_place_changes_the_document_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    fs::write(&path, ODD.replace("URI", "a.bin")).unwrap();
    fs::write(folder.path().join("a.bin"), triangle()).unwrap();
    let mut document = Document::open(&path, &LoadOptions::default()).unwrap();
    assert_eq!(document.save_in_place().unwrap(), [] as [std::path::PathBuf; 0]);
    let refused = document.save(&path, &SaveOptions::default().with_force(true)).unwrap_err();
    assert!(refused.to_string().contains("is the input"), "{refused}");
    add_tangents(&mut document);
    document.save_in_place().unwrap();
    assert_eq!(names(folder.path()), ["a.bin", "a.gltf", "a_1.bin"]);
    assert_eq!(fs::read(folder.path().join("a.bin")).unwrap(), triangle());
    let again = Document::open(&path, &LoadOptions::default()).unwrap();
    assert_eq!(again.vectors::<4>(2).unwrap()[..], [[1.0, 0.0, 0.0, -1.0]; 3]);
}

#[cfg(unix)]
#[test]
fn in_place_keeps_permissions_and_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("a.gltf"), folder.path().join("link.gltf"));
    fs::write(&path, odd()).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("a.gltf", &link).unwrap();
    let mut document = Document::open(&link, &LoadOptions::default()).unwrap();
    add_tangents(&mut document);
    document.save_in_place().unwrap();
    assert!(link.is_symlink());
    assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    assert!(fs::read_to_string(&path).unwrap().contains("TANGENT"));
}

#[test]
fn a_failure_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = parse(&odd()).unwrap();
    add_tangents(&mut document);
    let existing = folder.path().join("out.gltf");
    fs::write(&existing, "old").unwrap();
    let error = document.save(&existing, &SaveOptions::default()).unwrap_err();
    assert!(error.to_string().contains("exists"), "{error}");
    assert!(document.save(&folder.path().join("out.txt"), &SaveOptions::default()).is_err());
    fs::create_dir_all(folder.path().join("new/out.gltf/x")).unwrap();
    assert!(
        document.save(&folder.path().join("new/out.gltf"), &SaveOptions::default().with_force(true)).is_err()
    );
    assert_eq!(names(folder.path()), ["new", "out.gltf"]);
    assert_eq!(names(&folder.path().join("new")), ["out.gltf"]);
    assert_eq!(fs::read(&existing).unwrap(), b"old");
}

#[test]
fn several_buffers_are_merged_and_keep_their_members() {
    let text = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"data:,a"},
        {"byteLength":2,"uri":"https://example.org/x.bin"},{"byteLength":1,"uri":"data:,c","extras":7},
        {"byteLength":3,"uri":"data:,def"}],"bufferViews":[{"buffer":0,"byteLength":1},{"buffer":1,"byteLength":2},
        {"buffer":2,"byteLength":1},{"buffer":3,"byteOffset":1,"byteLength":2,
        "extensions":{"X":{"buffer":3},"Y":{"buffer":[3]}}}]}"#;
    let written = parse(text).unwrap().to_glb().unwrap();
    let expected = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":7},{"byteLength":2,"uri":"https://example.org/x.bin"},{"byteLength":1,"uri":"data:application/octet-stream;base64,Yw==","extras":7}],"bufferViews":[{"buffer":0,"byteLength":1},{"buffer":1,"byteLength":2},{"buffer":2,"byteLength":1},{"buffer":0,"byteOffset":5,"byteLength":2,"extensions":{"X":{"buffer":0,"byteOffset":4},"Y":{"buffer":[3]}}}]}"#;
    assert_eq!(json_of(&written), expected);
    assert_eq!(&written[written.len() - 8..], b"a\0\0\0def\0");
}

/// Files in memory.
#[derive(Debug)]
struct Given(Vec<(&'static str, Vec<u8>)>);

impl Files for Given {
    fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(known, _)| *known == name)
    }

    fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        let file = self.0.iter().find(|(known, _)| *known == name);
        file.map(|(_, bytes)| bytes.clone()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

#[test]
fn given_files_are_read_as_those_of_a_folder() {
    let png = b"\x89PNG\r\n\x1a\n".to_vec();
    let json = ODD.replace("URI", "../data/a%20b.bin").replacen('{', r#"{"images": [{"uri": "c.png"}],"#, 1);
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in
        [("models/m.gltf", json.as_bytes()), ("data/a b.bin", &triangle()), ("models/c.png", &png)]
    {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let outside = LoadOptions::default().with_allow_outside(true);
    let stored = Document::open(&folder.path().join("models/m.gltf"), &outside).unwrap();
    let open = |files| {
        let name = "models/m.gltf";
        Document::from_files(name, json.clone().into_bytes(), Arc::new(Given(files)), &LoadOptions::default())
    };
    let given = open(vec![("data/a b.bin", triangle()), ("models/c.png", png)]).unwrap();
    assert_eq!(given.to_glb().unwrap(), stored.to_glb().unwrap());
    assert_eq!((given.source_files(), given.warnings().len()), (Vec::new(), 0));

    // Saving copies them; what is there already is used again, and other content is kept.
    let output = tempfile::tempdir().unwrap();
    let saved = |name: &str| given.save(&output.path().join(name), &SaveOptions::default()).unwrap().len();
    assert_eq!((saved("m.gltf"), saved("n.gltf")), (3, 1));
    let again = Document::open(&output.path().join("n.gltf"), &LoadOptions::default()).unwrap();
    assert_eq!(again.image_bytes(0).unwrap(), given.image_bytes(0).unwrap());

    // Without its image a model opens with a warning, and without its buffer it does not.
    assert_eq!(open(vec![("data/a b.bin", triangle())]).unwrap().warnings().len(), 1);
    let sentence = open(Vec::new()).unwrap_err().to_string();
    assert!(
        sentence.ends_with("the file \"../data/a%20b.bin\" is not among the files; give the whole folder"),
        "{sentence}"
    );
}
