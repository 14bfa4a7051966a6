//! Fuzzes OBJ: any text gives an error or a document that can be written and read again.

#![no_main]

use std::fs;

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = std::env::temp_dir().join(format!("darboux-fuzz-obj-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("input.obj");
    fs::write(&path, bytes).expect("a file");
    let Ok(document) = Document::open(&path, &LoadOptions::default()) else { return };
    let written = document.to_glb().expect("what was read can be written");
    Document::from_bytes("written", written, None, &LoadOptions::default()).expect("and reads again");
});
