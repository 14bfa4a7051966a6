//! Sentences about damaged files: in the words of the format, with the JSON path, and none in the words of a
//! library or of Rust.

#![cfg(feature = "textures")]

mod support;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents, inspect};
use darboux_io::image::{DecodeLimits, PngImage, RgbaImage};
use darboux_io::{Error, LoadOptions};
use serde_json::{Value, json};
use support::glb;

/// What serde, the decoders and Rust itself say.
const FOREIGN: &[&str] = &[
    "invalid type",
    "expected",
    "missing field",
    "unknown variant",
    "EOF",
    "ident",
    "usize",
    "u32",
    "f32",
    "f64",
    "struct",
    "sequence",
    "a map",
    "or map",
    "os error",
    "rror",
    "Some(",
    "None",
    "utf-8",
    "Reason",
    "magic",
    "Chunk",
    "deflate",
    "Invalid",
    "Huffman values",
];

/// The sentences that break a rule, each once.
#[derive(Default)]
struct Faults(BTreeSet<String>);

impl Faults {
    fn check(&mut self, sentence: &str, what: &str) {
        if let Some(word) = FOREIGN.iter().find(|word| sentence.contains(**word)) {
            self.0.insert(format!("{what}: {word:?} in: {sentence}"));
        } else if !sentence.contains("; ") {
            self.0.insert(format!("{what}: it does not say what to do: {sentence}"));
        }
    }

    fn assert_none(&self) {
        let some: Vec<_> = self.0.iter().take(20).collect();
        assert!(self.0.is_empty(), "{} faults: {some:#?}", self.0.len());
    }
}

fn asset(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)).expect("an asset")
}

/// The JSON and the binary data of a GLB.
fn parts(bytes: &[u8]) -> (Value, Vec<u8>) {
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).expect("JSON"), bytes[28 + length..].to_vec())
}

/// Adds the pointers of all values below `value`.
fn pointers(value: &Value, path: String, all: &mut Vec<String>) {
    match value {
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| pointers(value, format!("{path}/{i}"), all));
        }
        Value::Object(members) => {
            members.iter().for_each(|(key, value)| pointers(value, format!("{path}/{key}"), all));
        }
        _ => {}
    }
    all.push(path);
}

/// Opens a file, inspects it and adds tangents.
fn process(bytes: Vec<u8>) -> Result<(), Error> {
    let mut document = Document::from_bytes("f.glb", bytes, None, &LoadOptions::default())?;
    inspect(&document)?;
    add_tangents(&mut document, &AddTangentsOptions::default().with_overwrite(true), &mut |_| {})?;
    Ok(())
}

/// Every member of three models with other values, or missing.
#[test]
fn members_with_wrong_values_are_named_in_words_of_gltf() {
    let values =
        [json!(null), json!("x"), json!(-1), json!(0.5), json!([]), json!({ "x": 1 }), json!(99_999)];
    let (mut faults, mut refused) = (Faults::default(), 0);
    for name in ["made/quantised-sparse.glb", "made/draco.glb", "made/meshopt.glb"] {
        let (good, data) = parts(&asset(name));
        let mut all = Vec::new();
        pointers(&good, String::new(), &mut all);
        for pointer in &all {
            let changed = values.iter().map(|value| {
                let mut json = good.clone();
                *json.pointer_mut(pointer).expect("a member") = value.clone();
                (json, value.to_string())
            });
            let mut without = good.clone();
            if let Some((parent, key)) = pointer.rsplit_once('/')
                && let Some(Value::Object(members)) = without.pointer_mut(parent)
            {
                members.remove(key);
            }
            for (json, change) in changed.chain([(without, "removed".to_owned())]) {
                let Err(error) = process(glb(&json.to_string(), &data)) else { continue };
                let sentence = error.to_string();
                faults.check(&sentence, &format!("{name}{pointer} {change}"));
                refused += 1;
                let path = sentence.strip_prefix("f.glb: ").unwrap_or_default();
                let member = pointer.split('/').nth(1).unwrap_or_default();
                if !path.contains('[') && !path.starts_with(member) && !path.starts_with("asset") {
                    faults.0.insert(format!("{name}{pointer} {change}: no place in: {sentence}"));
                }
            }
        }
    }
    faults.assert_none();
    assert!(refused > 1000, "only {refused} files were refused");
}

/// The text of a document, damaged at every place.
#[test]
fn text_that_is_no_json_is_described_by_its_fault() {
    let (json, data) = parts(&asset("made/quantised-sparse.glb"));
    let (good, mut faults) = (json.to_string(), Faults::default());
    for at in 0..good.len() {
        for change in ["", "\"", "}", ",", "\\", "\u{1}", "t", "-", "1e999"] {
            let damaged = format!("{}{change}{}", &good[..at], &good[at + 1..]);
            if let Err(error) = process(glb(&damaged, &data)) {
                faults.check(&error.to_string(), &format!("byte {at} as {change:?}"));
            }
        }
        if let Err(error) = process(glb(&good[..at], &data)) {
            faults.check(&error.to_string(), &format!("the first {at} bytes"));
        }
    }
    faults.assert_none();
}

/// Images with each byte changed, and cut off at each byte.
#[test]
fn damaged_images_are_described_in_words_of_their_format() {
    let mut faults = Faults::default();
    for kind in ["png", "jpeg", "webp"] {
        let path = format!("../../xtask/src/soak/inputs/bumps.{kind}");
        let good = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("an image");
        let limits = DecodeLimits::default().with_max_side(4096).with_max_texels(1 << 20);
        let mut check = |file: Vec<u8>, what: &str| {
            if let Err(error) = RgbaImage::decode(&file, &limits) {
                faults.check(&error.to_string(), what);
            }
            if kind == "png"
                && let Err(error) = PngImage::from_bytes("f.png", file, &LoadOptions::default())
            {
                faults.check(&error.to_string(), what);
            }
        };
        for at in 0..good.len() {
            for change in [0xFF, 1, 0x80] {
                let mut file = good.clone();
                file[at] ^= change;
                check(file, &format!("{kind}, byte {at} ^ {change}"));
            }
            check(good[..at].to_vec(), &format!("{kind}, the first {at} bytes"));
        }
    }
    faults.assert_none();
}
